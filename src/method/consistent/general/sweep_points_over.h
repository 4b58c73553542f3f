/* The loops of sweep.h over rows of points, from slopes to what their stresses pull at, for numbers of type REAL;
 * included by sweep_over.h. */
enum { XX, YY, ZZ, YZ, ZX, XY, DEPTH_X, DEPTH_Y, DEPTH_Z };

/* A slope along x, or along another slot, where `row` is its row of the scratch; `made`: it is there already. */
INLINED lanes strain_x(const bool knots, const bool made, REAL factor, const REAL *row)
{
    if (made) return at(row);
    return factor * slope_of(knots, row);
}

INLINED lanes strain_of(const bool knots, const bool made, REAL factor, const REAL *row)
{
    if (made) return at(row);
    return factor * value_of(knots, row);
}

/* Stresses of a group of points from their slopes, [component][slot] along the lattice; below a surface that is not
 * level slopes along the axes (G17), and what pulls along the lattice's depth in the place of zz. */
INLINED void stress_of(const bool hilly, const struct NAME(sweep_row) * row, size_t i, lanes slope[3][3],
                       lanes stress[STRESS_ROOM])
{
    lanes up = {0}, one = up, two = up;
    if (hilly) {
        const struct NAME(sweep_hill) *hill = row->hill;
        up = 1 / (1 + hill->fall * at(hill->drop + i));
        one = hill->share * at(hill->slope[0] + i) * up;
        two = hill->share * at(hill->slope[1] + i) * up;
        UNROLLED for (size_t c = 0; c < 3; c++)
        {
            const lanes down = slope[c][2];
            slope[c][0] -= one * down;
            slope[c][1] -= two * down;
            slope[c][2] = up * down;
        }
    }
    const lanes mu = at(row->mu + i), twice = mu + mu,
                pressure = at(row->lambda + i) * (slope[0][0] + slope[1][1] + slope[2][2]);
    stress[XX] = pressure + twice * slope[0][0];
    stress[YY] = pressure + twice * slope[1][1];
    stress[ZZ] = pressure + twice * slope[2][2];
    stress[YZ] = mu * (slope[1][2] + slope[2][1]);
    stress[ZX] = mu * (slope[0][2] + slope[2][0]);
    stress[XY] = mu * (slope[0][1] + slope[1][0]);
    if (!hilly) return;
    stress[DEPTH_X] = up * stress[ZX] - one * stress[XX] - two * stress[XY];
    stress[DEPTH_Y] = up * stress[YZ] - one * stress[XY] - two * stress[YY];
    stress[DEPTH_Z] = up * stress[ZZ] - one * stress[ZX] - two * stress[YZ];
}

/* Rows of them from rows of what is along y. */
INLINED void rows_of_stresses(const bool hilly, const bool knots, const bool made, const bool more,
                              const struct NAME(sweep_row) * row, const REAL *in, REAL *out)
{
    const size_t stride = row->stride, width = row->width;
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]};
    for (size_t i = 0; i < width; i += LANES) {
        lanes slope[3][3], stress[STRESS_ROOM];
        UNROLLED for (size_t c = 0; c < 3; c++)
        {
            const REAL *from = in + 3 * c * stride + i;
            slope[c][0] = strain_x(knots, made, factor[0], from);
            slope[c][1] = strain_of(knots, made, factor[1], from + stride);
            slope[c][2] = strain_of(knots, made, factor[2], from + 2 * stride);
        }
        stress_of(hilly, row, i, slope, stress);
        UNROLLED for (size_t p = 0; p < STRESS_ROOM; p++) if (p < STRESSES || hilly)
            put_or_add(more, out + p * stride + i, stress[p]);
    }
}

#define VALUE_AT(row) (knots ? (row)[i] + (row)[i + 1] : 6 * (row)[i + 1] + ((row)[i] + (row)[i + 2]))
#define SLOPE_AT(row) (knots ? (row)[i + 1] - (row)[i] : (row)[i + 2] - (row)[i])

