# Plots of regress/studies/stability/run into output/stability/: limits.png, regions.png, energy.png.

spectrum() { # spectrum ALPHA NAME: eigenvalues of the bar of 50 particles in slow compression, in c0 / spacing
    "$build/test/stability-spectrum" input/bar.nml 1 body%spacing=.02 "method%viscosity_alpha=$1" "method%viscosity_beta=$1" |
        awk '{ print $1 * .02 / 5088.4, $2 * .02 / 5088.4 }' >"$out/spectrum-$2.txt"
}

plots() {
    spectrum 2.5 strong
    spectrum .5 weak
    spectrum 0 none
    gnuplot <<GNUPLOT
set terminal pngcairo size 900,560 font 'DejaVu Sans,12'
set output '$out/limits.png'
set grid lt 1 lc rgb '#dddddd'
set logscale x 2
set xrange [1.8:34]
set yrange [0:5]
set xlabel 'stages of RKC'
set ylabel 'largest stable c_0 dt / spacing'
set title 'Bar, 125 particles, t = .12 ms: points measured, lines predicted by the program'
set key left top
f = '$out/sweep.txt'
plot f using (\$1 == 2.5 && strcol(2) eq 'rkc' ? \$3 : NaN):5 with points pt 7 lc rgb '#0060ad' title 'alpha = 2.5', \
     "< awk '\$1 == 2.5 && \$2 == \"rkc\"' " . f using 3:4 with lines lw 1.6 lc rgb '#0060ad' notitle, \
     f using (\$1 == .5 && strcol(2) eq 'rkc' ? \$3 : NaN):5 with points pt 5 lc rgb '#c03020' title 'alpha = .5', \
     "< awk '\$1 == .5 && \$2 == \"rkc\"' " . f using 3:4 with lines lw 1.6 lc rgb '#c03020' notitle, \
     f using (\$1 == 0 && strcol(2) eq 'rkc' ? \$3 : NaN):5 with points pt 9 lc rgb '#208040' title 'alpha = 0', \
     "< awk '\$1 == 0 && \$2 == \"rkc\"' " . f using 3:4 with lines lw 1.6 lc rgb '#208040' notitle, \
     "< awk '\$1 == 0 && \$2 == \"rk4\"' " . f using (2):5:(30):(0) with vectors nohead dt 2 lc rgb '#208040' title 'rk4 (4 calls), alpha = 0', \
     "< awk '\$1 == 2.5 && \$2 == \"rk4\"' " . f using (2):5:(30):(0) with vectors nohead dt 2 lc rgb '#0060ad' title 'rk4, alpha = 2.5'
GNUPLOT
    gnuplot <<GNUPLOT
set terminal pngcairo size 1000,760 font 'DejaVu Sans,11'
set output '$out/regions.png'
set grid lt 1 lc rgb '#dddddd'
i = {0,1}
t5(x) = 16*x**5 - 20*x**3 + 5*x
d5(x) = 80*x**4 - 60*x**2 + 5
e5(x) = 320*x**3 - 120*x
t10(x) = 512*x**10 - 1280*x**8 + 1120*x**6 - 400*x**4 + 50*x**2 - 1
d10(x) = 5120*x**9 - 10240*x**7 + 6720*x**5 - 1600*x**3 + 100*x
e10(x) = 46080*x**8 - 71680*x**6 + 33600*x**4 - 4800*x**2 + 100
p5 = 1 + 2./13/25
p10 = 1 + 2./13/100
b5 = e5(p5)/d5(p5)**2
b10 = e10(p10)/d10(p10)**2
r5(z) = 1 - b5*t5(p5) + b5*t5(p5 + d5(p5)/e5(p5)*z)
r10(z) = 1 - b10*t10(p10) + b10*t10(p10 + d10(p10)/e10(p10)*z)
r4(z) = 1 + z + z**2/2 + z**3/6 + z**4/24
set contour base
unset surface
set cntrparam levels discrete 1
set isosamples 240, 240
set table '$out/region-rk4'
splot [-4:1][-4:4] abs(r4(x + i*y))
set table '$out/region-rkc5'
splot [-18:1][-6:6] abs(r5(x + i*y))
set table '$out/region-rkc10'
splot [-70:2][-12:12] abs(r10(x + i*y))
unset table
set multiplot layout 2,2
set key left top Left reverse samplen 1 spacing .9
set xlabel 'Re lambda dt'
set ylabel 'Im lambda dt'
panel(c, s) = sprintf('eigenvalues at c_0 dt / spacing = %g, %s', c, s)
set xrange [-4:1]
set yrange [-5:5]
set title 'RK4, alpha = 0'
plot '$out/region-rk4' with lines lw 2 lc rgb '#888888' title '|R| = 1', '$out/spectrum-none.txt' using (\$1*4):(\$2*4) pt 7 ps .4 lc rgb '#0060ad' title panel(4, 'inside'), '' using (\$1*5):(\$2*5) pt 7 ps .4 lc rgb '#c03020' title panel(5, 'outside')
set xrange [-18:1.5]
set yrange [-8:8]
set title 'RKC, 5 stages, alpha = 0: the axis is outside'
plot '$out/region-rkc5' with lines lw 2 lc rgb '#888888' title '|R| = 1', '$out/spectrum-none.txt' using (\$1*1.4):(\$2*1.4) pt 7 ps .4 lc rgb '#c03020' title panel(1.4, 'grow')
set title 'RKC, 5 stages, alpha = 2.5'
plot '$out/region-rkc5' with lines lw 2 lc rgb '#888888' title '|R| = 1', '$out/spectrum-strong.txt' using (\$1*3.7):(\$2*3.7) pt 7 ps .4 lc rgb '#0060ad' title panel(3.7, 'inside')
set xrange [-70:3]
set yrange [-14:14]
set title 'RKC, 10 stages, alpha = 2.5: room on the left alone'
plot '$out/region-rkc10' with lines lw 2 lc rgb '#888888' title '|R| = 1', '$out/spectrum-strong.txt' using (\$1*4):(\$2*4) pt 7 ps .4 lc rgb '#0060ad' title panel(4, 'inside'), '' using (\$1*8):(\$2*8) pt 7 ps .4 lc rgb '#c03020' title panel(8, 'outside')
unset multiplot
GNUPLOT
    gnuplot <<GNUPLOT
set terminal pngcairo size 1000,620 font 'DejaVu Sans,12'
set output '$out/energy.png'
set grid lt 1 lc rgb '#dddddd'
set logscale y
set format y '10^{%L}'
set yrange [1e-26:1e4]
set xrange [0:1000]
set xlabel 'time'
set ylabel 'kinetic + strain energy'
set key right top outside
e(n) = '$out/' . n . '.energy'
plot e('free') using 1:(\$2+\$3) with lines lw 1.6 title 'all faces free', e('free-9') using 1:(\$2+\$3) with lines lw 1.6 title 'the same, nu = .45', \
     e('jitter-20') using 1:(\$2+\$3) with lines lw 1.6 title 'total Lagrangian, jitter 20 %', \
     e('corners') using 1:(\$2+\$3) with lines lw 1.6 title 'all faces transmitting', e('layer-10') using 1:(\$2+\$3) with lines lw 1.6 title 'soft layer, ratio 10', \
     e('pml-25') using 1:(\$2+\$3) with lines lw 1.6 title 'C-PML, nu = .25', e('pml-45') using 1:(\$2+\$3) with lines lw 1.6 title 'C-PML, nu = .45', \
     e('pml-strip-49') using 1:(\$2+\$3) with lines lw 1.6 title 'C-PML strip, nu = .49', e('pml-thin') using 1:(\$2+\$3) with lines lw 1.6 title 'C-PML, thin body', \
     e('paper') using 1:(\$2+\$3) with lines lw 1.6 title 'as published, no filter (stopped)'
GNUPLOT
}
