/* A simulation that ranks share (doc/howto/ranks.md): what they are told, and what runs on one rank alone. */
#include "base/crc64.h"
#include "host/simulation.h"
#include "parallel/few_ranks.h"
#include "scene/ground.h"

#include <math.h>
#include <string.h>

selas_status simulation_share(selas_simulation *simulation, struct ranks *ranks, selas_status status)
{
    struct crc64_table table;
    simulation->ranks = ranks;
    if (simulation->scene != NULL) simulation->scene->ranks = ranks;
    status = ranks_agree(ranks, status, &simulation->messages);
    if (status != SELAS_OK || ranks_count(ranks) == 1) return status;
    crc64_prepare(&table);
    const char *text = deck_source(simulation->deck);
    if (ranks_same(ranks, crc64_add(&table, 0, text, strlen(text)))) return SELAS_OK;
    return fail(&simulation->messages, SELAS_BAD_DECK, "ranks have read different decks '%s'",
                deck_source_path(simulation->deck));
}

selas_status selas_share_handle(selas_simulation *simulation, int communicator)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    if (simulation == NULL || door_refused(simulation)) return SELAS_BAD_ARGUMENT;
    struct messages *messages = &simulation->messages;
    if (simulation->joined != NULL || simulation->model != NULL)
        return fail(messages, SELAS_BAD_ARGUMENT, "a simulation is shared once, right after it is opened");
    selas_status status = ranks_join(communicator, &simulation->joined, messages);
    if (status != SELAS_OK) return status;
    status =
        simulation->broken == SELAS_OK && simulation->deck == NULL ? SELAS_BAD_ARGUMENT : simulation->broken;
    status = simulation_share(simulation, simulation->joined, status);
    simulation_failed(simulation, status);
    return status;
}

selas_status shared_check(selas_simulation *simulation)
{
    const struct host *host = &simulation->host;
    bool functions = false;
    for (size_t face = 0; face < FACES; face++)
        functions = functions || host->face[face].function != NULL;
    for (size_t i = 0; i < host->loads; i++)
        functions = functions || host->load[i].function != NULL;
    ground_model_forget(simulation->scene->body.model);
    if (ranks_count(simulation->ranks) == 1 || !functions) return SELAS_OK;
    return fail(&simulation->messages, SELAS_UNSUPPORTED,
                "a function of the host that drives a load or a face: on one rank only; selas_set_load gives "
                "values on "
                "ranks, too");
}

selas_status shared_alone(selas_simulation *simulation, const char *what)
{
    if (ranks_count(simulation->ranks) == 1) return SELAS_OK;
    return fail(&simulation->messages, SELAS_UNSUPPORTED, "%s: on one rank only", what);
}

void shared_add_times(selas_simulation *simulation, double wall, double waited)
{
    simulation->figures.here.worked += wall - waited;
    simulation->figures.here.waited += waited;
}

void shared_gather_times(selas_simulation *simulation)
{
    struct run_figures *figures = &simulation->figures;
    const double count = ranks_count(simulation->ranks);
    double sum[2] = {figures->here.worked, figures->here.waited}, longest[2] = {sum[0], sum[1]};
    if (count == 1) return;
    ranks_sum(simulation->ranks, 2, sum);
    ranks_largest(simulation->ranks, 2, longest);
    figures->mean = (struct rank_times){sum[0] / count, sum[1] / count};
    figures->longest = (struct rank_times){longest[0], longest[1]};
}

selas_status shared_made(selas_simulation *simulation, selas_status status)
{
    const struct ground_model *ground = simulation->scene->body.model;
    ground_model_bytes(ground, simulation->figures.ground);
    ranks_largest(simulation->ranks, 2, simulation->figures.ground);
    ground_model_forget(ground);
    return ranks_agree(simulation->ranks, status, &simulation->messages);
}

selas_status shared_prepared(selas_simulation *simulation, selas_status status)
{
    const struct ground_model *ground = simulation->scene->body.model;
    ground_model_forget(ground);
    if (status == SELAS_OK && !ground_model_sound(ground))
        status = fail(&simulation->messages, SELAS_FILE_ERROR,
                      "values of the &model cannot be read any more, or there is no memory for them");
    return ranks_agree(simulation->ranks, status, &simulation->messages);
}

selas_status shared_value(selas_simulation *simulation, const char *load, double value)
{
    const bool sound = isfinite(value);
    double all[3] = {sound ? 0 : 1, sound ? value : 0, sound ? -value : 0};
    ranks_largest(simulation->ranks, 3, all);
    if (all[0] > 0)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "the value of load '%s' is not a finite number", load);
    if (all[1] + all[2] == 0) return SELAS_OK;
    return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "ranks give load '%s' values from %.6g to %.6g",
                load, -all[2], all[1]);
}
