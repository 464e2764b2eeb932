# SPDX-License-Identifier: BSD-3-Clause
# Pictures of Schmidt, Vogt and Niemann's Table 1, paper and simulation. Variables: data, residuals, errors (files).
set encoding utf8
set style data histogram
set style histogram clustered gap 1
set style fill solid 0.9 noborder
set boxwidth 0.9
set grid ytics lc rgb '#dddddd'
set border 3 lc rgb '#666666'
set tics nomirror
set xtics rotate by -28 noenhanced font ',10'
set key top right samplen 1
set yrange [0:*]
setup(i) = word('ART1 ART2 wide', i + 1)

set offsets 0, 0, graph 0.3, 0
# Columns of data: label, then ours and the paper's translation [%], rotation [deg], rotation [%]; true errors deg, mm.
residual(i) = i == 0 ? 'translation residual [%]' : i == 1 ? 'rotation residual [deg]' : 'rotation residual [%]'

set terminal svg size 1280,760 font 'sans-serif,12' background '#ffffff'
set output residuals
set multiplot layout 2,3 margins 0.04,0.96,0.16,0.94 spacing 0.06,0.22
do for [i=0:1] {
  do for [j=0:2] {
    set title setup(i) . ': ' . residual(j)
    plot data index i using (column(3 + 2 * j)):xtic(1) title 'paper' lc rgb '#9aa5b1', \
         '' index i using (column(2 + 2 * j)) title 'simulated' lc rgb '#1f6f8b'
  }
}
unset multiplot

set terminal svg size 960,420 font 'sans-serif,12' background '#ffffff'
set output errors
set multiplot layout 1,2 margins 0.07,0.95,0.28,0.91 spacing 0.09,0.2
set title 'true error of the rotation [deg]'
plot for [i=0:2] data index i using 8:xtic(1) title setup(i) lc rgb word('#1f6f8b #e08e45 #5b8c5a', i + 1)
set title 'true error of the translation [mm]'
plot for [i=0:2] data index i using 9:xtic(1) title setup(i) lc rgb word('#1f6f8b #e08e45 #5b8c5a', i + 1)
unset multiplot
