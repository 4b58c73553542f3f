/* Grounds and sources for tests of seismograms. */
#ifndef SEISMIC_H
#define SEISMIC_H

#include "exact/seismogram.h"

#include "near.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Elastic where q_p is 0; qualities at the angular frequency omega. */
static inline struct seismogram_rock seismic_rock(double top, double density, double c_p, double c_s,
                                                  double q_p, double q_s, double omega)
{
    struct seismogram_rock rock = {.top = top, .density = density};
    const double axial = density * c_p * c_p, shear = density * c_s * c_s;
    rock.axial = q_p > 0 ? modulus_constant_q(axial, q_p, omega) : modulus_elastic(axial);
    rock.shear = q_p > 0 ? modulus_constant_q(shear, q_s, omega) : modulus_elastic(shear);
    return rock;
}

static inline struct seismogram_source seismic_source(double x, double y, double z,
                                                      const struct history *history)
{
    return (struct seismogram_source){.position = {x, y, z}, .patch.shape = PATCH_POINT, .history = history};
}

static inline void seismic_compute(const struct seismogram_problem *problem, size_t n,
                                   struct seismogram *seismogram)
{
    struct messages messages = {0};
    const selas_status status = seismograms(problem, n, seismogram, &messages);
    if (status != SELAS_OK) print_error("%s", messages.text != NULL ? messages.text : "");
    assert_int_equal(status, SELAS_OK);
}

/* L2 over `rows` times to the end of the difference of lines a of one and b of another, and of line a. */
static inline void seismic_norms(const struct seismogram *one, size_t a, const struct seismogram *other,
                                 size_t b, double sign, double *difference, double *size)
{
    enum { ROWS = 400 };
    *difference = *size = 0;
    for (int i = 0; i <= ROWS; i++) {
        double x[SEISMOGRAM_LINES], y[SEISMOGRAM_LINES];
        const double t = one->end_time * i / ROWS;
        seismogram_at(one, t, x);
        seismogram_at(other, t, y);
        *difference += (x[a] - sign * y[b]) * (x[a] - sign * y[b]);
        *size += x[a] * x[a];
    }
    *difference = sqrt(*difference);
    *size = sqrt(*size);
}

/* Rows t, values of a file of regress/reference into value[rows][columns]; gives the number of rows. */
static inline size_t seismic_rows(const char *path, size_t columns, size_t room, double *value)
{
    char line[512];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t rows = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] == '#') continue;
        assert_true(rows < room);
        char *at = line;
        for (size_t i = 0; i < columns; i++) {
            value[rows * columns + i] = strtod(at, &at);
            if (*at == ',') at++;
        }
        rows++;
    }
    assert_int_equal(fclose(file), 0);
    return rows;
}

#endif
