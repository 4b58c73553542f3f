/* Strata by one-way motions (doc/theory/seismograms.md, Eqs 1-13), a form of the reflectivity recursion of Kennett
 * (1983) in which motions, not potentials, are the unknowns.
 *
 * In (k, s) space u_n = i U, u_z = W, and traction on the ground below a level is tau_n = i Q, tau_z = Z.
 * Waves that go down from a level keep tau = S u there and are u(z + h) = N u(z) farther down; those that go
 * up are mirror images, tau = -S' u, u(z - h) = N' u(z), with ' for M . M, M = diag(1, -1). S and N hold P
 * and S together, so that nothing degenerates where P and S motions become parallel (k >> |s|/c), and they
 * hold only exponentials that decay. With p^2 = k^2 + w_p, q^2 = k^2 + w_s, e_p = exp(-p h), e_q = exp(-q h),
 * E = diag(e_p, e_q), D = [k, q; -p, -k] the motions of both waves, mu F = mu [2 k p, kap; -kap, -2 k q] their
 * tractions and kap = 2 k^2 + w_s, S = mu F D^-1 and N = D E D^-1 are, what is small divided out,
 *
 *   d = p q - k^2 = (k^2 (w_p + w_s) + w_p w_s) / (p q + k^2) where Re pq > 0,                                    (5)
 *   S = mu/d [p w_s, k (w_s - 2 d); k (w_s - 2 d), q w_s],                                                        (6)
 *   N = e_p + [p q, k q; -k p, -k^2] (e_q - e_p)/d,   q - p = (w_s - w_p)/(p + q).                                (7)
 *
 * Impedances of the ground below a level (B) and above it (T, tau = -T u) follow from reflections:
 *
 *   R = (B + S')^-1 (S - B),   H = N' R N,   B_above = (S - S' H)(1 + H)^-1,                                      (9)
 *   u_bottom = (1 + R) N (1 + H)^-1 u_top,                                                                      (10)
 *
 * and mirrored for T. A source with jumps (du, dtau):
 *
 *   u_above = (B + T)^-1 (dtau - B du).                                                                         (13) */
#include "exact/strata.h"

/* What waves of one wavenumber are in one material. */
struct wave {
    struct pair p, q, d;
    struct matrix2 s; /* impedance */
    struct pair s_across;
};

static void wave_set(const struct rock_at *rock, double k, struct wave *wave)
{
    const double k2 = k * k;
    const struct pair kk = {k2, 0}, w = rock->w_s;
    const struct pair p = root(plus(kk, rock->w_p)), q = root(plus(kk, w)), pq = times(p, q);
    struct pair d = minus(pq, kk);
    if (pq.re > 0) d = over(plus(scaled(k2, plus(rock->w_p, w)), times(rock->w_p, w)), plus(pq, kk));
    const struct pair factor = over(rock->mu, d), fw = times(factor, w);
    const struct pair off = scaled(k, times(factor, minus(w, scaled(2, d))));
    *wave = (struct wave){p, q, d, {times(fw, p), off, off, times(fw, q)}, times(rock->mu, q)};
}

/* N over a thickness h; *across: e_q. */
static struct matrix2 carried(const struct rock_at *rock, const struct wave *wave, double k, double h,
                              struct pair *across)
{
    const struct pair e_p = decay(wave->p, h);
    const struct pair slower = over(minus(rock->w_s, rock->w_p), plus(wave->p, wave->q)); /* q - p */
    const struct pair x = scaled(-h, slower);
    struct pair difference; /* e_q - e_p */
    if (x.re * x.re + x.im * x.im < 1) {
        difference = times(e_p, exp_minus_one(x));
        *across = plus(e_p, difference);
    } else {
        *across = decay(wave->q, h);
        difference = minus(*across, e_p);
    }
    const struct pair r = over(difference, wave->d);
    const struct pair kp = scaled(-k, times(wave->p, r)), kq = scaled(k, times(wave->q, r));
    return (struct matrix2){plus(e_p, times(times(wave->p, wave->q), r)), kq, kp,
                            minus(e_p, scaled(k * k, r))};
}

/* A piece between impedance `end` of what lies beyond its far level and its near level, waves starting at the
 * near one: impedance there, and what carries motions from near to far (Eqs 9, 10). */
static void reflect(struct matrix2 s, struct matrix2 n, struct matrix2 end, struct matrix2 *impedance,
                    struct matrix2 *carry)
{
    const struct matrix2 back = matrix2_mirrored(s), step = matrix2_less(s, end);
    if (step.a.re == 0 && step.b.re == 0 && step.d.re == 0 && step.a.im == 0 && step.b.im == 0 &&
        step.d.im == 0) { /* nothing comes back */
        *impedance = s;
        *carry = n;
        return;
    }
    const struct matrix2 r = matrix2_product(matrix2_inverse(matrix2_sum(end, back)), step);
    const struct matrix2 h = matrix2_product(matrix2_product(matrix2_mirrored(n), r), n);
    const struct matrix2 start = matrix2_inverse(matrix2_one_plus(h));
    *impedance = matrix2_product(matrix2_less(s, matrix2_product(back, h)), start);
    *carry = matrix2_product(matrix2_product(matrix2_one_plus(r), n), start);
}

