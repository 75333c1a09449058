# The image of docs/guides/twelve_motions.md, from the tables of its commands:  gnuplot docs/guides/twelve_motions.gp
set terminal pngcairo size 900,640 font "sans,10"
set output "docs/guides/twelve_motions.png"
set datafile separator ","
set multiplot layout 2,1
set xlabel "time of the repeated motion, s"
set ylabel "torso to the farthest model, mm"
set logscale y
set yrange [0.001:2000]
set format y "10^{%L}"
set xrange [0:30]
set key outside right top noenhanced
set grid
motions = "bow crouch nod push_ups search shake_head stand steps stretch sway wag wave"
# Broken lines: the static margin is negative at times.
dash(i) = strstrt(" bow steps sway wave ", " ".word(motions, i)." ") > 0 ? 2 : 1
array colors[12] = [0x204080, 0x208040, 0xc06020, 0x8040a0, 0x40a0c0, 0xa0a020, 0xc02020, 0x000000, 0x80b080, 0xc060a0, 0x808080, 0x6060e0]
set title "as they are"
plot for [i=1:12] "results/twelve_motions.csv" skip 1 using 1:(column(i+1) > 0.001 ? column(i+1) : 0.001) with lines lw 1.5 lc rgb colors[i] dt dash(i) title word(motions, i)
set title "three times as fast"
dash(i) = strstrt(" bow stand steps sway wave ", " ".word(motions, i)." ") > 0 ? 2 : 1
plot for [i=1:12] "results/twelve_motions_fast.csv" skip 1 using 1:(column(i+1) > 0.001 ? column(i+1) : 0.001) with lines lw 1.5 lc rgb colors[i] dt dash(i) title word(motions, i)
unset multiplot
