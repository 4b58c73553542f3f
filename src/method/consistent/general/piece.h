/* Averages of the rock over pieces of a column (doc/theory/general-ground.md, section 4). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_PIECE_H
#define SELAS_METHOD_CONSISTENT_GENERAL_PIECE_H

#include "method/consistent/general/medium.h"

enum {
    PIECES = 10,      /* of half a cell, that the widest kernel reaches over */
    RING = PIECES + 2 /* pieces over depth that are kept: planes of knots and of middles of a cell */
};
static const double reach_of_kernel = PIECES / 4.; /* cells, on either side */

/* Half a cell over depth: means of a quantity and of it times the height over the middle, in cells. The kernels are
 * linear there, so that a plane's averages are sums over its pieces (G11b). */
struct piece {
    double mean[2][AVERAGES], cell[CELL], least[POSITIVE], slope[FLAT];
    bool even;
    unsigned alike; /* so many before it, one after the other, are the same rock */
};

/* (G11): t in cells from the point. */
double piece_kernel(enum at at, double t);
/* One sample of the rock, `height` cells over the middle of the piece, of which it is `part`; shares: of a part of
 * damped ground, else NULL. */
void piece_sample(const struct rock *rock, const struct shares *shares, double height, double part,
                  struct piece *piece);
/* Counts those that are the same rock, from the one before it; NULL: it is the first. */
void piece_follow(const struct piece *before, struct piece *piece);
/* sum += weight * one: averages (`cell`: the weight in the cell's). */
void piece_add(const struct piece *one, double weight, double cell, struct piece *sum);
/* (G10a) along a slot: integrals of the kernel and its first two slopes over a piece, cells from the point; and
 * sum += what the piece, of which slopes along the slots before are known, has in all slopes. */
void piece_smooth(double from, double to, double weight[3]);
void piece_slopes(const double slope[], int slot, const double weight[3], double sum[]);
/* Upside down. */
void piece_turn(struct piece *piece);
/* (G11b): from pieces on either side of a point of a family's plane, the first of which has this number, of `pieces` in
 * the lattice; ring[plane * ...]: number modulo RING. */
void piece_average(const struct piece *ring, size_t plane, enum at at, ptrdiff_t first, ptrdiff_t pieces,
                   struct averaged *sum);

#endif
