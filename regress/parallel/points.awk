# Points of a body of nx x ny x nz cells (-v n="7 6 52"; of two numbers a plane), .25 wide, in no order, each moved by up to
# `jitter` of that along each axis; graded=1: .6 to 1.4 as far apart along the longest axis; gap=1: none in 3 of its layers;
# normals=1: with those of the last axis's ends and of x-: awk -v n="10 80" -v jitter=.15 -f regress/parallel/points.awk
function random() { seed = (seed * 1109 + 12345) % 65536; return 2 * seed / 65536 - 1 }
BEGIN {
    seed = 7; h = .25; d = split(n, count, " "); all = 1
    for (c = 1; c <= d; c++) { all *= count[c]; if (count[c] >= count[longest]) longest = c }
    for (step = 1009; all % step == 0;) step += 2
    for (k = 0; k < all; k++) {
        left = k * step % all; volume = h ^ d; line = ""; face = 0; normal = ""
        for (c = 1; c <= d; c++) {
            at = left % count[c]; left = int(left / count[c]); there[c] = at
            x[c] = (at + .5 + jitter * random()) * h
            end = c == d && at == 0 ? -1 : c == d && at == count[c] - 1 ? 1 : c == 1 && at == 0 ? -1 : 0
            if (end && (c == d || !face)) { for (b = 1; b <= d; b++) way[b] = b == c ? end : 0; face = 1 }
        }
        if (gap && there[longest] >= 30 && there[longest] < 33) continue
        part = x[longest] / (h * count[longest])
        if (graded) { x[longest] *= .6 + .4 * part; volume *= .6 + .8 * part }
        for (c = 1; c <= d; c++) { line = line sprintf("%.9f ", x[c]); normal = normal " " (face ? way[c] : 0) }
        print line volume (normals ? normal " " (face ? h ^ (d - 1) : 0) : "")
    }
}
