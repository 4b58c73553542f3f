/* The deck's units as words (&output length_unit, time_unit), for plots and texts. */
#ifndef SELAS_SCENE_UNITS_H
#define SELAS_SCENE_UNITS_H

#include "scene/scene.h"

#define UNITS_OF_DECK " (units of the deck)"
enum { UNIT_TEXT = 6 * UNIT_SIZE };

/* The unit length^length time^time in brackets behind a blank, " (m/s^2)"; `otherwise` where the deck does not name
 * what it takes. Exponents: length 0 or 1, time -2 to 1, not both 0. Returns text. */
const char *unit_text(const struct output_choice *output, int length, int time, const char *otherwise,
                      char text[UNIT_TEXT]);
/* Both as "lengths in m, times in s", what is not named left out, or "the deck's own". Returns text. */
const char *units_told(const struct output_choice *output, char text[UNIT_TEXT]);
/* output%low_pass (R1 of doc/reference/results.md) as words; empty where there is none. Returns text. */
const char *low_pass_told(const struct output_choice *output, char text[UNIT_TEXT]);

#endif
