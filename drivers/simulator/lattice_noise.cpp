// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/lattice_noise.hpp"

#include <cmath>

namespace handeye::simulator {
namespace {

cv::Mat1f random_coefficients(int lattice_size, double sigma, RandomStream& random) {
  cv::Mat1f coefficients(lattice_size, lattice_size);
  for (float& coefficient : coefficients) coefficient = static_cast<float>(random.normal(sigma));
  return coefficients;
}

void normalise(cv::Mat1f& field) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(field, mean, deviation);
  field = (field - mean[0]) / deviation[0];
}

}  // namespace

cv::Mat1f subdivide(const cv::Mat1f& coefficients) {
  const int size = coefficients.rows;
  const int mask = size - 1;
  cv::Mat1f wide(size, 2 * size);
  for (int row = 0; row < size; ++row) {
    const float* in = coefficients[row];
    float* out = wide[row];
    for (int i = 0; i < size; ++i) {
      out[2 * i] = 0.125F * (in[(i - 1) & mask] + in[(i + 1) & mask]) + 0.75F * in[i];
      out[2 * i + 1] = 0.5F * (in[i] + in[(i + 1) & mask]);
    }
  }
  cv::Mat1f fine(2 * size, 2 * size);
  for (int row = 0; row < size; ++row) {
    const float* above = wide[(row - 1) & mask];
    const float* here = wide[row];
    const float* below = wide[(row + 1) & mask];
    float* even = fine[2 * row];
    float* odd = fine[2 * row + 1];
    for (int i = 0; i < 2 * size; ++i) {
      even[i] = 0.125F * (above[i] + below[i]) + 0.75F * here[i];
      odd[i] = 0.5F * (here[i] + below[i]);
    }
  }
  return fine;
}

cv::Mat1f spline_noise(int lattice_size, int size, RandomStream& random) {
  return fractal_noise({lattice_size, lattice_size, 1.0}, size, random);
}

cv::Mat1f fractal_noise(const FractalOptions& options, int size, RandomStream& random) {
  cv::Mat1f field = random_coefficients(options.first_lattice, 1.0, random);
  double amplitude = 1.0;
  while (field.rows < size) {
    field = subdivide(field);
    if (field.rows > options.last_lattice) continue;
    amplitude *= options.gain;
    field += random_coefficients(field.rows, amplitude, random);
  }
  normalise(field);
  return field;
}

}  // namespace handeye::simulator
