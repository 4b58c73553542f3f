/* Stops one run of a deck at random steps: a checkpoint at each, and from each a restart with one or more
 * threads to the end, whose state and histories must have the bits of a run that nobody stopped. Arguments:
 * number of threads, number of stops, seed, deck, overrides. Prints how many restarts were compared; exit
 * status 1 if any differs. */
#include "host/simulation.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct task {
    const char *deck;
    size_t overrides;
    const char *const *override;
    char path[64];
    int threads;
};

static selas_simulation *opened(const struct task *task, int threads)
{
    selas_simulation *simulation = NULL;
    omp_set_num_threads(threads);
    if (selas_open_deck_with(task->deck, task->overrides, task->override, &simulation) == SELAS_OK &&
        selas_steps_needed(simulation) > 0)
        return simulation;
    fprintf(stderr, "%s", selas_message(simulation));
    exit(2);
}

static void need(selas_simulation *simulation, selas_status status)
{
    if (status == SELAS_OK) return;
    fprintf(stderr, "%s", selas_message(simulation));
    exit(2);
}

static bool same_numbers(const char *what, const double *one, const double *other, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(one + i, other + i, sizeof *one) != 0) {
            printf("%s: number %zu of %zu is %.17g in place of %.17g\n", what, i, count, other[i], one[i]);
            return false;
        }
    return true;
}

/* State, acceleration and histories of two runs that are over. */
static bool same(selas_simulation *whole, selas_simulation *other)
{
    const struct model *model = whole->model;
    state_settle(whole->stepper, &whole->state, true);
    state_settle(other->stepper, &other->state, true);
    bool good = same_numbers("state", whole->state.y, other->state.y, model->state_size) &&
                same_numbers("acceleration", whole->state.a, other->state.a, model->unknowns);
    for (size_t r = 0; r < whole->scene->receivers && good; r++) {
        const struct history_rows one = recorder_history(whole->recorder, r);
        const struct history_rows two = recorder_history(other->recorder, r);
        good = one.rows == two.rows && same_numbers("history", one.value, two.value, 6 * one.rows);
    }
    return good;
}

/* One stop: runs to the step, saves, goes on in another simulation. */
static bool stopped_at(const struct task *task, selas_simulation *whole, unsigned long step, int before,
                       int after)
{
    selas_simulation *first = opened(task, before);
    need(first, selas_step(first, step));
    need(first, selas_save(first, task->path));
    selas_close(&first);
    selas_simulation *second = opened(task, after);
    need(second, selas_restore(second, task->path));
    need(second, selas_finish(second));
    const bool good = same(whole, second);
    if (!good) printf("stopped at step %lu with %d threads, gone on with %d\n", step, before, after);
    selas_close(&second);
    return good;
}

int main(int count, char **words)
{
    if (count < 5) return 2;
    struct task task = {.deck = words[4],
                        .overrides = (size_t)count - 5,
                        .override = (const char *const *)(words + 5),
                        .threads = atoi(words[1])};
    const int stops = atoi(words[2]);
    unsigned seed = (unsigned)atoi(words[3]);
    snprintf(task.path, sizeof task.path, "/tmp/selas-stops-%ld.h5", (long)getpid());
    selas_simulation *whole = opened(&task, 1);
    const unsigned long steps = selas_steps_needed(whole);
    need(whole, selas_finish(whole));
    int differ = 0;
    for (int i = 0; i < stops; i++) {
        const unsigned long step = 1 + (unsigned long)rand_r(&seed) % (steps - 1);
        const int before = i % 4 == 3 ? 1 : task.threads, after = i % 4 == 2 ? 1 : task.threads;
        if (!stopped_at(&task, whole, step, before, after)) differ++;
    }
    printf("%zu points, %lu steps: %d restarts, %d differ\n", whole->model->points, steps, stops, differ);
    selas_close(&whole);
    remove(task.path);
    return differ > 0;
}
