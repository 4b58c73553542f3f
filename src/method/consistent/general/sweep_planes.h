/* What a sweep does with the forces of a plane that is complete (sweep.h), for numbers of type REAL; included by
 * sweep_double.c and sweep_single.c: ends, edges, loads, N and the update. */

/* Forces of unclamped splines to those of the open ends, along y. */
static void clamp_rows(const struct sweep *s, const struct rings *r, size_t k, size_t component)
{
    for (int high = 0; high < 2; high++) {
        const size_t row = high ? unclamped(s, 1) - 1 : 0, next = high ? row - 1 : 1;
        clamp_end(s->width, s->mirror[1][high], component == 1, force_row(s, r, k, component, row),
                  force_row(s, r, k, component, next));
    }
}

/* The same along x: a row. */
static void clamp_row(const struct sweep *s, size_t component, REAL *row)
{
    const size_t last = s->cells[0] + 1;
    const REAL sign = component == 0 ? -1 : 1;
    row[1] += (s->mirror[0][0] ? sign : -1) * row[0];
    row[last - 1] += (s->mirror[0][1] ? sign : -1) * row[last];
    if (!s->mirror[0][0]) row[0] *= 2;
    if (!s->mirror[0][1]) row[last] *= 2;
}

/* Does a point at an edge see anything that moves? If so pairs touch all rows that it sees. */
static bool edge_is_loud(const struct pass *pass, const struct edge_point *point)
{
    for (size_t k = point->plane; k < point->plane_end; k++)
        for (size_t j = point->row; j < point->row_end; j++)
            if (!(pass->s->size[k * pass->s->n[1] + j] <= pass->level)) return true;
    return false;
}

/* Stresses of all parts at it, by slot. */
static void edge_stress(const struct pass *pass, size_t n, double stress[3][3])
{
    const struct sweep *s = pass->s;
    memset(stress, 0, 9 * sizeof(double));
    if (!edge_is_loud(pass, &pass->c->general->edges->point[n])) return;
    for (size_t p = 0; p < pass->fields->parts; p++) {
        const struct edges *edges = pass->fields->part[p].ground->edges;
        const struct edge_point *point = &edges->point[n];
        double slope[3][3];
        for (size_t component = 0; component < 3; component++)
            NAME(taken_sweep_kernels)
        ()->edge_slopes(&point->of[component], edges->slope + point->of[component].at, s->n,
                        pass->fields->part[p].u + component * s->volume, slope[component]);
        general_edge_stress(point, slope, stress);
    }
}

static double (*edge_ring(const struct pass *pass, const struct rings *r, size_t k))[3][3]
{
    return (double(*)[3][3])r->edge + k % SPAN * pass->c->general->edges->most;
}

/* Stresses of the edges' points that plane k sees, if they are not made yet. */
static void make_edges(const struct pass *pass, struct rings *r, size_t k)
{
    const struct edges *edges = pass->c->general->edges;
    for (size_t p = less(k, SPAN - 1); edges != NULL && p <= k; p++) {
        if (r->edged[p % SPAN] == p + 1) continue;
        r->edged[p % SPAN] = p + 1;
        for (size_t n = edges->start[p]; n < edges->start[p + 1]; n++)
            edge_stress(pass, n, edge_ring(pass, r, p)[n - edges->start[p]]);
    }
}

/* What they pull at in plane k, off the forces on its control values. */
static void add_edges(const struct pass *pass, const struct rings *r, size_t k, size_t component)
{
    const struct sweep *s = pass->s;
    const struct edges *edges = pass->c->general->edges;
    for (size_t p = less(k, SPAN - 1); edges != NULL && p <= k; p++)
        for (size_t n = edges->start[p]; n < edges->start[p + 1]; n++) {
            const struct edge_taps *of = &edges->point[n].of[component];
            const double *pull = edge_ring(pass, r, p)[n - edges->start[p]][component];
            if (k < of->plane || k >= of->plane + of->planes) continue;
            NAME(taken_sweep_kernels)
            ()->edge_pulls(of, edges->slope + of->at + (k - of->plane) * of->rows * EDGE_ROW, pull, s->stride,
                           force_row(s, r, k, component, s->low[1]) + s->low[0]);
        }
}

