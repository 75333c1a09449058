# The image of docs/models/segway.md, from the study:  gnuplot docs/models/segway_latency.gp
set terminal pngcairo size 900,420 font "sans,11"
set output "docs/models/segway_latency.png"
set datafile separator ","
set datafile missing ""
set xlabel "latency of the commands, ms"
set ylabel "tilt, degrees"
set logscale y
set yrange [1:130]
set xrange [0:145]
set key top left
set grid
set arrow 1 from 87.7,1 to 87.7,130 nohead dt 2 lc rgb "#a04040" lw 2
set label 1 "linear model: 87.7 ms" at 86,1.4 right tc rgb "#a04040"
set arrow 2 from 111.5,1 to 111.5,130 nohead dt 3 lc rgb "#404040" lw 2
set label 2 "falls" at 113,1.4
set arrow 3 from 0,45 to 145,45 nohead lc rgb "#c0c0c0"
plot "results/segway_latency/study.csv" skip 1 using (("1".substr(strcol(1),4,6))-1000):12 with linespoints pt 7 lc rgb "#204080" title "largest, from the vertical", \
     "" skip 1 using (("1".substr(strcol(1),4,6))-1000):14 with linespoints pt 5 lc rgb "#208040" title "rms, about its mean"