static void reflect_across(struct pair s, struct pair e, struct pair end, struct pair *impedance,
                           struct pair *carry)
{
    const struct pair one = {1, 0}, r = over(minus(s, end), plus(s, end)), h = times(times(e, e), r);
    *impedance = over(times(s, minus(one, h)), plus(one, h));
    *carry = over(times(e, plus(one, r)), plus(one, h));
}

/* Impedances and carriers of all pieces, from the half-space up, then from the surface down. */
static void sweep(const struct strata *strata, const struct rock_at *rock, double k,
                  struct strata_piece *piece)
{
    const size_t last = strata->levels - 1;
    struct wave wave;
    wave_set(&rock[strata->rock[last]], k, &wave);
    piece[last].below = wave.s;
    piece[last].across_below = wave.s_across;
    for (size_t i = last; i-- > 0;) {
        const struct rock_at *here = &rock[strata->rock[i]];
        if (strata->rock[i] != strata->rock[i + 1]) wave_set(here, k, &wave);
        struct pair e;
        const struct matrix2 n = carried(here, &wave, k, strata->depth[i + 1] - strata->depth[i], &e);
        reflect(wave.s, n, piece[i + 1].below, &piece[i].below, &piece[i].down);
        reflect_across(wave.s_across, e, piece[i + 1].across_below, &piece[i].across_below,
                       &piece[i].across_down);
        piece[i].up = n; /* until the sweep down */
        piece[i].across_up = e;
    }
    piece[0].above = (struct matrix2){{0, 0}, {0, 0}, {0, 0}, {0, 0}};
    piece[0].across_above = (struct pair){0, 0};
    for (size_t i = 0; i < last; i++) {
        if (i == 0 || strata->rock[i] != strata->rock[i - 1]) wave_set(&rock[strata->rock[i]], k, &wave);
        /* the piece upside down: what goes up from its lower level */
        struct matrix2 impedance, carry;
        reflect(wave.s, piece[i].up, matrix2_mirrored(piece[i].above), &impedance, &carry);
        piece[i + 1].above = matrix2_mirrored(impedance);
        piece[i].up = matrix2_mirrored(carry);
        const struct pair e = piece[i].across_up;
        reflect_across(wave.s_across, e, piece[i].across_above, &piece[i + 1].across_above,
                       &piece[i].across_up);
    }
}

/* Motions on both sides of a source (Eq 13): in plane for four columns, across for two. */
struct outgoing {
    struct vector2 above[4], below[4];
    struct pair across_above[2], across_below[2];
};

static void start(const struct strata_piece *piece, const struct rock_at *rock, double k, bool moments,
                  struct outgoing *out)
{
    const struct pair one = {1, 0}, zero = {0, 0};
    const struct matrix2 yield = matrix2_inverse(matrix2_sum(piece->below, piece->above));
    const struct pair across = over(one, plus(piece->across_below, piece->across_above));
    out->above[COLUMN_VERTICAL] = out->below[COLUMN_VERTICAL] = (struct vector2){yield.b, yield.d};
    out->above[COLUMN_RADIAL] = out->below[COLUMN_RADIAL] = (struct vector2){yield.a, yield.c};
    out->across_above[0] = out->across_below[0] = across;
    if (!moments) return;
    const struct pair stretch = over(one, rock->axial), slide = over(one, rock->mu);
    const struct pair lambda = minus(rock->axial, scaled(2, rock->mu));
    const struct vector2 jump[2] = {{zero, stretch}, {slide, zero}};
    const struct pair push = scaled(k, times(lambda, stretch));
    for (int i = 0; i < 2; i++) {
        const int column = i == 0 ? COLUMN_AXIAL : COLUMN_DIP;
        const struct vector2 held = matrix2_times(piece->below, jump[i]);
        const struct vector2 force = {i == 0 ? minus(push, held.x) : scaled(-1, held.x), scaled(-1, held.y)};
        out->above[column] = matrix2_times(yield, force);
        out->below[column].x = plus(out->above[column].x, jump[i].x);
        out->below[column].y = plus(out->above[column].y, jump[i].y);
    }
    out->across_above[1] = scaled(-1, times(across, times(piece->across_below, slide)));
    out->across_below[1] = plus(out->across_above[1], slide);
}

