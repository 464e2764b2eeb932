// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "daemon/tracking/patch_basis.hpp"

/// The loops over a patch's pixels, eight at a time: all that the tracker spends its time in but
/// the sampling. Patches are given by their values, row by row as in Patch.
namespace handeye {

/// Grey values less their mean and derivatives by central differences, from the pixel left above
/// the patch; zero in the padding. `whole`: of whole_patch().
void take_patch(const std::int16_t* pixels, std::ptrdiff_t stride, const float* whole, float* grey,
                float* dx, float* dy);

/// (values - constant) * weights.
void weigh_less(float constant, const float* weights, float* values);

float weighted_mean(const float* image, const float* weights);

/// Products of the weighed image, less `mean`, with each image of the basis, then with itself:
/// PatchBasis::kCount + 1 sums.
void product_sums(const float* image, const PatchBasis& basis, const float* weights, float mean,
                  float* sums);

/// Sums of a product of two images times 1, u, v, uu, uv, vv.
struct PatchMoments {
  float one, u, v, uu, uv, vv;
};
void moments_of(const float* a, const float* b, PatchMoments& moments);

/// Upper triangle of the shift's normal matrix, row by row: 21 sums.
void shift_sums(const PatchBasis& basis, const float* weights, float* sums);

}  // namespace handeye
