# A scene of real ground drawn by chance, and its images. Variables: seed; image = base | mirrored | turned | exchanged |
# shifted, the whole scene carried there; there | back, a force at A in direction i seen at B, and one at B in direction j
# seen at A; first | second, one of two loads alone; idle, with words that change nothing; folder, for the files it names;
# files, the ending of their names.
# Prints the deck. Its first line is a comment with words: what the scene has, for `run`. Units are m, s and kg.
function u(a, b) { return a + (b - a) * rand() }
function one(n) { return int(n * rand()) }
function pick(list,   parts, n) { n = split(list, parts, " "); return parts[1 + one(n)] }
function X(x, y) { return txx * x + txy * y + tx } # of places
function Y(x, y) { return tyx * x + tyy * y + ty }
function place(x, y, z) { return d == 3 ? sprintf("%.13g, %.13g, %.13g", X(x, y), Y(x, y), z) : sprintf("%.13g, %.13g", X(x, 0), z) }
function level(x, y) { return d == 3 ? sprintf("%.13g, %.13g", X(x, y), Y(x, y)) : sprintf("%.13g", X(x, 0)) }
function vector(x, y, z) {
    return d == 3 ? sprintf("%.6f, %.6f, %.6f", txx * x + txy * y, tyx * x + tyy * y, z) : sprintf("%.6f, %.6f", txx * x, z)
}
function edges(a, b, c) { return d == 3 ? sprintf("%.13g, %.13g, %.13g", txx ? a : b, txx ? b : a, c) : sprintf("%.13g, %.13g", a, c) }
function side(face,   axis, sign) { # where a face x-, y-, ... of the scene lies in the image
    if (d == 2) return face == "y-" || face == "y+" || txx > 0 ? face : face == "x-" ? "x+" : "x-"
    axis = substr(face, 1, 1); sign = substr(face, 2) == "-" ? -1 : 1
    if (axis == "z") return face
    if (axis == "x") { sign *= txx + tyx; return (txx ? "x" : "y") (sign < 0 ? "-" : "+") }
    sign *= txy + tyy
    return (tyy ? "y" : "x") (sign < 0 ? "-" : "+")
}
function turn(angle) { # a direction from x towards y
    if (image == "mirrored") return -angle
    if (image == "turned") return angle + 90
    return image == "exchanged" ? 90 - angle : angle
}
function strike(angle) { # it deepens towards strike + 90
    if (image == "exchanged") return -90 - angle
    return turn(angle)
}
function bump(x, y) { return bh * exp(-((x - bx) ^ 2 + (d == 3 ? (y - by) ^ 2 : 0)) / (2 * bw * bw)) + slope * x }
function height_file(name, depth,   i, j, step, last) { # x y height, each x with each y
    step = 4 * h; last = int(reach / step) + 2
    file = folder "/" name files; printf "" >file
    for (j = d == 3 ? -last : 0; j <= (d == 3 ? last : 0); j++) for (i = -last; i <= last; i++)
        printf "%s %.13g\n", d == 3 ? sprintf("%.13g %.13g", X(i * step, j * step), Y(i * step, j * step)) : sprintf("%.13g", X(i * step, 0)), depth + bump(i * step, j * step) >file
    close(file)
    return name files
}
function history() {
    if (one(3)) return sprintf("history = \"gaussian\", width = %.4f, delay = %.4f", w, 5 * w)
    return sprintf("history = \"ricker\", frequency = %.4f, delay = %.4f", .16 / w, 7 * w)
}
function quality(   q) { q = u(15, 80); return damped ? sprintf(", q_p = %.1f, q_s = %.1f", q * u(1.4, 2), q) : "" }
function material(name, s,   nu) {
    nu = u(.2, .4)
    return sprintf("&material name = \"%s\", density = %.0f, p_speed = %.1f, s_speed = %.1f%s /\n", name, 1000 * u(1.6, 2.6), s * sqrt(2 * (1 - nu) / (1 - 2 * nu)), s, quality())
}
function load(i,   k, at, common, x, y, deep, m, j) {
    x = u(-far, far) / 2; y = u(-far, far) / 2; deep = h * u(2.2, 7)
    common = sprintf(", amplitude = 1e6, direction = %s, %s /\n", vector(u(-1, 1), u(-1, 1), u(.3, 1)), history())
    k = one(5)
    for (j = 0; j < 6; j++) m[j] = u(-1, 1)
    at = rand() < .5 ? sprintf("centre = %s, depth = %.13g", level(x, y), deep) : "centre = " place(x, y, deep + bumpy)
    a = u(3, 6) * h; b = u(3, 6) * h
    if (k == 0 && !sloped) return sprintf("&load face = \"%s\", shape = \"square\", centre = %s, size = %s%s", top, place(x, y, 0), d == 3 ? (txx ? a ", " b : b ", " a) : a, common)
    if (k == 1 && d == 3 && !sloped) return sprintf("&load face = \"z-\", shape = \"disc\", centre = %s, size = %.6g%s", place(x, y, 0), a, common)
    if (k <= 2) return sprintf("&load kind = \"body-force\", shape = \"point\", %s%s", at, common)
    if (d == 2) return sprintf("&load kind = \"moment-tensor\", %s, amplitude = 1e8, moment = %.4f, %.4f, 0, %.4f, 0, 0, %s /\n", at, m[0], m[1], txx * m[3], history())
    # T M T^t
    xx = txx * txx * m[0] + txy * txy * m[1] + 2 * txx * txy * m[3]; yy = tyx * tyx * m[0] + tyy * tyy * m[1] + 2 * tyx * tyy * m[3]
    xy = txx * tyx * m[0] + txy * tyy * m[1] + (txx * tyy + txy * tyx) * m[3]
    return sprintf("&load kind = \"moment-tensor\", %s, amplitude = 1e10, moment = %.4f, %.4f, %.4f, %.4f, %.4f, %.4f, %s /\n", at,
        xx, yy, m[2], xy, tyx * m[5] + tyy * m[4], txx * m[5] + txy * m[4], history())
}
function rock_at(x, y, z, what,   f) { # smooth ground of a model
    f = 1 + .3 * sin(x / (9 * h) + 1) * cos(y / (11 * h)) * exp(-z * z / (200 * h * h)) + .3 * z / reach
    return what == "density" ? 2000 * (.8 + .2 * f) : what == "s" ? slow * f : what == "p" ? slow * f * model_ratio : what == "q" ? 30 * f : 0
}
function model_file(   i, j, k, step, n, m, file, x, y, z, old) { # x is east, which is the body s y, y north
    file = folder "/model" files; step = 3 * h; n = int(2 * reach / step) + 2; m = int(reach / step) + 4
    printf "%.13g %.13g %.13g %.13g %.13g %.13g\n", -n * step / 2 + ty, -n * step / 2 + tx, -m * step, n * step / 2 + ty, n * step / 2 + tx, 2 * step >file
    printf "%.13g %.13g %.13g\n%d %d %d\n1 20000 1 20000 1 20000\n", step, step, step, n + 1, n + 1, m + 3 >file
    for (k = -m; k <= 2; k++) for (j = 0; j <= n; j++) for (i = 0; i <= n; i++) {
        y = (i - n / 2) * step; x = (j - n / 2) * step; z = -k * step
        ox = txx * x + tyx * y; oy = txy * x + tyy * y # the transpose
        printf "%.13g %.13g %.13g %.13g %.13g %.13g", y + ty, x + tx, -z, rock_at(ox, oy, z, "p"), rock_at(ox, oy, z, "s"), rock_at(ox, oy, z, "density") >file
        if (damped) printf " %.13g %.13g", 1.8 * rock_at(ox, oy, z, "q"), rock_at(ox, oy, z, "q") >file
        print "" >file
    }
    close(file)
    return "model" files
}
BEGIN {
    srand(seed); rand()
    txx = tyy = 1; txy = tyx = tx = ty = 0
    if (image == "mirrored") txx = -1
    if (image == "turned") { txx = tyy = 0; txy = -1; tyx = 1 }
    if (image == "exchanged") { txx = tyy = 0; txy = tyx = 1 }
    if (image == "shifted") { tx = 1234.5; ty = -777 }
    d = rand() < .5 ? 3 : 2
    top = d == 3 ? "z-" : "y-"; bottom = d == 3 ? "z+" : "y+"
    h = int(u(60, 200)); slow = 1000 * u(.9, 1.5)
    damped = rand() < .4
    w = h / slow * u(1.9, 2.5)
    model = d == 3 && rand() < .25; given = rand() < .6 || d == 3
    nx = d == 3 ? 12 + 2 * one(4) : 30 + 2 * one(20); ny = d == 3 ? 12 + 2 * one(4) : 0; nz = d == 3 ? 12 + 2 * one(2) : 20 + 2 * one(8)
    far = given ? (nx < ny || d == 2 ? nx : ny) * h * .35 : h * (d == 3 ? u(3, 6) : u(4, 14))
    reach = given ? (nx > ny ? nx : ny) * h * .5 : far + (d == 3 ? 26 : 60) * h
    features = d " " (given ? "given" : "fitted") (damped ? " damped" : "")
    # the ground
    kind = model || d == 2 ? "none" : pick("none none level tilted graded file")
    hill = pick("none none gaussian ridge canyon file"); sloped = hill != "none"
    block = rand() < .4
    model_ratio = u(1.75, 2.2)
    features = features (model ? " model" : "") (kind == "none" ? "" : " " kind) (sloped ? " hill-" hill : "") (block ? " block" : "")
    text = ""
    if (!model) text = text material("rock", slow * u(1.2, 1.6))
    if (kind != "none") text = text material("soil", slow)
    if (kind == "graded") text = text material("clay", slow * u(1, 1.3))
    if (block) text = text material("lens", slow)
    body = sprintf("&body %sshape = \"half-space\", spacing = %.13g", model ? "" : "material = \"rock\", ", h)
    pml = lysmer = 0
    if (given) {
        x1 = -nx * h / 2; x2 = -x1; y1 = -ny * h / 2; y2 = -y1
        lx = X(x1, y1) < X(x2, y2) ? X(x1, y1) : X(x2, y2); hx = X(x1, y1) + X(x2, y2) - lx
        ly = Y(x1, y1) < Y(x2, y2) ? Y(x1, y1) : Y(x2, y2); hy = Y(x1, y1) + Y(x2, y2) - ly
        body = sprintf("&body %sshape = \"box\", spacing = %.13g, low = %s, high = %s", model ? "" : "material = \"rock\", ", h,
            d == 3 ? sprintf("%.13g, %.13g, 0", lx, ly) : sprintf("%.13g, 0", lx), d == 3 ? sprintf("%.13g, %.13g, %.13g", hx, hy, nz * h) : sprintf("%.13g, %.13g", hx, nz * h))
        n = split(d == 3 ? "x- x+ y- y+ z+" : "x- x+ y+", faces, " ")
        style = one(3)
        for (i = 1; i <= n; i++) {
            what = style == 0 ? pick("free fixed roller free") : style == 1 ? pick("lysmer free fixed lysmer") : pick("pml pml free roller")
            if (what == "free") continue
            pml += what == "pml"; lysmer += what == "lysmer"
            body = body sprintf(" /\n&boundary face = \"%s\", kind = \"%s\"%s", side(faces[i]), what == "pml" || what == "lysmer" ? "transmitting" : what,
                what == "pml" ? sprintf(", layer = \"pml\", layer_points = %d, always = T", 5 + one(5)) : what == "lysmer" ? ", layer = \"lysmer\"" : "")
        }
        features = features (pml ? " pml" : lysmer ? " lysmer" : " closed")
    }
    text = text body " /\n"
    if (model) {
        text = text sprintf("&model file = \"%s\", origin = 0, 0, 0 /\n", model_file())
    }
    lt = h * u(3, 7); bx = u(-far, far) / 2; by = u(-far, far) / 2; bw = h * u(4, 8); bh = bw * u(-.4, .4); slope = 0
    if (kind != "none") text = text sprintf("&layer material = \"soil\", top = 0%s /\n", kind == "graded" ? ", bottom = \"clay\"" : "")
    rad = atan2(0, -1) / 180; dip = 2 + one(18); direction = one(360); if (d == 2) direction = rand() < .5 ? 90 : -90
    if (kind == "level" || kind == "graded") text = text sprintf("&layer material = \"rock\", top = %.13g /\n", lt)
    if (kind == "tilted") text = text sprintf("&layer material = \"rock\", top = %.13g, dip = %.2f, strike = %d /\n", lt - sin(dip * rad) / cos(dip * rad) * (tx * cos((direction + 90) * rad) + ty * sin((direction + 90) * rad)), dip, strike(direction))
    if (kind == "file") text = text sprintf("&layer material = \"rock\", top = %.13g, file = \"%s\", datum = 300 /\n", lt + h, height_file("interface", 300))
    if (block) text = text sprintf("&block material = \"lens\", shape = \"%s\", centre = %s, size = %s /\n", pick("box ellipsoid"),
        place(u(-far, far) / 2, u(-far, far) / 2, h * u(0, 8)), edges(h * u(4, 9), h * u(4, 9), h * u(3, 8)))
    hw = h * u(4, 7); hh = hw * u(.1, .5); hx0 = u(-far, far) / 3; hy0 = u(-far, far) / 3; ha = one(180)
    if (hill == "gaussian") text = text sprintf("&topography shape = \"gaussian\", height = %.6g, centre = %s, width = %.6g /\n", rand() < .5 ? hh : -hh, level(hx0, hy0), hw)
    if (hill == "ridge" || hill == "canyon") text = text sprintf("&topography shape = \"%s\", height = %.6g, centre = %s, width = %.6g%s /\n", hill, hh, level(hx0, hy0), hw,
        d == 3 ? sprintf(", azimuth = %.6g", turn(ha)) : "")
    bumpy = sloped ? hh : 0
    bx = hx0; by = hy0; bw = hw; bh = rand() < .5 ? hh : -hh
    if (hill == "file") { slope = u(-.05, .05); text = text sprintf("&topography file = \"%s\", datum = 500 /\n", height_file("heights", 500)) }
    # method
    if (damped && rand() < .4) text = text sprintf("&method mechanisms = %d /\n", 2 + one(2))
    # sources and receivers
    many = 1 + (rand() < .3)
    for (i = 1; i <= many; i++) loads[i] = load(i)
    ax = u(-far, far) / 2; ay = u(-far, far) / 2; az = h * u(2.2, 6) + bumpy; qx = u(-far, far) / 2; qy = u(-far, far) / 2; qz = h * u(2.2, 6) + bumpy
    ai = one(d); aj = one(d); f = history()
    sourced = image == "there" || image == "back"
    if (sourced) {
        split("0 0 0", e, " "); e[1 + (image == "there" ? ai : aj)] = 1
        text = text sprintf("&load kind = \"body-force\", shape = \"point\", amplitude = 1e6, centre = %s, direction = %s, %s /\n",
            image == "there" ? place(ax, ay, az) : place(qx, qy, qz), d == 3 ? vector(e[1], e[2], e[3]) : vector(e[1], 0, e[2]), f)
        text = text sprintf("&receiver name = \"r0\", position = %s /\n", image == "there" ? place(qx, qy, qz) : place(ax, ay, az))
    } else {
        for (i = 1; i <= many; i++) if (!(image == "first" && i == 2) && !(image == "second" && i == 1)) text = text loads[i]
    }
    for (i = 0; i < 3; i++) {
        x = u(-far, far); y = u(-far, far); k = one(3); z = h * u(1.5, 7)
        if (sourced) continue
        text = text sprintf("&receiver name = \"r%d\", ", i) (k < 2 ? sprintf("position = %s, depth = %.13g", level(x, y), k ? z : 0) : "position = " place(x, y, z + bumpy)) " /\n"
    }
    end = w * (d == 3 ? u(9, 12) : u(13, 20))
    if (image == "idle") { # what changes nothing
        if (!block && !model && kind == "none") text = text sprintf("&block material = \"rock\", centre = %s, size = %s /\n", place(0, 0, 6 * h), edges(3.3 * h, 3.3 * h, 3.3 * h))
        if (!sloped) text = text sprintf("&topography shape = \"gaussian\", height = 0, centre = %s, width = %.6g /\n", level(0, 0), 4 * h)
    }
    printf "! %s loads-%d axes-%d-%d\n&scene dimension = %d, end_time = %.5f /\n%s", features, many, ai, aj, d, end, text
}
