/* What the tests of the library's door share: a small scene, the deck's own triangle as a callback, and a
 * judge of wrong calls. */
#ifndef API_SCENE_H
#define API_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "selas.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const char scene[] =
    "&scene dimension = 3, end_time = 2.0 /\n"
    "&method degree = 2 /\n"
    "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
    "&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 4, 4, 4, spacing = 1 /\n"
    "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'lysmer' /\n"
    "&load name = 'hammer', face = 'z-', shape = 'square', centre = 2, 2, 0, size = 2, 2, direction = 0, 0, "
    "1\n"
    "  amplitude = 1, history = 'triangle', duration = 1 /\n"
    "&receiver name = 'r', position = 2, 2, 0 /\n";

static inline selas_simulation *open_scene(void)
{
    selas_simulation *simulation = NULL;
    const selas_status status = selas_open_text("test-api", scene, &simulation);
    if (status != SELAS_OK) fail_msg("%s", selas_message(simulation));
    return simulation;
}

struct push {
    int answer;
    unsigned long calls;
    double last;
    bool in_order, not_finite;
};

/* The deck's own triangle. */
static inline int triangle(void *context, double time, const double position[3], double value[3])
{
    struct push *push = context;
    (void)position;
    push->in_order = (push->calls == 0 || time >= push->last) && (push->calls > 0 || time == 0.0);
    push->calls++;
    push->last = time;
    value[2] = time <= 0 || time >= 1 ? 0 : 1 - fabs(2 * time - 1);
    if (push->not_finite) value[1] = (double)NAN;
    return push->answer;
}

static unsigned long wrong_calls;

/* Each must give a status that is no success, and its own message. */
static inline void wrong(selas_simulation *simulation, selas_status status)
{
    wrong_calls++;
    if (status == SELAS_OK) fail_msg("wrong call %lu was taken for right", wrong_calls);
    if (strlen(selas_last_message(simulation)) == 0) fail_msg("wrong call %lu left no message", wrong_calls);
}

/* The same for a handle that has only just been made. */
static inline void wrong_open(selas_simulation **simulation, selas_status status)
{
    wrong(*simulation, status);
}

#endif
