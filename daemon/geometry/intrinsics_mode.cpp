// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/intrinsics_mode.hpp"

#include <algorithm>
#include <array>

namespace handeye {
namespace {

struct Word {
  IntrinsicsMode mode;
  std::string_view word;
};

constexpr std::array kWords{Word{IntrinsicsMode::kFixed, "fixed"},
                            Word{IntrinsicsMode::kRefine, "refine"},
                            Word{IntrinsicsMode::kEstimate, "estimate"}};

}  // namespace

std::optional<CameraModel> known_lens(const CameraModel& camera, IntrinsicsMode mode) {
  if (mode == IntrinsicsMode::kEstimate) return std::nullopt;
  return camera;
}

std::string_view intrinsics_word(IntrinsicsMode mode) {
  return std::ranges::find(kWords, mode, &Word::mode)->word;
}

std::optional<IntrinsicsMode> intrinsics_from_word(std::string_view word) {
  const auto* const found = std::ranges::find(kWords, word, &Word::word);
  if (found == kWords.end()) return std::nullopt;
  return found->mode;
}

}  // namespace handeye
