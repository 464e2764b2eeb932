// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/session/result.hpp"

/// What scenes that are tried have in common, whatever is the matter with them.
namespace handeye::trial {

/// Applied to a simulator's options or to its world.
template <typename Subject>
struct SceneOf {
  std::string_view name;
  void (*apply)(Subject& subject);
  std::vector<Reason> reasons;  ///< for which it is, or may be, refused
};

/// Throws std::out_of_range for an unknown name.
template <typename Subject>
const SceneOf<Subject>& scene_named(std::string_view name,
                                    std::span<const SceneOf<Subject>> scenes) {
  const auto found = std::ranges::find(scenes, name, &SceneOf<Subject>::name);
  if (found == scenes.end()) throw std::out_of_range("no scene " + std::string(name));
  return *found;
}

/// What was answered, against the truth.
struct Trial {
  CalibrationResult result;
  double rotation_error_deg{0};
  double translation_error_mm{0};

  bool accepted() const { return result.verdict == Verdict::kAccepted; }
  bool refused_for_any(const std::vector<Reason>& reasons) const {
    return !accepted() && std::ranges::find(reasons, result.reason) != reasons.end();
  }
  /// Of both errors the larger, in the sigma that was claimed for it.
  double error_in_sigmas() const;
  /// Within 3.5 of its own sigmas.
  bool is_honest() const;
};

/// The errors stay 0 where there is no estimate.
Trial against(const Pose& true_hand_from_eye, CalibrationResult result);

/// One line: verdict, reason, what was missing, errors and sigmas, frames.
std::string describe(const Trial& trial);

}  // namespace handeye::trial
