/* A simulation that ranks share (doc/howto/ranks.md): what they are told, and what runs on one rank alone. */
#include "host/simulation.h"
#include "parallel/ranks.h"

void simulation_share(selas_simulation *simulation, struct ranks *ranks)
{
    simulation->ranks = ranks;
    if (simulation->scene != NULL) simulation->scene->ranks = ranks;
}

selas_status shared_check(selas_simulation *simulation)
{
    const struct scene *scene = simulation->scene;
    if (ranks_count(simulation->ranks) == 1) return SELAS_OK;
    const struct deck_group *output = scene->deck != NULL ? deck_get(scene->deck, "output", 0) : NULL;
    const bool checkpoints = output != NULL && (deck_given(output, "checkpoint_every") ||
                                                deck_given(output, "checkpoint_minutes"));
    const char *what = scene->snapshots > 0  ? "&snapshot"
                       : checkpoints         ? "checkpoints (output%checkpoint_every, checkpoint_minutes)"
                       : simulation->work    ? "a restart"
                       : scene_driven(scene) ? "a host that drives loads or faces"
                                             : NULL;
    if (what == NULL) return SELAS_OK;
    return fail(&simulation->messages, SELAS_UNSUPPORTED,
                "%s: on one rank only; start it without mpirun, or leave it out", what);
}

/* What a profile shows of velocities in one pass hangs on when the watch looks, and that on the rank. */
selas_status shared_check_model(selas_simulation *simulation)
{
    const bool one_pass = model_computed(simulation->model)->one_pass != NULL;
    if (ranks_count(simulation->ranks) == 1 || simulation->scene->profiles == 0 || !one_pass) return SELAS_OK;
    return fail(&simulation->messages, SELAS_UNSUPPORTED,
                "&profile beside steps in one pass: on one rank only; start it without mpirun, or take "
                "method%%fused = "
                ".false.");
}
