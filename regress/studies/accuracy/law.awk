# Least squares of the logarithm of Eq 5 of doc/verification/accuracy.md over runs, receivers and pulses; see law.sh and law-layered.sh. Variables: scale, of the
# pulses' times; felt, wavelengths down to which a surface wave feels the ground; together, the near part too is less between the axes; start.
function speed(s, w,    mean, round, depth) { # of the surface wave of a frequency: src/accuracy/surface.c
    mean = 1 / sc[s]
    for (round = 1; round <= 6 && felt; round++) {
        depth = felt * 2 * pi / (w * mean)
        mean = 1 / below[s] + (1 / sc[s] - 1 / below[s]) * (1 - exp(-top[s] / depth))
    }
    return 1 / mean
}
function pulse(k, w,    x, y, v) { # |spectrum|^2
    w *= scale
    if (k <= 7) return exp(-(w * width[k])^2)
    if (k <= 10) { # triangles: duration 2 smooth, 2 kinked, 1 smooth
        x = w * (k == 10 ? .25 : .5); v = (sin(x) / x)^4
        if (k != 9) { y = w * (k == 10 ? .0625 : .125); v *= (sin(y) / y)^8 }
        return v
    }
    x = w / (2 * pi * (k == 11 ? .5 : .8)) # Ricker
    return (x * x * exp(-x * x))^2
}
function predicted(i,    near, way, n, j, e, k, s) {
    near = exp(p[5]) * h[i]^p[6] / (r[i] > 1 ? r[i]^p[7] : 1) * (together ? 1 - diagonal[i] * (1 - p[8]) : 1)
    way = exp(p[3]) * r[i] / h[i] * (1 - diagonal[i] * (1 - p[8]))
    s = 0
    for (j = 1; j <= count[i]; j++) {
        k = kappa[i, j]
        e = near^2 + (exp(p[1]) * k^p[2])^2 + (way * k^p[4])^2
        s += weight[i, j] * (e < 1.5 ? e : 1.5)
    }
    return sqrt(s)
}
function cost(    i, s, x) {
    s = 0
    for (i = 1; i <= cases; i++) { x = log(predicted(i) / error[i]); s += x * x }
    return sqrt(s / cases)
}
BEGIN { pi = atan2(0, -1); if (!scale) scale = 1; if (!start) start = "-4.8 5.5 -7.5 3.5 3.1 5.46 2 .5"; split(".15 .2 .25 .3 .4 .5 .7", width, " ") }
{
    key = $1 " " $2
    if (key != last) { series++; last = key; name[series] = key; rows[series] = 0 }
    n = ++rows[series]
    sh[series] = $3; sc[series] = $4; sr[series] = $5; sd[series] = $6; top[series] = $10; below[series] = $11
    sw[series, n] = $7; d2[series, n] = $8; v2[series, n] = $9
}
END {
    for (s = 1; s <= series; s++) for (k = 1; k <= 12; k++) {
        num = den = 0
        for (n = 1; n <= rows[s]; n++) { g = pulse(k, sw[s, n]); num += d2[s, n] * g; den += v2[s, n] * g }
        e = sqrt(num / den)
        if (e < 4e-4 || e > .1) continue
        i = ++cases
        error[i] = e; h[i] = sh[s]; r[i] = sr[s]; diagonal[i] = sd[s]; label[i] = name[s] " pulse " k
        for (n = 1; n <= rows[s]; n++) {
            v = v2[s, n] * pulse(k, sw[s, n]) / den
            if (v < 1e-9) continue
            count[i]++
            kappa[i, count[i]] = sw[s, n] * sh[s] / speed(s, sw[s, n]); weight[i, count[i]] = v
        }
    }
    split(start, p, " ")
    split(".3 .5 .3 .5 .3 .3 .5 .2", step, " ")
    best = cost()
    for (round = 1; round <= 30; round++) for (q = 1; q <= 8; q++) {
        found = 0
        for (sign = 1; sign >= -1 && !found; sign -= 2) {
            kept = p[q]; p[q] = kept + sign * step[q]
            c = q == 8 && p[8] < .05 ? best + 1 : cost()
            if (c < best) { best = c; found = 1; step[q] *= 1.3 } else p[q] = kept
        }
        if (!found) step[q] *= .5
    }
    printf "cases %d, r.m.s. factor %.2f\n", cases, exp(best)
    printf "near %.3g h^%.2f r^-%.2f; source %.3g kappa^%.2f; way %.3g kappa^%.2f, diagonal %.2f\n", exp(p[5]), p[6], p[7], exp(p[1]), p[2], exp(p[3]), p[4], p[8]
    for (i = 1; i <= cases; i++) { x = predicted(i) / error[i]; if (x > most) { most = x; high = label[i] } if (!least || x < least) { least = x; low = label[i] } }
    printf "predicted over measured from %.2f (%s) to %.2f (%s)\n", least, low, most, high
}
