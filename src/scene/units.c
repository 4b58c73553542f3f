/* The deck's units as words. */
#include "scene/units.h"

#include <stdio.h>

const char *unit_text(const struct output_choice *output, int length, int time, const char *otherwise,
                      char text[UNIT_TEXT])
{
    const char *long_unit = output->length_unit, *time_unit = output->time_unit;
    const bool named = (length == 0 || long_unit[0] != '\0') && (time == 0 || time_unit[0] != '\0');
    if (!named)
        snprintf(text, UNIT_TEXT, "%s", otherwise);
    else if (time == 0)
        snprintf(text, UNIT_TEXT, " (%s)", long_unit);
    else if (length == 0 && time > 0)
        snprintf(text, UNIT_TEXT, " (%s)", time_unit);
    else
        snprintf(text, UNIT_TEXT, " (%s/%s%s)", length == 0 ? "1" : long_unit, time_unit,
                 time < -1 ? "^2" : "");
    return text;
}

const char *units_told(const struct output_choice *output, char text[UNIT_TEXT])
{
    const bool both = output->length_unit[0] != '\0' && output->time_unit[0] != '\0';
    if (output->length_unit[0] == '\0' && output->time_unit[0] == '\0') return "the deck's own";
    snprintf(text, UNIT_TEXT, "%s%s%s%s%s", output->length_unit[0] != '\0' ? "lengths in " : "",
             output->length_unit, both ? ", " : "", output->time_unit[0] != '\0' ? "times in " : "",
             output->time_unit);
    return text;
}

const char *low_pass_told(const struct output_choice *output, char text[UNIT_TEXT])
{
    text[0] = '\0';
    if (output->low_pass > 0.0)
        snprintf(text, UNIT_TEXT, "spectrum times exp(-(omega/%.17g)^4), zero phase", output->low_pass);
    return text;
}
