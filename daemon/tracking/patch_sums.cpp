// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/patch_sums.hpp"

#include <algorithm>

#include "daemon/tracking/vector_lanes.hpp"

namespace handeye {
namespace {

using lanes::Float8;

constexpr int kBlocks = Patch::kStride / lanes::kLanes;
constexpr auto kRadius = static_cast<float>(Patch::kRadius);

HANDEYE_LANES_INLINE Float8 u_of(int block) {
  const Float8 lane{0, 1, 2, 3, 4, 5, 6, 7};
  return (lane + (static_cast<float>(block * lanes::kLanes) - kRadius)) / kRadius;
}

HANDEYE_LANES_INLINE float v_of(int row) {
  return (static_cast<float>(row) - kRadius) / kRadius;
}

}  // namespace

HANDEYE_VECTOR_CLONES
void take_patch(const std::int16_t* pixels, std::ptrdiff_t stride, const float* whole, float* grey,
                float* dx, float* dy) {
  Float8 total{};
  for (int row = 0; row < Patch::kSide; ++row) {
    for (int block = 0; block < kBlocks; ++block) {
      const int at = row * Patch::kStride + block * lanes::kLanes;
      const std::int16_t* from = pixels + row * stride + block * lanes::kLanes;
      const Float8 inside = lanes::load(whole + at);
      const Float8 value = inside * lanes::load(from);
      lanes::store(value, grey + at);
      lanes::store(inside * 0.5F * (lanes::load(from + 1) - lanes::load(from - 1)), dx + at);
      lanes::store(inside * 0.5F * (lanes::load(from + stride) - lanes::load(from - stride)),
                   dy + at);
      total += value;
    }
  }
  const Float8 mean = lanes::all(lanes::sum(total) / static_cast<float>(Patch::kPixels));
  for (int at = 0; at < Patch::kSide * Patch::kStride; at += lanes::kLanes) {
    lanes::store(lanes::load(grey + at) - mean * lanes::load(whole + at), grey + at);
  }
}

HANDEYE_VECTOR_CLONES
void weigh_less(float constant, const float* weights, float* values) {
  for (int at = 0; at < Patch::kSide * Patch::kStride; at += lanes::kLanes) {
    lanes::store((lanes::load(values + at) - constant) * lanes::load(weights + at), values + at);
  }
}

HANDEYE_VECTOR_CLONES
float weighted_mean(const float* image, const float* weights) {
  Float8 total{};
  Float8 count{};
  for (int at = 0; at < Patch::kSide * Patch::kStride; at += lanes::kLanes) {
    const Float8 weight = lanes::load(weights + at);
    total += weight * lanes::load(image + at);
    count += weight;
  }
  return lanes::sum(total) / std::max(lanes::sum(count), 1.0F);
}

HANDEYE_VECTOR_CLONES
void product_sums(const float* image, const PatchBasis& basis, const float* weights, float mean,
                  float* sums) {
  Float8 dx{}, udx{}, vdx{}, dy{}, udy{}, vdy{}, gain{}, offset{}, ramp_u{}, ramp_v{}, self{};
  for (int row = 0; row < Patch::kSide; ++row) {
    Float8 row_dx{}, row_dy{}, row_offset{};
    for (int block = 0; block < kBlocks; ++block) {
      const int at = row * Patch::kStride + block * lanes::kLanes;
      const Float8 u = u_of(block);
      const Float8 value = lanes::load(weights + at) * (lanes::load(image + at) - mean);
      const Float8 with_dx = value * lanes::load(basis.dx.value.data() + at);
      const Float8 with_dy = value * lanes::load(basis.dy.value.data() + at);
      gain += value * lanes::load(basis.grey.value.data() + at);
      self += value * value;
      row_dx += with_dx;
      udx += u * with_dx;
      row_dy += with_dy;
      udy += u * with_dy;
      row_offset += value;
      ramp_u += u * value;
    }
    const float v = v_of(row);
    dx += row_dx;
    vdx += v * row_dx;
    dy += row_dy;
    vdy += v * row_dy;
    offset += row_offset;
    ramp_v += v * row_offset;
  }
  sums[PatchBasis::kDx] = lanes::sum(dx);
  sums[PatchBasis::kDy] = lanes::sum(dy);
  sums[PatchBasis::kUDx] = lanes::sum(udx);
  sums[PatchBasis::kVDx] = lanes::sum(vdx);
  sums[PatchBasis::kUDy] = lanes::sum(udy);
  sums[PatchBasis::kVDy] = lanes::sum(vdy);
  sums[PatchBasis::kGain] = lanes::sum(gain);
  sums[PatchBasis::kOffset] = lanes::sum(offset);
  sums[PatchBasis::kRampU] = lanes::sum(ramp_u);
  sums[PatchBasis::kRampV] = lanes::sum(ramp_v);
  sums[PatchBasis::kCount] = lanes::sum(self);
}

HANDEYE_VECTOR_CLONES
void moments_of(const float* a, const float* b, PatchMoments& moments) {
  Float8 one{}, u{}, v{}, uu{}, uv{}, vv{};
  for (int row = 0; row < Patch::kSide; ++row) {
    Float8 row_one{}, row_u{};
    for (int block = 0; block < kBlocks; ++block) {
      const int at = row * Patch::kStride + block * lanes::kLanes;
      const Float8 along = u_of(block);
      const Float8 product = lanes::load(a + at) * lanes::load(b + at);
      const Float8 product_u = along * product;
      row_one += product;
      row_u += product_u;
      uu += along * product_u;
    }
    const float down = v_of(row);
    one += row_one;
    u += row_u;
    v += down * row_one;
    uv += down * row_u;
    vv += (down * down) * row_one;
  }
  moments = {lanes::sum(one), lanes::sum(u),  lanes::sum(v),
             lanes::sum(uu),  lanes::sum(uv), lanes::sum(vv)};
}

HANDEYE_VECTOR_CLONES
void shift_sums(const PatchBasis& basis, const float* weights, float* sums) {
  Float8 xx{}, xy{}, xt{}, x1{}, xu{}, xv{}, yy{}, yt{}, y1{}, yu{}, yv{}, tt{}, t1{}, tu{}, tv{},
      one{}, u1{}, v1{}, uu{}, uv{}, vv{};
  for (int row = 0; row < Patch::kSide; ++row) {
    Float8 row_x{}, row_y{}, row_t{}, row_1{}, row_u{};
    for (int block = 0; block < kBlocks; ++block) {
      const int at = row * Patch::kStride + block * lanes::kLanes;
      const Float8 u = u_of(block);
      const Float8 weight = lanes::load(weights + at);
      const Float8 dx = lanes::load(basis.dx.value.data() + at);
      const Float8 dy = lanes::load(basis.dy.value.data() + at);
      const Float8 grey = lanes::load(basis.grey.value.data() + at);
      xx += dx * dx;
      xy += dx * dy;
      xt += dx * grey;
      xu += u * dx;
      yy += dy * dy;
      yt += dy * grey;
      yu += u * dy;
      tt += grey * grey;
      tu += u * grey;
      row_x += dx;
      row_y += dy;
      row_t += grey;
      row_1 += weight;
      row_u += u * weight;
      uu += u * u * weight;
    }
    const float v = v_of(row);
    x1 += row_x;
    xv += v * row_x;
    y1 += row_y;
    yv += v * row_y;
    t1 += row_t;
    tv += v * row_t;
    one += row_1;
    v1 += v * row_1;
    vv += (v * v) * row_1;
    u1 += row_u;
    uv += v * row_u;
  }
  const Float8* const all[21] = {&xx, &xy, &xt, &x1, &xu,  &xv, &yy, &yt, &y1, &yu, &yv,
                                 &tt, &t1, &tu, &tv, &one, &u1, &v1, &uu, &uv, &vv};
  for (int i = 0; i < 21; ++i) sums[i] = lanes::sum(*all[i]);
}

}  // namespace handeye
