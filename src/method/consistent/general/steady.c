/* Static fields of ground that varies across an interface alone (see the header). */
#include "method/consistent/general/steady.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* What moves along the normal (G26). */
struct front {
    double shift[3], pull[3];
    struct slopes slope;
};

/* (G26): the slope along the normal from the traction and the slopes along the interface. */
static void rise_of(const struct rock *rock, int m, const double pull[3], const struct slopes *slope,
                    double rise[3])
{
    double spread = 0;
    for (int t = 0; t < m; t++) {
        spread += slope->of[t][t];
        rise[t] = pull[t] / rock->mu - slope->of[t][m];
    }
    rise[m] = (pull[m] - rock->lambda * spread) / (rock->lambda + 2 * rock->mu);
}

/* (G27): the slope of the traction along the normal. */
static void pull_rise(const struct steady *steady, const struct rock *rock, int m, const struct front *rise,
                      double pull[3])
{
    for (int i = 0; i < m; i++) {
        double spread = rise->slope.of[i][m], bends = 0;
        for (int t = 0; t < m; t++) {
            spread += steady->bend[t].of[i][t];
            bends += steady->bend[t].of[t][i] + steady->bend[i].of[t][t];
        }
        pull[i] = rock->density * steady->acceleration[i] - rock->lambda * spread - rock->mu * bends;
    }
    pull[m] = rock->density * steady->acceleration[m];
    for (int t = 0; t < m; t++)
        pull[m] -= steady->pull_slope.of[t][t];
}

static void rises(const struct steady *steady, const struct rock *rock, int m, const struct front *front,
                  struct front *rise)
{
    *rise = (struct front){.pull = {0}};
    rise_of(rock, m, front->pull, &front->slope, rise->shift);
    for (int t = 0; t < m; t++)
        rise_of(rock, m, steady->pull_slope.of[t], &steady->bend[t], rise->slope.of[t]);
    pull_rise(steady, rock, m, rise, rise->pull);
}

static void move(struct front *front, double by, const struct front *rise)
{
    for (int i = 0; i < 3; i++) {
        front->shift[i] += by * rise->shift[i];
        front->pull[i] += by * rise->pull[i];
        for (int t = 0; t < 2; t++)
            front->slope.of[t][i] += by * rise->slope.of[t][i];
    }
}

/* Midpoint steps from the place on either way: exact within even rock. */
static bool lay(const struct ground_line *line, struct steady *steady)
{
    const int m = line->dimension - 1;
    const size_t middle = line->count / 2;
    steady->shift_at = array_new(line->count + 1, sizeof *steady->shift_at);
    steady->pull_at = array_new(line->count + 1, sizeof *steady->pull_at);
    steady->slope_at = array_new(line->count + 1, sizeof *steady->slope_at);
    if (steady->shift_at == NULL || steady->pull_at == NULL || steady->slope_at == NULL) return false;
    for (int way = -1; way <= 1; way += 2) {
        struct front front = {.slope = steady->slope}, half, rise;
        memcpy(front.shift, steady->shift, sizeof front.shift);
        memcpy(front.pull, steady->pull, sizeof front.pull);
        for (size_t n = 0; n <= middle; n++) {
            const size_t at = way > 0 ? middle + n : middle - n;
            memcpy(steady->shift_at[at], front.shift, sizeof front.shift);
            memcpy(steady->pull_at[at], front.pull, sizeof front.pull);
            steady->slope_at[at] = front.slope;
            if (n == middle) break;
            const struct rock *rock = &line->rock[way > 0 ? at : at - 1];
            half = front;
            rises(steady, rock, m, &half, &rise);
            move(&half, way * line->step / 2, &rise);
            rises(steady, rock, m, &half, &rise);
            move(&front, way * line->step, &rise);
        }
    }
    return true;
}

size_t steady_all(const struct ground_line *line, double length, struct steady list[STEADY_MOST])
{
    const int d = line->dimension, m = d - 1;
    const double stress = line->here.mu;
    size_t count = 0;
    memset(list, 0, STEADY_MOST * sizeof *list);
    for (int i = 0; i < d; i++)
        list[count++].shift[i] = length;
    for (int i = 0; i < d; i++)
        list[count++].pull[i] = stress;
    for (int t = 0; t < m; t++)
        for (int i = 0; i < d; i++) {
            list[count++].slope.of[t][i] = 1;
            list[count++].pull_slope.of[t][i] = stress / length;
            for (int s = 0; s <= t; s++, count++)
                list[count].bend[t].of[s][i] = list[count].bend[s].of[t][i] = 1 / length;
        }
    for (int i = 0; i < d; i++)
        list[count++].acceleration[i] = stress / line->here.density / length;
    bool good = true;
    for (size_t n = 0; n < count && good; n++)
        good = lay(line, &list[n]);
    return good ? count : 0;
}

