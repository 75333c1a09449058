# The image of docs/guides/vision_in_the_loop.md, from the study:  gnuplot docs/guides/ball_latency.gp
if (!exists("study")) study = "results/ball_latency/study.csv"
set terminal pngcairo size 900,420 font "sans,11"
set output "docs/guides/ball_latency.png"
set datafile separator ","
set datafile missing ""
set xlabel "latency of the camera, ms"
set ylabel "time until it touches the ball, s"
set xrange [-10:215]
set yrange [0:35]
set key top left
set grid
# Latency in the name of a case, such as still_020, or nothing for another kind.
latency(name, kind) = strstrt(name, kind."_") == 1 ? ("1".substr(name, strlen(kind) + 2, strlen(kind) + 4)) - 1000 : NaN
# A small point for each run, a line through the means.
plot study using (latency(strcol("case"), "still") - 2):"reached.time_s" with points pt 7 ps 0.5 lc rgb "#9fb4dd" notitle, \
     "" using (latency(strcol("case"), "predicted")):"reached.time_s" with points pt 7 ps 0.5 lc rgb "#9fd4af" notitle, \
     "" using (latency(strcol("case"), "rolling") + 2):"reached.time_s" with points pt 7 ps 0.5 lc rgb "#e8b090" notitle, \
     "" using (latency(strcol("case"), "still")):"reached.time_s" smooth unique with linespoints pt 7 lw 2 lc rgb "#204080" title "ball at rest", \
     "" using (latency(strcol("case"), "predicted")):"reached.time_s" smooth unique with linespoints pt 5 lw 2 lc rgb "#208040" title "ball at rest, predict", \
     "" using (latency(strcol("case"), "rolling")):"reached.time_s" smooth unique with linespoints pt 9 lw 2 lc rgb "#b05020" title "ball rolls in at 3.8 m/s"
