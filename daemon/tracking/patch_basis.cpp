// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/patch_basis.hpp"

#include "daemon/tracking/patch_sums.hpp"

namespace handeye {

void PatchBasis::take(const PaddedPlane<std::int16_t>& image, int x, int y) {
  take_patch(image.at(x - Patch::kRadius, y - Patch::kRadius), image.stride(),
             whole_patch().value.data(), grey.value.data(), dx.value.data(), dy.value.data());
}

void PatchBasis::weigh(const Patch& weights) {
  const float* weight = weights.value.data();
  weigh_less(weighted_mean(grey.value.data(), weight), weight, grey.value.data());
  weigh_less(0, weight, dx.value.data());
  weigh_less(0, weight, dy.value.data());
}

PatchProducts products(const Patch& image, const PatchBasis& basis, const Patch& weights) {
  std::array<float, PatchBasis::kCount + 1> sums;
  const float mean = weighted_mean(image.value.data(), weights.value.data());
  product_sums(image.value.data(), basis, weights.value.data(), mean, sums.data());
  return {Eigen::Map<const Eigen::Matrix<float, PatchBasis::kCount, 1>>(sums.data()).cast<double>(),
          sums[PatchBasis::kCount]};
}

PatchBasis::Matrix normal_matrix(const PatchBasis& basis, const Patch& weights) {
  using Index = PatchBasis::Index;
  PatchBasis::Matrix matrix;
  const auto set = [&](int a, int b, float sum) { matrix(a, b) = matrix(b, a) = sum; };
  const auto moments = [](const Patch& a, const Patch& b) {
    PatchMoments of;
    moments_of(a.value.data(), b.value.data(), of);
    return of;
  };
  const std::array<std::array<int, 3>, 2> derivative{
      {{Index::kDx, Index::kUDx, Index::kVDx}, {Index::kDy, Index::kUDy, Index::kVDy}}};
  const auto set_affine = [&](int a, int b, const PatchMoments& m) {
    const auto& rows = derivative[static_cast<std::size_t>(a)];
    const auto& columns = derivative[static_cast<std::size_t>(b)];
    const float sums[3][3] = {{m.one, m.u, m.v}, {m.u, m.uu, m.uv}, {m.v, m.uv, m.vv}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) set(rows[i], columns[j], sums[i][j]);
    }
  };
  const auto set_light = [&](int a, const PatchMoments& with_grey,
                             const PatchMoments& with_weights) {
    const auto& rows = derivative[static_cast<std::size_t>(a)];
    const PatchMoments& g = with_grey;
    const PatchMoments& w = with_weights;
    set(rows[0], Index::kGain, g.one);
    set(rows[1], Index::kGain, g.u);
    set(rows[2], Index::kGain, g.v);
    const float sums[3][3] = {{w.one, w.u, w.v}, {w.u, w.uu, w.uv}, {w.v, w.uv, w.vv}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) set(rows[i], Index::kOffset + j, sums[i][j]);
    }
  };
  set_affine(0, 0, moments(basis.dx, basis.dx));
  set_affine(0, 1, moments(basis.dx, basis.dy));
  set_affine(1, 1, moments(basis.dy, basis.dy));
  set_light(0, moments(basis.dx, basis.grey), moments(basis.dx, weights));
  set_light(1, moments(basis.dy, basis.grey), moments(basis.dy, weights));
  set(Index::kGain, Index::kGain, moments(basis.grey, basis.grey).one);
  const PatchMoments grey = moments(basis.grey, weights);
  set(Index::kGain, Index::kOffset, grey.one);
  set(Index::kGain, Index::kRampU, grey.u);
  set(Index::kGain, Index::kRampV, grey.v);
  const PatchMoments geometry = moments(weights, weights);
  set(Index::kOffset, Index::kOffset, geometry.one);
  set(Index::kOffset, Index::kRampU, geometry.u);
  set(Index::kOffset, Index::kRampV, geometry.v);
  set(Index::kRampU, Index::kRampU, geometry.uu);
  set(Index::kRampU, Index::kRampV, geometry.uv);
  set(Index::kRampV, Index::kRampV, geometry.vv);
  return matrix;
}

PatchBasis::ShiftMatrix shift_normal_matrix(const PatchBasis& basis, const Patch& weights) {
  std::array<float, 21> sums;
  shift_sums(basis, weights.value.data(), sums.data());
  PatchBasis::ShiftMatrix matrix;
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      matrix(row, column) = matrix(column, row) = sums[next++];
    }
  }
  return matrix;
}

}  // namespace handeye
