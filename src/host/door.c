/* The library's door: what each of its functions does first and last, which thread is inside a simulation, and what was
 * said. */
#include "host/simulation.h"

#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Handles that are open: others, of a simulation that was closed or never opened, are not looked into. They are kept as
 * numbers that are no addresses, so that leak checkers still see a simulation that its host has lost. The lock is that
 * of simulation->inside, too. */
static struct {
    pthread_mutex_t lock;
    uintptr_t *of;
    size_t count, room;
} open_ones = {.lock = PTHREAD_MUTEX_INITIALIZER};

/* A thread is known by the address of its own one. */
static _Thread_local char thread;
/* The handle that this thread may not look into, last, and why. */
static _Thread_local const selas_simulation *refused;
static _Thread_local const char *why = "";

static uintptr_t number_of(const selas_simulation *simulation)
{
    return ~(uintptr_t)simulation;
}

/* Among those that are open; their number if it is none. */
static size_t place_of(const selas_simulation *simulation)
{
    size_t place = 0;
    while (place < open_ones.count && open_ones.of[place] != number_of(simulation))
        place++;
    return place;
}

bool door_open(const selas_simulation *simulation)
{
    pthread_mutex_lock(&open_ones.lock);
    if (open_ones.count == open_ones.room) {
        const size_t room = 2 * open_ones.room + 8;
        uintptr_t *grown = realloc(open_ones.of, room * sizeof *grown);
        if (grown != NULL) {
            open_ones.of = grown;
            open_ones.room = room;
        }
    }
    const bool good = open_ones.count < open_ones.room;
    if (good) open_ones.of[open_ones.count++] = number_of(simulation);
    pthread_mutex_unlock(&open_ones.lock);
    return good;
}

void door_close(const selas_simulation *simulation)
{
    pthread_mutex_lock(&open_ones.lock);
    open_ones.of[place_of(simulation)] = open_ones.of[open_ones.count - 1];
    if (--open_ones.count == 0) {
        free(open_ones.of);
        open_ones.of = NULL;
        open_ones.room = 0;
    }
    pthread_mutex_unlock(&open_ones.lock);
}

bool door_known(const selas_simulation *simulation)
{
    pthread_mutex_lock(&open_ones.lock);
    const bool known = place_of(simulation) < open_ones.count;
    pthread_mutex_unlock(&open_ones.lock);
    return known;
}

bool door_taken(selas_simulation *simulation)
{
    pthread_mutex_lock(&open_ones.lock);
    const bool known = place_of(simulation) < open_ones.count;
    const char *before = known ? simulation->inside : NULL;
    const bool taken = known && before == NULL;
    if (taken) simulation->inside = &thread;
    pthread_mutex_unlock(&open_ones.lock);
    refused = taken || (known && before == &thread) ? NULL : simulation;
    why = known ? "error: another thread is inside a call of this simulation; one thread at a time would be "
                  "right\n"
                : "error: no simulation: the handle was not opened, or is closed\n";
    return taken;
}

bool door_refused(const selas_simulation *simulation)
{
    return simulation != NULL && refused == simulation;
}

struct door door_enter(selas_simulation *simulation)
{
    struct door door = {.locale = c_locale_begin(), .rules = float_rules_begin()};
    const bool outermost =
        door.locale.host != door.locale.own; /* the functions of the library call each other */
    if (simulation == NULL) refused = NULL;  /* a new one may lie where the other lay */
    if (simulation == NULL) return door;
    if (door_taken(simulation)) door.entered = simulation;
    if (door_refused(simulation) || !outermost) return door;
    simulation->host_locale = door.locale.host;
    simulation->host_rules = door.rules.host;
    return door;
}

void door_leave(const struct door *door)
{
    pthread_mutex_lock(&open_ones.lock);
    if (door->entered != NULL) door->entered->inside = NULL;
    pthread_mutex_unlock(&open_ones.lock);
    float_rules_end(&door->rules);
    c_locale_end(&door->locale);
}

/* --- What was said --- */

void simulation_call(selas_simulation *simulation)
{
    if (simulation == NULL || door_refused(simulation) || simulation->busy) return;
    simulation->call = simulation->messages.length;
    simulation->consequence = false;
}

void simulation_keep_failure(selas_simulation *simulation)
{
    simulation->failure[0] = simulation->call;
    simulation->failure[1] = simulation->messages.length;
}

void simulation_failed(selas_simulation *simulation, selas_status status)
{
    simulation->failed = status;
    if (status != SELAS_OK) simulation_keep_failure(simulation);
}

selas_status simulation_consequence(selas_simulation *simulation, selas_status status)
{
    simulation->consequence = true;
    return status;
}

/* Where no message of the simulation is this thread's; else NULL. */
static const char *nobodys(const selas_simulation *simulation)
{
    if (simulation == NULL) return "no simulation (the handle is NULL)";
    return door_refused(simulation) ? why : NULL;
}

const char *selas_message(const selas_simulation *simulation)
{
    const char *other = nobodys(simulation);
    if (other != NULL) return other;
    if (!door_known(simulation)) return "error: no simulation: the handle was not opened, or is closed\n";
    return simulation->messages.text != NULL ? simulation->messages.text : "";
}

const char *selas_last_message(selas_simulation *simulation)
{
    const char *other = nobodys(simulation);
    if (other != NULL) return other;
    AT_THE_DOOR(simulation);
    other = nobodys(simulation);
    if (other != NULL) return other;
    const size_t from = simulation->consequence ? simulation->failure[0] : simulation->call;
    const size_t to = simulation->consequence ? simulation->failure[1] : simulation->messages.length;
    free(simulation->last);
    simulation->last = to > from ? strndup(simulation->messages.text + from, to - from) : NULL;
    return simulation->last != NULL ? simulation->last : "";
}
