// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>

/// Eight lanes at a time through the compiler's vectors: two SSE2 or NEON registers, or one of AVX2
/// where the processor has it (HANDEYE_VECTOR_CLONES). Sums run in the same lanes in the same order
/// either way, and AVX2 without FMA rounds like SSE2: the results are the same bit for bit.
namespace handeye::lanes {

inline constexpr int kLanes = 8;

using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Short8 = std::int16_t __attribute__((vector_size(16)));

// Sanitizers instrument the resolver that picks a clone, which runs before they are ready.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define HANDEYE_VECTOR_CLONES __attribute__((target_clones("default", "avx2")))
#else
#define HANDEYE_VECTOR_CLONES
#endif

// Inlined into each clone, or they would be compiled for the baseline alone.
#define HANDEYE_LANES_INLINE [[gnu::always_inline]] inline

HANDEYE_LANES_INLINE Float8 load(const float* from) {
  Float8 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

HANDEYE_LANES_INLINE Float8 load(const std::int16_t* from) {
  Short8 shorts;
  std::memcpy(&shorts, from, sizeof shorts);
  return __builtin_convertvector(shorts, Float8);
}

HANDEYE_LANES_INLINE void store(const Float8& lanes, float* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

HANDEYE_LANES_INLINE Float8 all(float value) {
  return Float8{} + value;
}

HANDEYE_LANES_INLINE float sum(const Float8& lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
         ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

}  // namespace handeye::lanes
