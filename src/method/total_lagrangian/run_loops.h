/* The loops over neighbours of total-Lagrangian SPH, for each kind of processor. */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_RUN_LOOPS_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_RUN_LOOPS_H

#include "base/vectors.h"
#include "method/total_lagrangian/total_lagrangian.h"

/* Takes a block of its own kind (tl->gradient_blocks, ...) and writes the block's points only, so blocks may
 * be done in any order and at the same time: H from the displacements of the sites; A and the hourglass
 * forces from H; the forces from A. */
typedef void tl_block_loop(struct tl_model *tl, const struct tl_block *block);

/* By dimension less one. run_loops.c: runs; stress: of any block, with hourglass control in runs. */
struct tl_run_loops {
    tl_block_loop *gradient[3], *stress[3], *force[3];
};
EACH_PROCESSOR(struct tl_run_loops, tl_run_loops)

/* point_loops.c: blocks that are no runs; control: adds hourglass control to A. */
struct tl_point_loops {
    tl_block_loop *gradient[3], *control[3], *force[3];
};
EACH_PROCESSOR(struct tl_point_loops, tl_point_loops)

#endif