/* The same at points that are not isotropic. */
INLINED void other_stresses(const bool knots, const bool made, const bool more,
                            const struct NAME(sweep_row) * row, const REAL *in, REAL *out)
{
    const struct NAME(sweep_hill) *hill = row->hill;
    const size_t stride = row->stride;
    for (size_t r = 0; r < row->runs; r++)
        for (size_t m = 0; m < row->run[r].count; m++) {
            const size_t i = row->run[r].from + m;
            const double *law = row->stiffness + row->run[r].at + m;
            const REAL up = hill == NULL ? 1 : 1 / (1 + hill->fall * hill->drop[i]),
                       one = hill == NULL ? 0 : hill->share * hill->slope[0][i] * up,
                       two = hill == NULL ? 0 : hill->share * hill->slope[1][i] * up;
            REAL x[3], y[3], z[3], stress[STRESSES] = {0};
            for (size_t c = 0; c < 3; c++) {
                const REAL *along = in + 3 * c * stride, *across = along + stride, *deep = across + stride;
                const REAL down = made ? deep[i] : row->factor[2] * VALUE_AT(deep);
                x[c] = (made ? along[i] : row->factor[0] * SLOPE_AT(along)) - one * down;
                y[c] = (made ? across[i] : row->factor[1] * VALUE_AT(across)) - two * down;
                z[c] = up * down;
            }
            const REAL strain[STRESSES] = {x[0], y[1], z[2], y[2] + z[1], z[0] + x[2], x[1] + y[0]};
            int entry = 0;
            for (int p = 0; p < STRESSES; p++)
                for (int q = p; q < STRESSES; q++, entry++) {
                    const REAL modulus = (REAL)law[(size_t)entry * row->run[r].count];
                    stress[p] += modulus * strain[q];
                    if (p != q) stress[q] += modulus * strain[p];
                }
            const REAL down[3] = {up * stress[ZX] - one * stress[XX] - two * stress[XY],
                                  up * stress[YZ] - one * stress[XY] - two * stress[YY],
                                  up * stress[ZZ] - one * stress[ZX] - two * stress[YZ]};
            for (size_t p = 0; p < STRESS_ROOM; p++) {
                REAL *to = out + p * stride + i;
                const REAL value = p < STRESSES ? stress[p] : down[p - STRESSES];
                *to = more ? *to + value : value;
            }
        }
}

/* Rows of pulls of a component, of values and of slopes, and where those along y are kept apart. */
struct pull_rows {
    REAL *value[SPAN], *slope[SPAN], *across[SPAN];
};

INLINED struct pull_rows pull_rows_of(const struct NAME(sweep_row) * row, int component)
{
    const size_t first = (size_t)(component * PULL_FIELDS) * row->stride,
                 field = first + (size_t)row->field * row->stride,
                 across = first + (size_t)row->across * row->stride;
    struct pull_rows rows;
    UNROLLED for (size_t d = 0; d < SPAN; d++)
    {
        rows.value[d] = row->out[d] + field;
        rows.slope[d] = rows.value[d] + row->stride;
        rows.across[d] = row->out[d] + across;
    }
    return rows;
}

/* Back along y from number i on: what stresses x, y, z of a component pull at, back along x; `apart`: those of y go
 * into rows of their own. */
INLINED void pull_along_y(const bool knots, const bool apart, const struct pull_rows *to, size_t i, lanes one,
                          lanes two, lanes three)
{
    lanes both = one, less = one;
    if (!apart) {
        both += two;
        less -= two;
    }
    put(to->value[0] + i, at(to->value[0] + i) + less);
    put(to->slope[0] + i, at(to->slope[0] + i) + three);
    if (knots) {
        put(to->value[1] + i, at(to->value[1] + i) + both);
        put(to->slope[1] + i, at(to->slope[1] + i) + three);
    } else {
        put(to->value[1] + i, at(to->value[1] + i) + 6 * one);
        put(to->slope[1] + i, at(to->slope[1] + i) + 6 * three);
        put(to->value[2] + i, both);
        put(to->slope[2] + i, three);
    }
    if (!apart) return;
    put(to->across[0] + i, at(to->across[0] + i) - two);
    if (knots)
        put(to->across[1] + i, at(to->across[1] + i) + two);
    else
        put(to->across[2] + i, two);
}

INLINED void pulls_back(const bool x_knots, const bool y_knots, const bool apart,
                        const struct NAME(sweep_row) * row, int component, const REAL *restrict x,
                        const REAL *restrict y, const REAL *restrict z)
{
    const struct pull_rows to = pull_rows_of(row, component);
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]};
    const size_t width = row->width;
    for (size_t i = 0; i < width; i += LANES)
        pull_along_y(y_knots, apart, &to, i, factor[0] * slope_pull(x_knots, x + i),
                     factor[1] * value_pull(x_knots, y + i), factor[2] * value_pull(x_knots, z + i));
}