/* Responses of one P-SV column from motion u and traction t at a receiver in `rock`. */
static void note(const struct rock_at *rock, double k, bool stress, struct vector2 u, struct vector2 t,
                 struct pair *response)
{
    response[RESPONSE_U] = u.x;
    response[RESPONSE_W] = u.y;
    if (!stress) return;
    const struct pair lambda = minus(rock->axial, scaled(2, rock->mu)), part = over(lambda, rock->axial);
    const struct pair z = times(part, t.y), ku = scaled(k, times(rock->mu, u.x));
    /* sigma_nn = -4 mu (lambda + mu)/(lambda + 2 mu) k U - z, sigma_tt = -2 mu lambda/(lambda + 2 mu) k U - z
     */
    response[RESPONSE_Q] = t.x;
    response[RESPONSE_Z] = t.y;
    response[RESPONSE_MEAN] = scaled(-1, plus(plus(ku, scaled(2, times(part, ku))), z));
    response[RESPONSE_DIFFERENCE] = scaled(-1, ku);
}

static void note_across(const struct rock_at *rock, double k, bool stress, struct pair v, struct pair t,
                        struct pair *response)
{
    response[RESPONSE_V] = v;
    if (!stress) return;
    response[RESPONSE_Y] = t;
    response[RESPONSE_X] = scaled(k, times(rock->mu, v));
}

static struct vector2 middle(struct vector2 a, struct vector2 b)
{
    return (struct vector2){scaled(.5, plus(a.x, b.x)), scaled(.5, plus(a.y, b.y))};
}

/* All columns at one receiver; side: -1 above the source, 0 level with it, 1 below. */
static void note_all(const struct strata *strata, const struct rock_at *rock, double k, bool moments,
                     size_t level, int side, const struct strata_piece *piece, const struct outgoing *out,
                     struct pair *response)
{
    const struct rock_at *here = &rock[strata->rock[level]];
    for (int c = 0; c < 4; c++) {
        if (!moments && c != COLUMN_VERTICAL && c != COLUMN_RADIAL) continue;
        struct vector2 below = matrix2_times(piece->below, out->below[c]);
        struct vector2 above = matrix2_times(piece->above, out->above[c]);
        above = (struct vector2){scaled(-1, above.x), scaled(-1, above.y)};
        const struct vector2 u = side < 0   ? out->above[c]
                                 : side > 0 ? out->below[c]
                                            : middle(out->above[c], out->below[c]);
        const struct vector2 t = side < 0 ? above : side > 0 ? below : middle(above, below);
        note(here, k, strata->stress, u, t, response + c * RESPONSES);
    }
    for (int c = 0; c < (moments ? 2 : 1); c++) {
        const struct pair below = times(piece->across_below, out->across_below[c]);
        const struct pair above = scaled(-1, times(piece->across_above, out->across_above[c]));
        const struct pair u = side < 0   ? out->across_above[c]
                              : side > 0 ? out->across_below[c]
                                         : scaled(.5, plus(out->across_above[c], out->across_below[c]));
        const struct pair t = side < 0 ? above : side > 0 ? below : scaled(.5, plus(above, below));
        note_across(here, k, strata->stress, u, t, response + (COLUMN_ACROSS + c) * RESPONSES);
    }
}

static void carry_on(struct matrix2 carry, struct pair across, bool moments, struct vector2 *u,
                     struct pair *v)
{
    for (int c = 0; c < 4; c++)
        if (moments || c == COLUMN_VERTICAL || c == COLUMN_RADIAL) u[c] = matrix2_times(carry, u[c]);
    for (int c = 0; c < (moments ? 2 : 1); c++)
        v[c] = times(across, v[c]);
}

void strata_responses(const struct strata *strata, const struct rock_at *rock, double k,
                      struct strata_piece *piece, struct pair *response)
{
    sweep(strata, rock, k, piece);
    for (size_t s = 0; s < strata->sources; s++) {
        const size_t level = strata->source[s];
        const bool moments = strata->moments[s];
        struct pair *own = response + s * strata->receivers * COLUMNS * RESPONSES;
        struct outgoing out;
        start(&piece[level], &rock[strata->rock[level]], k, moments, &out);
        size_t r = 0; /* receivers ascend */
        while (r < strata->receivers && strata->receiver[r] < level)
            r++;
        size_t at = level;
        const struct outgoing source = out;
        for (size_t back = r; back-- > 0;) {
            for (; at > strata->receiver[back]; at--)
                carry_on(piece[at - 1].up, piece[at - 1].across_up, moments, out.above, out.across_above);
            note_all(strata, rock, k, moments, at, -1, &piece[at], &out, own + back * COLUMNS * RESPONSES);
        }
        out = source;
        for (at = level; r < strata->receivers; r++) {
            for (; at < strata->receiver[r]; at++)
                carry_on(piece[at].down, piece[at].across_down, moments, out.below, out.across_below);
            note_all(strata, rock, k, moments, at, at == level ? 0 : 1, &piece[at], &out,
                     own + r * COLUMNS * RESPONSES);
        }
    }
}
