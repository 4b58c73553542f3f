/* Frequencies along Re s = eta and their inverse transform (FFTW; doc/theory/lamb.md,
 * doc/theory/seismograms.md, Eq 29). */
#include "exact/contour.h"

#include "base/fft_room.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

double complex contour_frequency(const struct contour *contour, size_t j)
{
    return contour->decay + I * (2 * M_PI * (double)j / contour->period);
}

static void release(struct contour *contour)
{
    if (contour->plan != NULL) fftw_destroy_plan(contour->plan);
    fftw_free(contour->in);
    fftw_free(contour->out);
    contour->plan = NULL;
    contour->in = NULL;
    contour->out = NULL;
}

bool contour_grid(struct contour *contour, size_t frequencies)
{
    size_t rows = 256;
    while (rows < 16 * frequencies)
        rows *= 2;
    if (rows == contour->rows) return true;
    bool room = false;
#pragma omp critical(selas_fftw_planner)
    {
        release(contour);
        contour->in = fftw_malloc((rows / 2 + 1) * sizeof *contour->in);
        contour->out = fftw_malloc(rows * sizeof *contour->out);
        if (contour->in != NULL && contour->out != NULL && fft_room(rows))
            contour->plan = fftw_plan_dft_c2r_1d((int)rows, contour->in, contour->out, FFTW_ESTIMATE);
        room = contour->plan != NULL;
    }
    contour->rows = rows;
    return room;
}

/* Weight of index j in [0, until), of which a share fades out. */
static double weight(size_t j, size_t until, double faded)
{
    if (j >= until) return 0;
    const double left = (double)(until - j), fade = floor(faded * (double)until);
    return left <= fade ? .5 - .5 * cos(M_PI * left / (fade + 1)) : 1;
}

void contour_transform(struct contour *contour, const double complex *line, size_t from, size_t until,
                       bool rate, double faded)
{
    memset(contour->in, 0, (contour->rows / 2 + 1) * sizeof *contour->in);
    const size_t first = from - (size_t)(faded * (double)from);
    for (size_t j = first; j < until; j++)
        contour->in[j] = line[j] * (rate ? contour_frequency(contour, j) : 1) *
                         (weight(j, until, faded) - weight(j, from, faded)) / contour->period;
    fftw_execute(contour->plan);
}

double contour_norm(const struct contour *contour, double end)
{
    const double step = contour->period / (double)contour->rows;
    double sum = 0;
    for (size_t i = 0; i < contour->rows && (double)i * step <= end; i++) {
        const double value = contour->out[i] * exp(contour->decay * (double)i * step);
        sum += value * value;
    }
    return sqrt(sum * step);
}

void contour_free(struct contour *contour)
{
#pragma omp critical(selas_fftw_planner)
    release(contour);
}

bool contour_widen(double complex **spectrum, size_t lines, size_t used, size_t until, size_t *room)
{
    if (until <= *room) return true;
    double complex *wider = array_new(lines * 2 * until, sizeof *wider);
    if (wider == NULL) return false;
    for (size_t i = 0; i < lines && used > 0; i++)
        memcpy(wider + i * 2 * until, *spectrum + i * *room, used * sizeof *wider);
    array_free(*spectrum);
    *spectrum = wider;
    *room = 2 * until;
    return true;
}