INLINED void slopes_of(const bool x_knots, const bool y_knots, const struct NAME(sweep_row) * row)
{
    const size_t stride = row->stride, width = row->width;
    for (int c = 0; c < 3; c++) {
        REAL *x = row->scratch + (size_t)(3 * c) * stride, *y = x + stride, *z = y + stride;
        along_y(y_knots, row, c, x);
        for (size_t i = 0; i < width; i += LANES) {
            put(x + i, row->factor[0] * slope_of(x_knots, x + i));
            put(y + i, row->factor[1] * value_of(x_knots, y + i));
            put(z + i, row->factor[2] * value_of(x_knots, z + i));
        }
    }
}

/* Columns reach 2 beyond the points that read them. */
INLINED void slope_along(const bool x_knots, const bool y_knots, const int slot,
                         const struct NAME(sweep_row) * row, size_t from, size_t end)
{
    const size_t first = from / LANES * LANES, after = end + 2 < row->width ? end + 2 : row->width;
    for (int c = 0; c < 3; c++) {
        REAL *out = row->scratch + (size_t)(3 * c + slot) * row->stride;
        one_along_y(y_knots, slot == 1, row, c, row->field + (slot == 2 ? 1 : 0), first, after, out);
        for (size_t i = first; i < end; i += LANES)
            put(out + i,
                row->factor[slot] * (slot == 0 ? slope_of(x_knots, out + i) : value_of(x_knots, out + i)));
    }
}

/* Stresses at the points; made: the slopes are there; more: beside those that are there. */
INLINED void stresses_at(const bool x_knots, const bool y_knots, const bool made, const bool more,
                         const struct NAME(sweep_row) * row)
{
    const size_t stride = row->stride;
    REAL *in = row->scratch, *out = in + 9 * stride;
    for (int c = 0; c < 3 && !made; c++) {
        REAL *rows = in + (size_t)(3 * c) * stride;
        along_y(y_knots, row, c, rows);
    }
    if (row->hill != NULL)
        rows_of_stresses(true, x_knots, made, more, row, in, out);
    else
        rows_of_stresses(false, x_knots, made, more, row, in, out);
    if (row->runs > 0) other_stresses(x_knots, made, more, row, in, out);
}

/* What they pull at; made: kept apart. */
INLINED void pulls_at(const bool x_knots, const bool y_knots, const bool made,
                      const struct NAME(sweep_row) * row)
{
    static const int level[3][3] = {{XX, XY, ZX}, {XY, YY, YZ}, {ZX, YZ, ZZ}};
    const size_t stride = row->stride;
    const REAL *out = row->scratch + 9 * stride;
    for (int c = 0; c < 3; c++) {
        const int along = row->hill != NULL ? DEPTH_X + c : level[c][2];
        pulls_back(x_knots, y_knots, made, row, c, out + (size_t)level[c][0] * stride,
                   out + (size_t)level[c][1] * stride, out + (size_t)along * stride);
    }
}

INLINED void points_of(const bool x_knots, const bool y_knots, const bool made,
                       const struct NAME(sweep_row) * row)
{
    stresses_at(x_knots, y_knots, made, false, row);
    pulls_at(x_knots, y_knots, made, row);
}

/* LANES numbers from number s of the first vector on. */
INLINED lanes shifted(const int s, lanes one, lanes two)
{
#if defined(__GNUC__) && !defined(__clang__) /* it does not see one instruction in the loop */
    lanes_number number = {0};
    UNROLLED for (int lane = 0; lane < LANES; lane++) number[lane] = lane + s;
    return __builtin_shuffle(one, two, number);
#else
    lanes both = {0};
    UNROLLED for (int lane = 0; lane < LANES; lane++) both[lane] =
        lane + s < LANES ? one[lane + s] : two[lane + s - LANES];
    return both;
#endif
}

/* Without their factors, of three numbers along x from those of the group and of the next, and back from those of the
 * group and of that before. */
INLINED lanes value_ahead(const bool knots, lanes own, lanes next)
{
    const lanes one = shifted(1, own, next);
    return knots ? own + one : 6 * one + (own + shifted(2, own, next));
}

INLINED lanes slope_ahead(const bool knots, lanes own, lanes next)
{
    return shifted(knots ? 1 : 2, own, next) - own;
}

INLINED lanes value_behind(const bool knots, lanes before, lanes own)
{
    const lanes one = shifted(LANES - 1, before, own);
    return knots ? one + own : 6 * one + (shifted(LANES - 2, before, own) + own);
}

