// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "drivers/simulator/random_stream.hpp"

/// Smooth periodic random fields on square grids. A field of "lattice size" n is a cubic B-spline
/// with n x n random coefficients over the tile: band-limited, and it continues over the tile's
/// edges. Sizes are powers of two.
namespace handeye::simulator {

/// One step of cubic B-spline subdivision (Lane and Riesenfeld 1980): the same surface from twice
/// as many coefficients along each side. Periodic.
cv::Mat1f subdivide(const cv::Mat1f& coefficients);

/// A field with coefficients drawn on a lattice, refined to size x size; mean 0, variance 1.
cv::Mat1f spline_noise(int lattice_size, int size, RandomStream& random);

struct FractalOptions {
  int first_lattice{8};    ///< coarsest octave, at most the field's size
  int last_lattice{1024};  ///< finest octave, at most the field's size
  double gain{0.5};        ///< amplitude of an octave relative to the next coarser one
};

/// Sum of octaves from coarse to fine; mean 0, variance 1.
cv::Mat1f fractal_noise(const FractalOptions& options, int size, RandomStream& random);

}  // namespace handeye::simulator
