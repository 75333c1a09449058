# A figure of the study slam_memory:  gnuplot docs/guides/mapping_memory.gp
if (!exists("folder")) folder = "results/slam_memory"
study = folder."/study.csv"
set terminal pngcairo size 900,420 font "sans,11"
set output folder."/memory.png"
set datafile separator ","
set datafile missing ""
set datafile columnheaders
set multiplot layout 1,2
set xlabel "day"
set xrange [0.5:7.5]
set xtics (1, 3, 7)
set grid
array days[3] = [1, 3, 7]
do for [figure in "iou stale_percent"] {
  set ylabel figure eq "iou" ? "intersection over union" : "stale cells, % of those that have changed"
  if (figure eq "iou") { set key bottom left } else { set key top left }
  # The means; a day that no run has reached has none.
  set print $means
  print "day,forgetting,static"
  do for [i = 1:3] {
    array means[2]
    do for [k = 1:2] {
      undefine STATS_*
      stats study using sprintf("%sday%d.%s", k == 1 ? "" : "static_", days[i], figure) nooutput
      means[k] = exists("STATS_records") ? sprintf("%g", STATS_mean) : ""
    }
    print sprintf("%d,%s,%s", days[i], means[1], means[2])
  }
  set print
  # A small point for each run, a line through the means.
  plot for [i = 1:3] study using (days[i] - 0.06):sprintf("day%d.%s", days[i], figure) \
         with points pt 7 ps 0.5 lc rgb "#9fb4dd" notitle, \
       for [i = 1:3] "" using (days[i] + 0.06):sprintf("static_day%d.%s", days[i], figure) \
         with points pt 7 ps 0.5 lc rgb "#e8b090" notitle, \
       $means using 1:2 with linespoints pt 7 lw 2 lc rgb "#204080" title "forgetting", \
       $means using 1:3 with linespoints pt 9 lw 2 lc rgb "#b05020" title "all evidence"
}
