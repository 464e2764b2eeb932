# SPDX-License-Identifier: BSD-3-Clause
# Figures 4 to 6 of Chung's paper. Usage: gnuplot -e "data='FOLDER'; out='FOLDER'" chung.gnuplot
set terminal svg size 760,300 font "sans,12" background "white"
set xlabel "Gauss-Newton step"
set xtics 1
set grid
set key top right
do for [figure in "4 5 6"] {
  file = data . "/chung_figure" . figure . ".dat"
  set output out . "/chung_figure" . figure . ".svg"
  set multiplot layout 1,2
  set ylabel "error of the Gibbs vector"
  plot for [k=1:3] file using 1:(column(k+1)) with linespoints linewidth 2 pointtype 7 pointsize 0.5 title "z" . k
  set ylabel "error of the translation [mm]"
  plot for [k=1:3] file using 1:(column(k+4)) with linespoints linewidth 2 pointtype 7 pointsize 0.5 title "p" . k
  unset multiplot
}
