// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/lens_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace handeye {
namespace {

/// Hand turns smaller than this say little of a ratio.
constexpr double kMinTurnRad = rad_from_deg(5.0);
constexpr std::size_t kFewestTurns = 20;
/// Pairs grow with the square of the poses; so many are plenty.
constexpr std::size_t kMaxPoses = 80;
constexpr double kMaxRotationExcess = 0.03;

/// The frames of `frames` that `wanted` has as well; both in order of time.
std::vector<RegisteredFrame> counterparts(std::span<const RegisteredFrame> frames,
                                          std::span<const RegisteredFrame> wanted) {
  std::vector<RegisteredFrame> found;
  for (const RegisteredFrame& one : wanted) {
    const auto frame = std::ranges::lower_bound(frames, one.index, {}, &RegisteredFrame::index);
    if (frame != frames.end() && frame->index == one.index) found.push_back(*frame);
  }
  return found;
}

/// Hand-eye from these frames, weighted as the estimate was in the end, nothing left out.
std::optional<HandEyeSolution> solve(std::span<const RegisteredFrame> frames,
                                     const Estimate& estimate, const PoseBuffer& hand) {
  MaximumLikelihoodOptions options = estimate.options;
  options.noise = estimate.likelihood->noise;
  options.estimate_noise = false;
  options.account_for_correlation = false;
  options.reject = 0;
  const auto observations = observe(frames, hand, estimate.time_offset_s);
  const auto solved = maximum_likelihood(observations, estimate.likelihood->solution, options);
  if (!solved) return std::nullopt;
  return solved->solution;
}

Vector6d difference(const Pose& from, const Pose& to) {
  Vector6d moved;
  moved << log_so3(to.linear() * from.linear().transpose()), to.translation() - from.translation();
  return moved;
}

}  // namespace

std::optional<Matrix6d> lens_covariance(const Reconstruction& reconstruction,
                                        const Estimate& estimate, const PoseBuffer& hand) {
  Matrix6d covariance = Matrix6d::Zero();
  if (reconstruction.lens.mode == IntrinsicsMode::kFixed) return covariance;
  const auto& shifted = reconstruction.lens.shifted_keyframes;
  // What was shifted is the largest part; of an answer from another it says nothing.
  if (shifted.empty() || !estimate.likelihood || estimate.likelihood->part != 0) return {};
  const auto nominal = solve(counterparts(reconstruction.frames, shifted.front()), estimate, hand);
  if (!nominal) return {};
  for (const std::vector<RegisteredFrame>& frames : shifted) {
    const auto moved = solve(frames, estimate, hand);
    if (!moved) return {};
    const Vector6d change = difference(nominal->hand_from_eye, moved->hand_from_eye);
    covariance += change * change.transpose();
  }
  return covariance;
}

std::optional<double> rotation_ratio(std::span<const HandEyeObservation> observations) {
  const std::size_t stride = observations.size() / kMaxPoses + 1;
  double products = 0.0;
  double squares = 0.0;
  std::size_t turns = 0;
  for (std::size_t i = 0; i < observations.size(); i += stride) {
    for (std::size_t j = i + stride; j < observations.size(); j += stride) {
      if (observations[i].part != observations[j].part) continue;
      const PosePair& a = observations[i].poses;
      const PosePair& b = observations[j].poses;
      const double hand_rad =
          rotation_angle_rad(a.room_from_hand.linear(), b.room_from_hand.linear());
      if (hand_rad < kMinTurnRad) continue;
      const double eye_rad =
          rotation_angle_rad(a.eye_from_scene.linear(), b.eye_from_scene.linear());
      products += eye_rad * hand_rad;
      squares += hand_rad * hand_rad;
      ++turns;
    }
  }
  if (turns < kFewestTurns) return std::nullopt;
  return products / squares;
}

bool hand_contradicts_lens(std::span<const HandEyeObservation> observations) {
  const auto ratio = rotation_ratio(observations);
  return ratio && std::abs(*ratio - 1.0) > kMaxRotationExcess;
}

}  // namespace handeye