static void add_loads(const struct pass *pass, const struct rings *r, size_t k, size_t component)
{
    const struct sweep *s = pass->s;
    const struct drive *drive = pass->drive;
    const REAL *root = (const REAL *)s->root + k * s->plane;
    const struct sparse_list *loads = &pass->c->load;
    const size_t at = component * s->n[2] + k;
    for (size_t i = loads->start[at]; drive->load != NULL && i < loads->start[at + 1]; i++) {
        const size_t l = loads->number[i], part = loads->part[i];
        const struct sparse *load = &loads->of[l];
        const double amplitude = drive->load[l] * pass->c->model.scene->load[l].amplitude;
        for (size_t e = load->start[part]; amplitude != 0 && e < load->start[part + 1]; e++) {
            const size_t index = load->index[e];
            r->scaled[index / s->n[0] * s->stride + index % s->n[0]] +=
                root[index] * (REAL)(amplitude * load->value[e]);
        }
    }
}

static REAL *ready_row(const struct sweep *s, size_t component, size_t k, size_t j)
{
    return (REAL *)s->ready + GROUP + ((component * s->n[2] + k) * s->rows + j) * s->stride;
}

/* N along y and x of rows `rows` of `scaled`, for rows `filled`. */
static void pass_along(const struct sweep *s, const struct rings *r, size_t component, size_t k,
                       const struct rows *rows, const struct rows *filled)
{
    const struct NAME(fused_kernels) *kernels = NAME(taken_fused_kernels)();
    enum { WIDE = 2 };
    for (size_t j = filled->from; j < filled->end; j += FUSED_ROWS) {
        const REAL *in[SWEEP_TAPS + FUSED_ROWS - 1];
        for (size_t t = 0; t < SWEEP_TAPS + FUSED_ROWS - 1; t++) {
            const size_t row = j + t - SWEEP_REACH; /* wraps round below 0 */
            in[t] = row >= rows->from && row < rows->end ? r->scaled + row * s->stride : r->zero;
        }
        const REAL *weight = (const REAL *)s->y[component] + j * SWEEP_TAPS;
        (s->plain[j / FUSED_ROWS] ? kernels->of[WIDE].y : kernels->of[WIDE].y_ends)(
            weight, in, r->zero, s->width, s->stride, r->passed);
        kernels->of[WIDE].x(s->x[component], r->passed, r->zero, s->width, s->stride,
                            ready_row(s, component, k, j));
    }
}

static void forget_plane(const struct pass *pass, struct rings *r, size_t k)
{
    const struct sweep *s = pass->s;
    forget_parts(pass, r, k);
    memset(force_row(s, r, k, 0, 0), 0, 3 * unclamped(s, 1) * s->stride * sizeof(REAL));
    r->touched[k % SPAN] = (struct rows){0, 0};
}

