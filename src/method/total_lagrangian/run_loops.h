/* Blocks of points of total-Lagrangian SPH and the loops over their neighbours. */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_RUN_LOOPS_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_RUN_LOOPS_H

#include "base/vectors.h"
#include "method/total_lagrangian/total_lagrangian.h"

/* Each takes a block of its own kind (tl->gradient_blocks, ...) and writes the block's points only, so blocks
 * may be done in any order and at the same time: H from the displacements of the sites; A and the hourglass
 * forces from H; the forces from A. */
void tl_gradient_block(struct tl_model *tl, const struct tl_block *block);
void tl_stress_block(struct tl_model *tl, const struct tl_block *block);
void tl_force_block(struct tl_model *tl, const struct tl_block *block);

/* point_loops.c: the same for blocks that are no runs; the second adds hourglass control to A. */
void tl_gradient_points(struct tl_model *tl, const struct tl_block *block);
void tl_control_points(struct tl_model *tl, const struct tl_block *block);
void tl_force_points(struct tl_model *tl, const struct tl_block *block);

#endif
