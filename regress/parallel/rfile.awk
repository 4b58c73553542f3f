# A model of the ground, SW4's rfile, of 17 x 17 values 50 apart along the surface and `values` (-v) 5 apart over depth, two
# rocks in turn: LC_ALL=C awk -v values=1921 -f regress/parallel/rfile.awk >ground.rfile
function bytes(list, n, i, one) {
    n = split(list, one, " ")
    for (i = 1; i <= n; i++) printf "%c", one[i]
}
BEGIN {
    zero = "0 0 0 0"; real = zero " " zero; fifty = zero " 0 0 73 64"; five = zero " 0 0 20 64"
    bytes("1 0 0 0 4 0 0 0 " zero " " real " " real " " real " " zero " 2 0 0 0")
    bytes(fifty " " fifty " " real " 1 0 0 0 17 0 0 0 17 0 0 0 1 0 0 0")
    bytes(fifty " " five " " real " 3 0 0 0 17 0 0 0 17 0 0 0 " values % 256 " " int(values / 256) " 0 0")
    for (i = 0; i < 289; i++) bytes(zero)
    rock[0] = "0 0 250 68 0 128 59 69 0 128 187 68" # 2000 3000 1500
    rock[1] = "0 0 225 68 0 0 250 68 0 0 122 68"    # 1800 2000 1000
    for (i = 0; i < 289; i++) for (k = 0; k < values; k++) bytes(rock[(i + int(k / 160)) % 2])
}