/* The forces of plane k are complete. */
static void plane_done(const struct pass *pass, struct rings *r, size_t k)
{
    struct sweep *s = pass->s;
    struct rows *touched = &r->touched[k % SPAN], rows = {0, 0};
    if (touched->from < touched->end) {
        rows.from = less(touched->from, s->low[1]);
        rows.end = touched->end - s->low[1] < s->n[1] ? touched->end - s->low[1] : s->n[1];
    }
    if (pass->drive->load != NULL) join(&rows, s->loaded[k].from, s->loaded[k].end);
    join_layers(pass, k, &rows);
    struct rows *filled = &s->filled[k];
    const bool later = waits(pass, k);
    *filled = (struct rows){0, 0};
    s->waiting[k] = rows;
    if (rows.from >= rows.end) return;
    layers_done(pass, r, k, &rows);
    make_edges(pass, r, k);
    filled->from = less(rows.from, SWEEP_REACH) / FUSED_ROWS * FUSED_ROWS;
    filled->end = rows.end + SWEEP_REACH < s->n[1] ? rows.end + SWEEP_REACH : s->n[1];
    for (size_t component = 0; component < 3; component++) {
        clamp_rows(s, r, k, component);
        for (size_t j = rows.from; j < rows.end; j++)
            clamp_row(s, component, force_row(s, r, k, component, j + s->low[1]));
        add_edges(pass, r, k, component);
        for (size_t j = rows.from; j < rows.end; j++)
            NAME(taken_sweep_kernels)
        ()->scale(s->n[0], (const REAL *)s->root + k * s->plane + j * s->n[0],
                  force_row(s, r, k, component, j + s->low[1]) + s->low[0], r->scaled + j * s->stride);
        add_loads(pass, r, k, component);
        add_moments(pass, r, false, component, k, &rows);
        if (!later) add_moments(pass, r, true, component, k, &rows);
        if (later)
            for (size_t j = rows.from; j < rows.end; j++)
                memcpy(ready_row(s, component, k, j), r->scaled + j * s->stride, s->n[0] * sizeof(REAL));
        else
            pass_along(s, r, component, k, &rows, filled);
    }
    forget_plane(pass, r, k);
}

/* The rest of plane k, which has waited. */
static void go_on_with_plane(const struct pass *pass, const struct rings *r, size_t k)
{
    const struct sweep *s = pass->s;
    const struct rows *rows = &s->waiting[k];
    for (size_t component = 0; component < 3 && rows->from < rows->end; component++) {
        for (size_t j = rows->from; j < rows->end; j++)
            memcpy(r->scaled + j * s->stride, ready_row(s, component, k, j), s->n[0] * sizeof(REAL));
        add_moments(pass, r, true, component, k, rows);
        pass_along(s, r, component, k, rows, &s->filled[k]);
    }
}

/* N over depth and the update of planes first .. first + SWEEP_PLANES - 1, if they are the rank's own. */
static void finish_planes(const struct pass *pass, const struct rings *r, size_t first)
{
    struct sweep *s = pass->s;
    if (first < pass->c->part.along[DEPTH].own || first >= pass->c->part.along[DEPTH].end) return;
    const size_t planes = s->n[2] - first < SWEEP_PLANES ? s->n[2] - first : SWEEP_PLANES;
    struct rows rows = {0, 0};
    for (size_t k = less(first, SWEEP_REACH); k < first + planes + SWEEP_REACH && k < s->n[2]; k++)
        join(&rows, s->filled[k].from, s->filled[k].end);
    for (size_t component = 0; component < 3; component++)
        for (size_t j = rows.from; j < rows.end; j++) {
            const REAL *in[SWEEP_TAPS + SWEEP_PLANES - 1], *root[SWEEP_PLANES];
            REAL *out[SWEEP_PLANES];
            for (size_t t = 0; t < SWEEP_TAPS + SWEEP_PLANES - 1; t++) {
                const size_t k = first + t - SWEEP_REACH; /* wraps round below 0 */
                const bool there = k < s->n[2] && j >= s->filled[k].from && j < s->filled[k].end;
                in[t] = there ? ready_row(s, component, k, j) : r->zero;
            }
            for (size_t p = 0; p < planes; p++) {
                const size_t at = (first + p) * s->plane + j * s->n[0];
                root[p] = (const REAL *)s->root + at;
                out[p] = pass->out + component * s->volume + at;
            }
            NAME(taken_sweep_kernels)
            ()->finish(s->n[0], planes, (const REAL *)s->z[component] + first * SWEEP_TAPS, in, s->stride,
                       pass->factor, root, out);
        }
    for (size_t k = first; pass->moving && k < first + planes; k++)
        join(&s->reached[k], rows.from, rows.end);
}
