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

INLINED void level_stresses(const bool knots, const bool made, const bool more,
                            const struct NAME(sweep_row) * row, const REAL *in, REAL *out)
{
    const size_t stride = row->stride, width = row->width;
    const REAL x = row->factor[0], y = row->factor[1], z = row->factor[2], *lambda = row->lambda,
               *shear = row->mu;
#define AT(component, slot) (in + (3 * (component) + (slot)) * stride + i)
    for (size_t i = 0; i < width; i += LANES) {
        const lanes exx = strain_x(knots, made, x, AT(0, 0)), eyy = strain_of(knots, made, y, AT(1, 1)),
                    ezz = strain_of(knots, made, z, AT(2, 2)), mu = at(shear + i), twice = mu + mu,
                    pressure = at(lambda + i) * (exx + eyy + ezz);
        put_or_add(more, out + XX * stride + i, pressure + twice * exx);
        put_or_add(more, out + YY * stride + i, pressure + twice * eyy);
        put_or_add(more, out + ZZ * stride + i, pressure + twice * ezz);
        put_or_add(more, out + YZ * stride + i,
                   mu * (strain_of(knots, made, z, AT(1, 2)) + strain_of(knots, made, y, AT(2, 1))));
        put_or_add(more, out + ZX * stride + i,
                   mu * (strain_of(knots, made, z, AT(0, 2)) + strain_x(knots, made, x, AT(2, 0))));
        put_or_add(more, out + XY * stride + i,
                   mu * (strain_of(knots, made, y, AT(0, 1)) + strain_x(knots, made, x, AT(1, 0))));
    }
}

/* Below a surface that is not level: slopes along the axes (G17), and what pulls along the lattice's depth. */
INLINED void tilted_stresses(const bool knots, const bool made, const bool more,
                             const struct NAME(sweep_row) * row, const REAL *in, REAL *out)
{
    const struct NAME(sweep_hill) hill = *row->hill;
    const size_t stride = row->stride, width = row->width;
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]}, *lambda = row->lambda,
               *shear = row->mu;
    for (size_t i = 0; i < width; i += LANES) {
        const lanes up = 1 / (1 + hill.fall * at(hill.drop + i)),
                    one = hill.share * at(hill.slope[0] + i) * up,
                    two = hill.share * at(hill.slope[1] + i) * up;
        lanes x[3], y[3], z[3];
        UNROLLED for (size_t c = 0; c < 3; c++)
        {
            const lanes down = strain_of(knots, made, factor[2], AT(c, 2));
            x[c] = strain_x(knots, made, factor[0], AT(c, 0)) - one * down;
            y[c] = strain_of(knots, made, factor[1], AT(c, 1)) - two * down;
            z[c] = up * down;
        }
        const lanes mu = at(shear + i), twice = mu + mu, pressure = at(lambda + i) * (x[0] + y[1] + z[2]);
        const lanes xx = pressure + twice * x[0], yy = pressure + twice * y[1], zz = pressure + twice * z[2];
        const lanes yz = mu * (z[1] + y[2]), zx = mu * (z[0] + x[2]), xy = mu * (y[0] + x[1]);
        put_or_add(more, out + XX * stride + i, xx);
        put_or_add(more, out + YY * stride + i, yy);
        put_or_add(more, out + YZ * stride + i, yz);
        put_or_add(more, out + ZX * stride + i, zx);
        put_or_add(more, out + XY * stride + i, xy);
        put_or_add(more, out + DEPTH_X * stride + i, up * zx - one * xx - two * xy);
        put_or_add(more, out + DEPTH_Y * stride + i, up * yz - one * xy - two * yy);
        put_or_add(more, out + DEPTH_Z * stride + i, up * zz - one * zx - two * yz);
    }
#undef AT
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

/* Back along x, then along y: what stresses x, y, z of a component pull at; `apart`: those of y go into rows of their
 * own. */
INLINED void pulls_back(const bool x_knots, const bool y_knots, const bool apart,
                        const struct NAME(sweep_row) * row, int component, const REAL *restrict x,
                        const REAL *restrict y, const REAL *restrict z)
{
    const size_t stride = row->stride, first = (size_t)(component * PULL_FIELDS) * stride;
    const size_t at_pull = first + (size_t)row->field * stride, across = first + (size_t)row->across * stride;
    REAL *restrict p0 = row->out[0] + at_pull, *restrict p1 = row->out[1] + at_pull,
                   *restrict p2 = row->out[2] + at_pull;
    REAL *restrict s0 = p0 + stride, *restrict s1 = p1 + stride, *restrict s2 = p2 + stride;
    REAL *restrict a0 = row->out[0] + across, *restrict a1 = row->out[1] + across,
                   *restrict a2 = row->out[2] + across;
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]};
    const size_t width = row->width;
    for (size_t i = 0; i < width; i += LANES) {
        const lanes one = factor[0] * slope_pull(x_knots, x + i),
                    two = factor[1] * value_pull(x_knots, y + i),
                    three = factor[2] * value_pull(x_knots, z + i);
        lanes both = one, less = one;
        if (!apart) {
            both += two;
            less -= two;
        }
        put(p0 + i, at(p0 + i) + less);
        put(s0 + i, at(s0 + i) + three);
        if (y_knots) {
            put(p1 + i, at(p1 + i) + both);
            put(s1 + i, at(s1 + i) + three);
        } else {
            put(p1 + i, at(p1 + i) + 6 * one);
            put(s1 + i, at(s1 + i) + 6 * three);
            put(p2 + i, both);
            put(s2 + i, three);
        }
        if (!apart) continue;
        put(a0 + i, at(a0 + i) - two);
        if (y_knots)
            put(a1 + i, at(a1 + i) + two);
        else
            put(a2 + i, two);
    }
}

INLINED void slopes_of(const bool x_knots, const bool y_knots, const struct NAME(sweep_row) * row)
{
    const size_t stride = row->stride, width = row->width;
    for (int c = 0; c < 3; c++) {
        REAL *x = row->scratch + (size_t)(3 * c) * stride, *y = x + stride, *z = y + stride;
        along_y(y_knots, row, c, x, y, z);
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
        along_y(y_knots, row, c, rows, rows + stride, rows + 2 * stride);
    }
    if (row->hill != NULL)
        tilted_stresses(x_knots, made, more, row, in, out);
    else
        level_stresses(x_knots, made, more, row, in, out);
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
    BY_KNOTS(points_of, false, row)
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
