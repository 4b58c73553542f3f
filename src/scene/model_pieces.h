/* Values of a model's grid that are not kept whole (doc/developers/ranks.md): pieces of it are read when they are asked
 * for, and kept until they are many. What looks at all values goes through the grid box by box. */
#ifndef SELAS_SCENE_MODEL_PIECES_H
#define SELAS_SCENE_MODEL_PIECES_H

#include "scene/scene.h"

struct model_pieces;

/* Where the values come from: fills box->value[set] [n[0] n[1] n[2]], z fastest, of all sets with those from first[]
 * on, counted in the grid; one thread at a time. False: they cannot be read. */
struct model_origin {
    bool (*read)(void *context, const struct model_grid *box, const size_t first[3]);
    void (*free)(void *context);
    void *context;
    int sets;
    const struct model_grid *of; /* that in pieces which they are made of, or NULL */
};

/* Gives a grid of known places its pieces, and owns the context from then on; false without memory. */
bool model_pieces_new(struct model_grid *grid, const struct model_origin *origin);
void *model_pieces_context(const struct model_grid *grid);
void model_pieces_free(struct model_grid *grid);

/* The values at indices of the grid: of set s there is value[s * step[3]]; those `up` places on along each axis are
 * up[0] step[0] + up[1] step[1] + up[2] further, as far as up <= left. */
struct model_piece {
    const double *value;
    size_t step[4], left[3];
};
/* Any thread may ask, between model_pieces_look() and model_pieces_looked(): meanwhile nothing is let go of. Where they
 * cannot be read, some of a rock, and ground_model_sound() says so. */
struct model_piece model_pieces_at(const struct model_grid *grid, const size_t at[3]);
void model_pieces_look(const struct model_grid *grid);
void model_pieces_looked(const struct model_grid *grid);
/* Lets go of what is kept; no other thread asks meanwhile. */
void model_pieces_forget(const struct model_grid *grid);
/* Bytes of all pieces that were asked for since then. */
size_t model_pieces_asked(const struct model_grid *grid);
/* Bytes that may be kept: `most`, or what tests ask for (SELAS_MODEL_KEPT). */
double model_pieces_kept(double most);
/* Was there anything that could not be read? */
bool model_pieces_broken(const struct model_grid *grid);

/* Fills box->value with values from first[] on, for the origin of other pieces; box->n says how many. */
bool model_pieces_read(const struct model_grid *grid, const struct model_grid *box, const size_t first[3]);

/* Values that take those of the first rock below them: of each column [n[0] n[1]] how many from the top, and what they
 * become [sets]. Owned from then on. */
void model_pieces_fill(struct model_grid *grid, unsigned *rock, double *value);

/* Hands all values of a grid to `visit`, in the order of the grid: those kept whole at once, else whole columns in
 * boxes of a few MB, which have the grid's places. Ends with false when visit does, with false and *unread where they
 * cannot be read. */
typedef bool model_visit(void *context, const struct model_grid *box, size_t first_column);
bool model_walk(const struct model_grid *grid, model_visit *visit, void *context, bool *unread);

#endif
