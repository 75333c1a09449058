# A figure of the study slam_days:  gnuplot docs/guides/mapping_memory.gp
if (!exists("study")) study = "results/slam_days/study.csv"
set terminal pngcairo size 900,420 font "sans,11"
set output "results/slam_days/memory.png"
set datafile separator ","
set datafile missing ""
set multiplot layout 1,2
set xlabel "days"
set xrange [0.5:7.5]
set xtics (1, 3, 7)
set grid
# Days in the name of a case, such as static_3, or nothing for another kind.
days(name, kind) = strstrt(name, kind."_") == 1 ? substr(name, strlen(kind) + 2, strlen(kind) + 2) + 0 : NaN
do for [figure in "map.iou map.stale_percent"] {
  set ylabel figure eq "map.iou" ? "intersection over union" : "stale cells, % of those that changed"
  if (figure eq "map.iou") { set key bottom left } else { set key top left }
  # A small point for each run, a line through the means.
  plot study using (days(strcol("case"), "forgetting") - 0.06):figure with points pt 7 ps 0.5 lc rgb "#9fb4dd" notitle, \
       "" using (days(strcol("case"), "static") + 0.06):figure with points pt 7 ps 0.5 lc rgb "#e8b090" notitle, \
       "" using (days(strcol("case"), "forgetting")):figure smooth unique with linespoints pt 7 lw 2 lc rgb "#204080" title "forgetting", \
       "" using (days(strcol("case"), "static")):figure smooth unique with linespoints pt 9 lw 2 lc rgb "#b05020" title "all evidence"
}
