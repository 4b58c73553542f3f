# A scene drawn by chance (-v seed=NUMBER): what runs on ranks, in all its kinds, on bodies long over one or two axes, so that
# 5 ranks have work. Prints the deck; what it reads goes into files of its folder (-v folder=, -v name=: the first
# part of their names). Some are refused in one process too.
function u(a, b) { return a + (b - a) * rand() }
function one(n) { return int(n * rand()) }
function pick(list,   parts, n) { n = split(list, parts, " "); return parts[1 + one(n)] }
function place(a, b,   text, i) { # each coordinate in that part of the body
    for (i = 1; i <= d; i++) text = text (i > 1 ? ", " : "") sprintf("%.4g", high[i] * u(a, b))
    return text
}
function vector(   text, i) {
    for (i = 1; i <= d; i++) text = text (i > 1 ? ", " : "") sprintf("%.3f", u(-1, 1))
    return text
}
function history(   k, t, table) {
    k = one(6)
    if (k == 5) { # of a file
        table = files "-pulse" ++tables ".txt"
        for (t = 0; t <= 1.4; t += .1) printf "%.1f %.5f\n", t, exp(-((t - .5) / .2) ^ 2) >(folder "/" table)
        return "history = 'table', file = '" table "'"
    }
    if (k == 0) return "history = 'triangle', duration = .7"
    if (k == 1) return "history = 'ricker', frequency = 1.2, delay = .5"
    if (k == 2) return "history = 'brune', width = .15"
    return sprintf("history = 'gaussian', width = %.3f, delay = .5", u(.15, .3))
}
function load(   k, centre, moment, i) {
    k = one(moving ? 3 : 5)
    if (k <= 1) { # the first axis but the last one of `top` is across it
        for (i = 1; i < d; i++) centre = centre sprintf("%.4g, ", high[i] * u(.3, .7))
        speed = !sph && k && !single && scheme != "modified-equation" && !one(2) ? sprintf(", velocity = %.3f%s, 0", m * u(.2, .6), d == 3 ? sprintf(", %.3f", m * u(-.4, .4)) : "") : ""
        return sprintf("&load face = '%s', shape = '%s', centre = %s%s, size = %s, direction = %s, amplitude = %g%s, %s /\n", top, k || d == 2 ? "square" : "disc",
            centre, bumpy ? "depth = 0" : 0, d == 3 && k ? m ", " .8 * m : .9 * m, vector(), strength,
            speed, history())
    }
    if (k == 2) return sprintf("&load kind = 'body-force'%s, direction = %s, amplitude = %g, %s /\n", moving || (sph && one(2)) ? "" : ", shape = 'point', centre = " place(.2, .9), vector(), strength, history())
    for (i = 0; i < 6; i++) moment = moment sprintf("%s%.3f", i ? ", " : "", d == 3 || i == 0 || i == 1 || i == 3 ? u(-1, 1) : 0)
    return sprintf("&load kind = 'moment-tensor', centre = %s, %s, amplitude = %g, %s /\n", place(.25, .8), d == 3 && one(2) ? sprintf("mechanism = %.1f, %.1f, %.1f", u(0, 360), u(0, 90), u(-90, 90)) : "moment = " moment, strength, history())
}
function boundaries(   i, s, k, text) {
    for (i = 1; i <= d; i++) for (s = 1; s <= 2; s++) {
        k = one(mirrored && i < d ? 1 : 9)
        face = substr("xyz", i, 1) substr("-+", s, 1)
        if (k < 3 || (face == top && k < 7)) continue
        if (bumpy && face == top) continue
        text = text "&boundary face = '" face "', kind = '" (k == 3 ? "fixed' /\n" : k == 4 ? "roller' /\n" : k == 5 && !(sph && moving) ? "symmetry' /\n" : k == 6 && kind != "general" && !single && !(sph && damped) ? pick("velocity displacement") "', direction = " vector() ", amplitude = .01, history = 'gaussian', width = .2, delay = .5 /\n" : "transmitting'" (moving ? "" : sph || damper ? ", layer = 'lysmer'" : sprintf(", layer = 'pml', layer_points = %d, always = T", 3 + one(4))) " /\n")
    }
    return text
}
function fields(   list, text, i, n) {
    n = split("velocity displacement acceleration stress strain pressure energy", list, " ")
    text = "'" list[i = 1 + one(n)] "'"
    while (++i <= n) if (one(2)) text = text ", '" list[i] "'"
    return text
}
function receiver(   at) { # by its depth below the surface, some of them
    at = place(0, 1)
    if (!sph && !one(3)) sub(/, [^,]*$/, sprintf(", depth = %.3g", m * u(0, 3)), at)
    return at
}
function model(   x, y, z, i, at) { # speeds and density that vary along all axes, and heights of a surface
    printf "&model file = '%s-ground.xyz', origin = %.3g, %.3g, azimuth = %.3g%s /\n", files, m * u(-2, 0), m * u(-2, 0), u(-20, 20), damped ? ", q_frequency = 1" : ""
    at = folder "/" files "-ground.xyz"
    printf "-8000 -8000 -36000 8000 8000 0\n2000 2000 1000\n9 9 37\n1 9000 1 9000 1 9000\n" >at
    for (z = -36; z <= 0; z++) for (y = -8; y <= 8; y += 2) for (x = -8; x <= 8; x += 2) {
        i = 1 - .02 * z + .1 * sin(x + 2 * y + z)
        printf "%g %g %g %.1f %.1f %.1f%s\n", m * x, m * y, m * z, 1750 * i, 1000 * i, 1000 + 100 * cos(y + z), damped ? sprintf(" %.3g %.3g", 30 + x, 25 + y) : "" >at
    }
}
function heights(   x, y, at) {
    at = folder "/" files "-heights.txt"
    for (x = -1; x <= 5; x += .5) for (y = -1; y <= (d == 3 ? 5 : -1); y += .5) printf d == 3 ? "%g %g %.4f\n" : "%g %.0s%.4f\n", m * x, m * y, .2 * m * sin(2 * x) * cos(y) >at
    printf "&topography file = '%s-heights.txt' /\n", files
}
BEGIN {
    files = name == "" ? "drawn" : name
    if (folder == "") folder = "."
    srand(seed); for (i = 0; i < 10; i++) rand()
    kind = pick("lattice lattice lattice general general points points particles")
    sph = kind == "points" || kind == "particles"; moving = kind == "particles"
    d = moving ? 2 : one(3) ? 3 : 2
    h = moving ? .1 : .25; top = d == 3 ? "z-" : "y-"; strength = sph ? .02 : 1
    damper = !one(4); damped = kind != "particles" && !one(4); mirrored = !sph && kind == "lattice" && !one(4)
    bumpy = kind == "general" && one(2)
    for (i = 1; i <= d; i++) high[i] = moving ? pick("2 3 4") : i == d ? (d == 3 ? pick("12 15 18") : pick("16 24 34")) : pick("1.5 2 3 4")
    if (d == 3 && kind == "lattice" && !one(3)) { high[2] = pick("9 10"); high[3] = 9 }
    if (kind == "points" && !one(3)) { t = high[1]; high[1] = high[d]; high[d] = t }
    layers = moving ? 0 : one(3)
    modelled = kind == "general" && d == 3 && one(2)
    m = modelled ? 1000 : 1 # such files are in metres
    if (modelled) { layers = 0; h *= m; strength = 1e9; for (i = 1; i <= d; i++) high[i] *= m }
    printf "&scene dimension = %d, end_time = %.3g%s /\n", d, moving ? .5 : u(.9, 1.3), d == 2 && !damped && kind != "general" && !one(4) ? ", plane = 'stress'" : ""
    if (sph) {
        printf "&method name = 'sph', variant = '%s'", moving ? "updated-lagrangian" : "total-lagrangian"
        if (!moving) { if (damped) printf ", law = 'linear'"; else if (one(2)) printf ", law = '%s'", pick("linear neo-hookean saint-venant-kirchhoff"); if (one(2)) printf ", gradient = '%s'", pick("linear quadratic central") }
        if (moving && one(2)) printf ", kernel = '%s'", pick("cubic wendland quintic")
        if (!damped && !one(3)) printf ", viscosity_alpha = .5"
        if (!one(4)) printf ", hourglass = .2"
        print " /"
        if (moving || !one(4)) printf "&stepping scheme = '%s' /\n", moving ? pick("euler pc2 rk4 rkc") : pick("leapfrog rk4 lsrk54")
    } else {
        printf "&method "
        exact = !one(4)
        if (kind == "lattice") {
            if (!exact && d == 3 && !mirrored && layers == 0 && !one(2)) { single = 1; printf "precision = 'single', " }
            else printf "mass = '%s', degree = %d, ", exact ? "exact" : pick("vc1 vc2 vc3 vc3"), exact ? 2 + one(3) : 2
        } else if (d == 3 && !one(3)) { single = 1; printf "precision = 'single', " }
        if (!single && !one(4)) printf "fused = F, "
        if (single) { damper = 0; for (i = 1; i < d; i++) if (high[i] < 4 * m) high[i] = 4 * m }
        if (kind == "lattice" && !exact && !one(5)) printf "dissipation = .02, "
        printf "quiet = %s /\n", pick("0 1e-12 1e-6")
        if (one(3)) printf "&stepping scheme = '%s'%s /\n", scheme = pick("leapfrog leapfrog modified-equation" (damper ? " rk4" : "")), scheme == "leapfrog" && !one(3) ? ", unwarp = T" : ""
    }
    split("soil clay rock", rock, " ")
    for (i = 1; i <= 3; i++) if (modelled ? i > 1 : i <= layers + 1 || kind == "general") printf "&material name = '%s', density = %.3f, lambda = %.3f, mu = %.3f%s /\n", rock[i], m * (u(.9, 1.2) + .2 * i), m ^ 3 * u(.6, 1) * i, m ^ 3 * u(.8, 1.1) * i, damped ? sprintf(", q_p = %.1f, q_s = %.1f", u(22, 38), u(20, 40)) : ""
    printf "&body name = 'b', %slow = 0, 0%s, high = ", modelled ? "" : "material = 'soil', ", d == 3 ? ", 0" : ""
    for (i = 1; i <= d; i++) printf "%s%g", (i > 1 ? ", " : ""), high[i]
    printf ", spacing = %g%s /\n", h, sph && !one(3) ? ", jitter = .1" : ""
    if (layers) {
        print "&layer body = 'b', material = 'soil', top = 0 /"
        for (i = 1; i <= layers; i++) printf "&layer body = 'b', material = '%s', top = %.4g%s%s /\n", rock[i + 1], high[d] * u(.15 + .35 * (i - 1), .45 * i), kind == "general" && one(2) ? sprintf(", dip = %.3g", u(2, 15)) (d == 3 ? sprintf(", strike = %.3g", u(0, 360)) : "") : "", kind == "general" && i < layers && !one(2) ? ", bottom = 'rock'" : ""
    }
    if (kind == "general") {
        size = d == 3 ? 1.1 * m ", " .9 * m ", " 1.7 * m : "1.2, 2.1"
        print "&block material = 'rock', shape = 'ellipsoid', centre = " place(.3, .7) ", size = " size " /"
        print "&block material = 'clay', shape = 'box', centre = " place(.3, .7) ", size = " size " /"
        for (i = one(3); i > 0; i--) printf "&block material = '%s', shape = '%s', centre = %s, size = %s /\n", pick("clay rock"), pick("box ellipsoid"), place(.2, .8), size
        s = pick("gaussian ridge canyon file")
        if (bumpy && s == "file") heights()
        else if (bumpy) printf "&topography shape = '%s', height = %.3g, centre = %.3g%s, width = %.3g%s /\n", s, m * u(.1, .4), high[1] * u(.3, .7), d == 3 && s == "gaussian" ? sprintf(", %.3g", high[2] * u(.3, .7)) : d == 3 ? sprintf(", %.3g", high[2] / 2) : "", m * u(.5, .9), d == 3 && s != "gaussian" ? ", azimuth = 30" : ""
    }
    if (modelled) model()
    printf "%s", boundaries()
    if (mirrored) printf "&load face = '%s', shape = 'square', centre = %g, %s0, size = 1%s, direction = 0, %s1, history = 'gaussian', width = .2, delay = .5 /\n", top, high[1] / 2, d == 3 ? high[2] / 2 ", " : "", d == 3 ? ", 1" : "", d == 3 ? "0, " : ""
    else for (i = 1 + one(3); i > 0; i--) printf "%s", load()
    if (!mirrored && !one(5)) printf "&initial kind = 'gaussian', amplitude = %g, width = %d, centre = %s, direction = %s /\n", modelled ? 1 : strength, m, place(.3, .7), vector()
    for (i = 2 + one(3); i > 0; i--) printf "&receiver name = '%s', position = %s /\n", i == 1 ? "lower" : "r" i, receiver()
    for (i = one(3); i > 0; i--) printf "&profile name = 'p%d', from = %s, to = %s, points = %d, times = .2, %s, fields = %s /\n", i, place(0, .3), place(.7, 1), 2 + one(40), moving ? .44 : .8, fields()
    if (one(2)) printf "&snapshot every = .4, fields = %s /\n", fields()
    if (!one(3)) printf "&snapshot times = .37, %s, fields = %s, region = %s, %s /\n", moving ? .48 : .81, fields(), place(.1, .3), place(.6, .9)
    printf "&output plots = F%s%s%s%s%s /\n", one(2) ? ", history_step = .05" : "", one(4) ? "" : ", low_pass = 12", one(4) ? "" : ", length_unit = 'km', time_unit = 's'",
        one(4) ? "" : ", checkpoint_every = 7", damped && !one(2) ? ", balance = T" : ""
}
