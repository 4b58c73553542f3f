/* Rows of absorbing layers in which nothing moves (pml_fast.h); part of pml_fast_steps.h. */

/* Up to here displacements, velocities, slopes and accelerations move nothing. */
struct level {
    REAL displacement, velocity, slope, force;
};

/* (Displacements in the middle of a step are u + to_middle v, and v reaches farther than u.) */
static struct level levels(const struct consistent *c, double displacement, double to_middle)
{
    const double spacing = c->model.scene->body.spacing;
    const double stiffness = pow(consistent_fastest(c, FACE_X_LOW), 2);
    if (!(c->options.quiet > 0)) return (struct level){-1, -1, -1, -1};
    return (struct level){(REAL)displacement, (REAL)(displacement / fabs(to_middle)),
                          (REAL)(displacement / spacing),
                          (REAL)(displacement * stiffness / (spacing * spacing))};
}

/* Row b of a memory variable: is any of it larger than the level? */
static bool memory_loud(const struct fast_slab *s, REAL level, size_t b, const REAL *memory)
{
    const size_t size = s->ns * s->width;
    return kernels()->loud(3, s->nb * size, size, level, memory + b * size);
}

/* What is 0 already is not written. */
static void forget_memory(const struct fast_slab *s, size_t b, REAL *memory)
{
    const size_t size = s->ns * s->width;
    if (!memory_loud(s, 0, b, memory)) return;
    for (size_t i = 0; i < 3; i++)
        memset(memory + (i * s->nb + b) * size, 0, size * sizeof *memory);
}

/* Is any number larger than the level that row b reads of a field? */
static bool field_loud(const struct consistent *c, const struct fast_slab *s, REAL level, size_t b,
                       const REAL *field)
{
    const bool across = s->step[ROLE_F] != 1; /* then numbers of a row along s stand together */
    for (size_t i = 0; i < 3; i++) {
        const REAL *from = field + i * c->volume + s->first + b * s->step[ROLE_B];
        if (across ? kernels()->loud(s->nf, s->step[ROLE_F], s->region, level, from)
                   : kernels()->loud(s->region, s->step[ROLE_S], s->nf, level, from))
            return true;
    }
    return false;
}

/* Is the row at rest: displacements and velocities that it reads, and psi? Not phi: ranks know that of own rows. */
static bool rests(const struct consistent *c, const struct fast_slab *s, struct level level, size_t b,
                  const REAL *u, const REAL *v, const REAL *extra)
{
    return level.displacement >= 0 && !field_loud(c, s, level.displacement, b, u) &&
           !field_loud(c, s, level.velocity, b, v) && !memory_loud(s, level.slope, b, extra + s->slab->psi);
}

/* A row at rest forgets psi and what waits. */
static void forget_row(const struct fast_slab *s, size_t b, REAL *extra)
{
    const size_t size = s->ns * s->width;
    forget_memory(s, b, extra + s->slab->psi);
    if (s->idle[b]) return;
    for (size_t i = 0; i < s->parts; i++)
        if (s->wait[i] != NULL) memset((REAL *)s->wait[i] + b * size, 0, size * sizeof *extra);
    for (size_t n = 0; n < s->overs; n++)
        memset((REAL *)s->over[n].wait + b * size, 0, size * sizeof *extra);
    memset((REAL *)s->middle + b * size, 0, size * sizeof *extra);
    s->idle[b] = true;
}

/* Do ranks share the rows of the slab along f? Then what rests in one of them may move in another. */
static bool shares_rows(const struct consistent *c, const struct fast_slab *s)
{
    return part_rows(&c->part) && s->axis[ROLE_F] == 1 && c->options.quiet > 0;
}

/* Is row b the rank's own? */
static bool owns_row(const struct consistent *c, const struct fast_slab *s, size_t b)
{
    const struct part_axis *own = &c->part.along[s->axis[ROLE_B]];
    return b >= own->own && b < own->end;
}

/* One of a group of rows? */
static bool owns_group(const struct consistent *c, const struct fast_slab *s, size_t g)
{
    const struct row_group *group = &s->pull_b.group[g];
    return owns_row(c, s, group->to) || owns_row(c, s, group->to + group->rows - 1);
}

/* Together: rows that rest, or with `moves` those that move, become those of all ranks. */
static void agree(const struct consistent *c, bool moves)
{
    const size_t whole = c->part.along[DEPTH].whole;
    double *told = FAST(c)->told;
    if (!part_rows(&c->part) || !(c->options.quiet > 0)) return;
    for (int turn = 0; turn < 2; turn++) {
        if (turn == 1) ranks_largest(c->part.ranks, 2 * whole, told);
        if (turn == 0) memset(told, 0, 2 * whole * sizeof *told);
        for (size_t i = 0; i < c->pml->slabs; i++) {
            const struct fast_slab *s = &FAST(c)->slab[i];
            double *tell = told + (size_t)s->slab->end * whole + s->first_b;
            for (size_t b = 0; b < s->nb && shares_rows(c, s); b++) {
                bool *flag = moves ? &s->moves[b] : &s->rests[b];
                if (turn == 0)
                    tell[b] = *flag == moves ? 1 : 0;
                else
                    *flag = (tell[b] > 0) == moves && (!moves || owns_row(c, s, b));
            }
        }
    }
}

/* Do all rows rest that rows from .. end - 1 are made from? */
static bool rows_rest(const struct fast_slab *s, size_t from, size_t end)
{
    const size_t reach = s->taps_f / 2;
    for (size_t b = from < reach ? 0 : from - reach; b < end + reach && b < s->nb; b++)
        if (!s->rests[b]) return false;
    return true;
}

/* Does any of a group of rows move? */
static bool group_moves(const struct fast_slab *s, size_t g)
{
    const struct row_group *group = &s->pull_b.group[g];
    for (size_t b = group->to; b < group->to + group->rows; b++)
        if (s->moves[b]) return true;
    return false;
}
