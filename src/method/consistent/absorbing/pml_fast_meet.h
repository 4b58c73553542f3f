/* Where slabs of absorbing layers meet: slopes that one takes from another (pml_fast.h, m_ff and m_bb); part of
 * pml_fast_steps.h. */

/* The part of a range of numbers n from `at` on that a block has along an axis. */
static struct range {
    size_t from, end;
} overlap(const struct block *block, int axis, size_t at, size_t n)
{
    const size_t end = block->at[axis] + block->n[axis];
    struct range range = {block->at[axis] > at ? block->at[axis] : at, end < at + n ? end : at + n};
    if (range.end < range.from) range.end = range.from;
    return range;
}

/* Where rows of a slab meet another one. */
struct meeting {
    size_t first, width; /* numbers along f, in whole vectors */
};

/* Takes `factor` * m_kk of another slab in row b into rows of the region; false: they do not meet. */
static bool take_slopes(const struct fast_slab *s, const struct fast_slab *other, size_t b, REAL factor,
                        REAL *rows, struct meeting *meeting)
{
    const struct block *inside = &other->inside;
    const struct range across = overlap(inside, s->axis[ROLE_S], s->start, s->region);
    const struct range row = overlap(inside, s->axis[ROLE_B], b, 1);
    const struct range along = overlap(inside, s->axis[ROLE_F], 0, s->nf);
    size_t step[3]; /* in the other's memory, by axis */
    if (across.from == across.end || row.from == row.end || along.from == along.end) return false;
    step[other->axis[ROLE_S]] = other->width;
    step[other->axis[ROLE_B]] = other->ns * other->width;
    step[other->axis[ROLE_F]] = 1;
    const size_t first = along.from / ROW_LANES * ROW_LANES;
    const size_t width = (along.end - first + ROW_LANES - 1) / ROW_LANES * ROW_LANES;
    const size_t step_s = step[s->axis[ROLE_S]], step_f = step[s->axis[ROLE_F]];
    const REAL *from = (const REAL *)other->middle + (across.from - inside->at[s->axis[ROLE_S]]) * step_s +
                       (b - inside->at[s->axis[ROLE_B]]) * step[s->axis[ROLE_B]] +
                       (along.from - inside->at[s->axis[ROLE_F]]) * step_f;
    memset(rows, 0, s->region * width * sizeof *rows);
    for (size_t r = 0; r < across.end - across.from; r++)
        for (size_t i = 0; i < along.end - along.from; i++)
            rows[(across.from - s->start + r) * width + along.from - first + i] =
                factor * from[r * step_s + i * step_f];
    *meeting = (struct meeting){first, width};
    return true;
}

/* Adds C2_j m_kk in row b to T_j, k the axis of the role given: slabs across it that meet this one's region.
 * Nothing above the level: nothing is added, and false; sum NULL: it is only looked whether something is. */
static bool add_divergence(const struct consistent *c, const struct fast_slab *s, enum role role, REAL level,
                           size_t b, REAL *rows, REAL *sum)
{
    const REAL factor = role == ROLE_B && s->beyond != NULL ? (REAL)s->beyond[b] : 1;
    bool added = false;
    struct meeting meeting;
    for (size_t o = 0; o < c->pml->slabs; o++) {
        const struct fast_slab *other = &FAST(c)->slab[o];
        if (other->axis[ROLE_S] != s->axis[role] || !take_slopes(s, other, b, factor, rows, &meeting))
            continue;
        if (!kernels()->loud(1, 0, s->region * meeting.width, level, rows)) continue;
        added = true;
        for (size_t g = 0; sum != NULL && g < s->divergence.groups; g++) {
            const struct row_group *group = &s->divergence.group[g];
            apply_group(group, rows, meeting.width, meeting.width, true,
                        sum + group->to * s->width + meeting.first, s->width, NULL);
        }
    }
    return added;
}
