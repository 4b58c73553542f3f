/* A simulation that ranks share (doc/ranks.md): what they are told, and what runs on one rank alone. */
#include "host/simulation.h"
#include "parallel/ranks.h"

void simulation_share(selas_simulation *simulation, struct ranks *ranks)
{
    simulation->ranks = ranks;
    if (simulation->scene != NULL) simulation->scene->ranks = ranks;
}

selas_status shared_check(selas_simulation *simulation)
{
    if (ranks_count(simulation->ranks) == 1 || !scene_driven(simulation->scene)) return SELAS_OK;
    return fail(&simulation->messages, SELAS_UNSUPPORTED,
                "a host that drives loads or faces: on one rank only");
}
