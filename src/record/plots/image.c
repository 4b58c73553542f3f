/* Sections as images: values between the points of a lattice cubic along both axes, at true places. Under a surface
 * that is not level, or on a lattice that is graded, the columns of a section stand straight and side by side, but
 * their points lie at heights of their own. */
#include "record/plots/section.h"

#include "base/memory.h"

#include <math.h>

/* An image has at least so many pixels along each axis. */
enum { FINE = 280 };

/* Weights of the four points around a place s in [0, 1] between the middle two (Keys 1981). */
static void cubic_weights(double s, double weight[4])
{
    weight[0] = 0.5 * s * (s * (2.0 - s) - 1.0);
    weight[1] = 0.5 * (s * s * (3.0 * s - 5.0) + 2.0);
    weight[2] = 0.5 * s * (s * (4.0 - 3.0 * s) + 1.0);
    weight[3] = 0.5 * s * s * (s - 1.0);
}

/* The four points around place `at` of an axis, counted in points and repeated at the ends, and their weights. */
static void around(double at, size_t points, size_t index[4], double weight[4])
{
    const size_t low = at < (double)(points - 1) ? (size_t)at : points - 2;
    cubic_weights(at - (double)low, weight);
    index[0] = low > 0 ? low - 1 : 0;
    index[1] = low;
    index[2] = low + 1;
    index[3] = low + 2 < points ? low + 2 : points - 1;
}

static double pixel_at(const struct section *section, size_t i)
{
    return (double)i / ((double)(section->fine[0] - 1) / (double)(section->along - 1));
}

/* Rows of the points, counted in points, at the pixels of column i; NAN where the section has none. False: its points
 * do not ascend. */
static bool place_rows(struct section *section, size_t i, double *height)
{
    const size_t points = section->across, pixels = section->fine[1];
    size_t column[4], k = 0;
    double across[4];
    around(pixel_at(section, i), section->along, column, across);
    for (size_t j = 0; j < points; j++) {
        height[j] = 0;
        for (size_t l = 0; l < 4; l++)
            height[j] += across[l] * (double)section->coordinate[2 * (j * section->along + column[l]) + 1];
        if (j > 0 && !(height[j] > height[j - 1])) return false;
    }
    for (size_t j = 0; j < pixels; j++) {
        const double slack = .5 * (section->high[1] - section->low[1]) / (double)(pixels - 1);
        const double at = section->low[1] + 2 * slack * (double)j;
        while (k + 2 < points && height[k + 1] < at)
            k++;
        const bool inside = at >= height[0] - slack && at <= height[points - 1] + slack;
        const double part = (at - height[k]) / (height[k + 1] - height[k]);
        section->row[j * section->fine[0] + i] =
            (float)(inside ? (double)k + fmin(fmax(part, 0), 1) : (double)NAN);
    }
    return true;
}

/* Do all rows have the same places along the first axis, evenly spaced, and each its own along the second? */
static bool stands(const struct section *section, bool *even)
{
    const size_t number[2] = {section->along, section->across};
    bool good = true;
    *even = true;
    for (size_t k = 0; k < section->points; k++)
        for (int side = 0; side < 2; side++) {
            const size_t at = side == 0 ? k % number[0] : k / number[0];
            const double step = (section->high[side] - section->low[side]) / (double)(number[side] - 1);
            const double expected = section->low[side] + (double)at * step;
            if (fabs((double)section->coordinate[2 * k + (size_t)side] - expected) <= 1e-3 * step) continue;
            *even = false;
            good = good && side == 1;
        }
    return good;
}

void image_prepare(struct section *section)
{
    const size_t number[2] = {section->along, section->across};
    bool even;
    if (number[0] < 2 || number[1] < 2 || !stands(section, &even)) return;
    const size_t least = number[0] < number[1] ? number[0] : number[1];
    const size_t refine = (FINE + least - 2) / (least - 1);
    const size_t most = number[0] > number[1] ? number[0] : number[1];
    const size_t factor = most * refine > 4 * FINE ? (4 * FINE + most - 1) / most : refine;
    for (int side = 0; side < 2; side++)
        section->fine[side] = (number[side] - 1) * factor + 1;
    section->regular = true;
    if (even) return;
    section->row = array_new(section->fine[0] * section->fine[1], sizeof *section->row);
    double *height = array_new(number[1], sizeof *height);
    section->regular = section->row != NULL && height != NULL;
    for (size_t i = 0; i < section->fine[0] && section->regular; i++)
        section->regular = place_rows(section, i, height);
    array_free(height);
}

bool image_write(const struct section *section, const double *value, size_t components, FILE *data)
{
    const double factor = (double)(section->fine[1] - 1) / (double)(section->across - 1);
    for (size_t j = 0; j < section->fine[1]; j++)
        for (size_t i = 0; i < section->fine[0]; i++) {
            const double at =
                section->row != NULL ? (double)section->row[j * section->fine[0] + i] : (double)j / factor;
            size_t row[4] = {0}, column[4];
            double up[4] = {0}, across[4] = {0}, sum = isnan(at) ? (double)NAN : 0.0;
            if (!isnan(at)) around(at, section->across, row, up);
            around(pixel_at(section, i), section->along, column, across);
            for (size_t k = 0; k < 4 && !isnan(at); k++)
                for (size_t l = 0; l < 4; l++)
                    sum += up[k] * across[l] * value[components * (row[k] * section->along + column[l])];
            const float pixel = (float)sum;
            if (fwrite(&pixel, sizeof pixel, 1, data) != 1) return false;
        }
    return true;
}