void steady_free(struct steady list[STEADY_MOST])
{
    for (size_t n = 0; n < STEADY_MOST; n++) {
        array_free(list[n].shift_at);
        array_free(list[n].pull_at);
        array_free(list[n].slope_at);
    }
}

static void to_axes(const struct ground_line *line, const double local[3], double vector[3])
{
    for (int axis = 0; axis < line->dimension; axis++) {
        vector[axis] = 0;
        for (int i = 0; i < line->dimension; i++)
            vector[axis] += line->basis[i][axis] * local[i];
    }
}

void steady_at(const struct ground_line *line, const struct steady *steady, const double place[3],
               double displacement[3])
{
    const int d = line->dimension, m = d - 1;
    double local[3], part, sum[3] = {0};
    ground_line_local(line, place, local);
    const size_t n = ground_line_step(line, local[m], &part);
    for (int i = 0; i < d; i++) {
        sum[i] = (1 - part) * steady->shift_at[n][i] + part * steady->shift_at[n + 1][i];
        for (int t = 0; t < m; t++) {
            sum[i] += local[t] *
                      ((1 - part) * steady->slope_at[n].of[t][i] + part * steady->slope_at[n + 1].of[t][i]);
            for (int s = 0; s < m; s++)
                sum[i] += local[t] * local[s] * steady->bend[t].of[s][i] / 2;
        }
    }
    to_axes(line, sum, displacement);
}

void steady_pull(const struct ground_line *line, const struct steady *steady, const double place[3],
                 const double normal[3], double pull[3])
{
    const int d = line->dimension, m = d - 1;
    double local[3], part, across[3] = {0}, rise[3] = {0}, toward[3] = {0}, sum[3] = {0}, spread = 0;
    struct slopes slope = {{{0}}};
    ground_line_local(line, place, local);
    const size_t n = ground_line_step(line, local[m], &part);
    const struct rock *rock = &line->rock[n];
    for (int i = 0; i < d; i++) {
        across[i] = (1 - part) * steady->pull_at[n][i] + part * steady->pull_at[n + 1][i];
        for (int t = 0; t < m; t++) {
            across[i] += local[t] * steady->pull_slope.of[t][i];
            slope.of[t][i] =
                (1 - part) * steady->slope_at[n].of[t][i] + part * steady->slope_at[n + 1].of[t][i];
            for (int s = 0; s < m; s++)
                slope.of[t][i] += local[s] * steady->bend[t].of[s][i];
        }
        for (int axis = 0; axis < d; axis++)
            toward[i] += line->basis[i][axis] * normal[axis];
    }
    rise_of(rock, m, across, &slope, rise);
    for (int i = 0; i < d; i++)
        spread += i == m ? rise[m] : slope.of[i][i];
    for (int i = 0; i < m; i++) {
        sum[i] = rock->lambda * spread * toward[i] + across[i] * toward[m];
        sum[m] += across[i] * toward[i];
        for (int t = 0; t < m; t++)
            sum[i] += rock->mu * (slope.of[t][i] + slope.of[i][t]) * toward[t];
    }
    sum[m] += across[m] * toward[m];
    to_axes(line, sum, pull);
}

void steady_slopes(const struct ground_line *line, const struct steady *steady, double slopes[3][3])
{
    const int d = line->dimension, m = d - 1;
    double rise[3] = {0};
    rise_of(&line->here, m, steady->pull, &steady->slope, rise);
    memset(slopes, 0, 9 * sizeof **slopes);
    for (int component = 0; component < d; component++)
        for (int axis = 0; axis < d; axis++)
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++)
                    slopes[component][axis] += line->basis[i][component] * line->basis[j][axis] *
                                               (j == m ? rise[i] : steady->slope.of[j][i]);
}

void steady_acceleration(const struct ground_line *line, const struct steady *steady, double acceleration[3])
{
    to_axes(line, steady->acceleration, acceleration);
}