INLINED lanes slope_behind(const bool knots, lanes before, lanes own)
{
    return shifted(LANES - (knots ? 1 : 2), before, own) - own;
}

/* All at once: nothing goes through rows but values over depth and pulls. Vectors of two numbers wait longer for their
 * registers than for those rows. */
INLINED void points_at_once(const bool x_knots, const bool y_knots, const bool hilly,
                            const struct NAME(sweep_row) * row)
{
    static const int of[3][3] = {{XX, XY, ZX}, {XY, YY, YZ}, {ZX, YZ, ZZ}};
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]};
    const size_t width = row->width;
    struct pull_rows to[3];
    lanes next[3][3], before[STRESS_ROOM] = {{0}};
    UNROLLED for (int c = 0; c < 3; c++)
    {
        to[c] = pull_rows_of(row, c);
        group_along_y(y_knots, row, c, 0, next[c]);
    }
    for (size_t i = 0; i < width; i += LANES) {
        lanes slope[3][3], stress[STRESS_ROOM];
        UNROLLED for (int c = 0; c < 3; c++)
        {
            lanes ahead[3];
            group_along_y(y_knots, row, c, i + LANES, ahead);
            slope[c][0] = factor[0] * slope_ahead(x_knots, next[c][0], ahead[0]);
            slope[c][1] = factor[1] * value_ahead(x_knots, next[c][1], ahead[1]);
            slope[c][2] = factor[2] * value_ahead(x_knots, next[c][2], ahead[2]);
            UNROLLED for (int slot = 0; slot < 3; slot++) next[c][slot] = ahead[slot];
        }
        stress_of(hilly, row, i, slope, stress);
        UNROLLED for (int c = 0; c < 3; c++)
        {
            const int x = of[c][0], y = of[c][1], z = hilly ? DEPTH_X + c : of[c][2];
            pull_along_y(y_knots, false, &to[c], i, factor[0] * slope_behind(x_knots, before[x], stress[x]),
                         factor[1] * value_behind(x_knots, before[y], stress[y]),
                         factor[2] * value_behind(x_knots, before[z], stress[z]));
        }
        UNROLLED for (int p = 0; p < STRESS_ROOM; p++) if (p != ZZ || !hilly) before[p] = stress[p];
    }
}

/* FUNCTION(x_knots, y_knots, more words) of a row. */
#define BY_KNOTS(FUNCTION, ...)                                                                              \
    if (row->x_knots)                                                                                        \
        FUNCTION(true, false, __VA_ARGS__);                                                                  \
    else if (row->y_knots)                                                                                   \
        FUNCTION(false, true, __VA_ARGS__);                                                                  \
    else                                                                                                     \
        FUNCTION(false, false, __VA_ARGS__);

static void points(const struct NAME(sweep_row) * row)
{
    if (row->runs > 0 || VECTOR_BYTES < 32) {
        BY_KNOTS(points_of, false, row)
    } else if (row->hill != NULL) {
        BY_KNOTS(points_at_once, true, row)
    } else {
        BY_KNOTS(points_at_once, false, row)
    }
}

static void slopes(const struct NAME(sweep_row) * row)
{
    BY_KNOTS(slopes_of, row)
}

static void slope(const struct NAME(sweep_row) * row, int slot, size_t from, size_t end)
{
    if (slot == 0) {
        BY_KNOTS(slope_along, 0, row, from, end)
    } else if (slot == 1) {
        BY_KNOTS(slope_along, 1, row, from, end)
    } else {
        BY_KNOTS(slope_along, 2, row, from, end)
    }
}

static void stresses(const struct NAME(sweep_row) * row)
{
    BY_KNOTS(points_of, true, row)
}

static void stresses_of(const struct NAME(sweep_row) * row, bool made, bool more)
{
    if (made && more) {
        BY_KNOTS(stresses_at, true, true, row)
    } else if (made) {
        BY_KNOTS(stresses_at, true, false, row)
    } else if (more) {
        BY_KNOTS(stresses_at, false, true, row)
    } else {
        BY_KNOTS(stresses_at, false, false, row)
    }
}

static void pulls_of(const struct NAME(sweep_row) * row, bool made)
{
    if (made) {
        BY_KNOTS(pulls_at, true, row)
    } else {
        BY_KNOTS(pulls_at, false, row)
    }
}
