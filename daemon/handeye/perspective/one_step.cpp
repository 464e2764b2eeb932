// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/one_step.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "daemon/handeye/perspective/gauss_newton.hpp"
#include "daemon/handeye/perspective/outliers.hpp"
#include "daemon/handeye/perspective/planar_start.hpp"
#include "daemon/handeye/perspective/plausibility.hpp"

namespace handeye {
namespace {

SensorLens starting_lens(const Observations& observations, const PerspectiveOptions& options) {
  SensorLens lens{.pixel_mm = observations.pixel_mm};
  lens.centre_px = options.start.centre_px.value_or(
      Eigen::Vector2d(0.5 * (observations.width - 1), 0.5 * (observations.height - 1)));
  if (options.distortion_inside) lens.k1_per_mm2 = options.start.k1_per_mm2.value_or(0.0);
  return lens;
}

/// Lens, matrices and Y before the first step.
std::optional<PerspectiveState> starting_state(const Observations& observations,
                                               const PerspectiveOptions& options, bool planar) {
  PerspectiveState state;
  if (planar && options.start.matrices.empty()) {
    const auto zhang = planar_start(observations, options.distortion_inside);
    if (!zhang) return std::nullopt;
    state = *zhang;
  } else {
    state.lens = starting_lens(observations, options);
    state.matrices = options.start.matrices;
    if (state.matrices.empty()) {
      auto matrices = matrices_by_dlt(observations, state.lens);
      if (!matrices) return std::nullopt;
      state.matrices = std::move(*matrices);
    }
  }
  const auto closed_form =
      closed_form_object_from_hand(matrix_positions(observations, state.matrices));
  if (!closed_form && !options.start.object_from_hand) return std::nullopt;
  state.object_from_hand =
      options.start.object_from_hand ? *options.start.object_from_hand : *closed_form;
  return state;
}

/// The iteration of the case at hand; nothing when it diverges.
std::optional<GaussNewtonResult> iterate(const Observations& observations,
                                         const PerspectiveState& start, bool with_lens) {
  if (with_lens) return gauss_newton(observations, start);
  const auto found =
      matrix_method(matrix_positions(observations, start.matrices), start.object_from_hand);
  if (!found) return std::nullopt;
  GaussNewtonResult result{.state = start, .iterations = found->iterations};
  result.state.object_from_hand = found->object_from_hand;
  return result;
}

/// Camera and hand_from_eye from M_1 Y = K * eye_from_hand.
std::optional<RefinedCalibration> taken_apart(const PerspectiveState& state) {
  const PerspectiveMatrix product = state.matrices.front() * state.object_from_hand.matrix();
  const auto parts = decompose(product);
  if (!parts) return std::nullopt;
  const Eigen::Matrix3d& k = parts->intrinsics;
  const Eigen::Vector2d centre =
      state.lens.centre_px + Eigen::Vector2d(k(0, 2), k(1, 2)).cwiseQuotient(state.lens.pixel_mm);
  RefinedCalibration calibration{.object_from_hand = state.object_from_hand,
                                 .hand_from_eye = parts->eye_from_object.inverse()};
  calibration.camera = {k(0, 0) / state.lens.pixel_mm.x(), k(1, 1) / state.lens.pixel_mm.y(),
                        centre.x(), centre.y(), state.lens.k1_per_mm2};
  return calibration;
}

/// The pixel's width for which the lens is round: with one focal length in both directions.
Eigen::Vector2d pixel_of_round_lens(const PerspectiveCamera& camera,
                                    const Eigen::Vector2d& pixel_mm) {
  return {pixel_mm.y() * camera.fy / camera.fx, pixel_mm.y()};
}

/// Whether such a change of the pixel's width could be seen above the image noise.
bool matters(const Observations& observations, const RefinedCalibration& calibration,
             const Eigen::Vector2d& pixel_mm) {
  const double radius_mm = 0.5 * observations.height * observations.pixel_mm.y();
  const double change = std::abs(pixel_mm.x() / observations.pixel_mm.x() - 1.0);
  const double shift_mm =
      change * std::abs(calibration.camera.k1_per_mm2) * radius_mm * radius_mm * radius_mm;
  constexpr double kSame = 1e-12;
  return change > kSame && shift_mm > calibration.image_noise_px * pixel_mm.y();
}

/// A frame grabber samples lines at a rate of its own, so the pixel's width is often known by its
/// name only (Tsai's uncertainty factor). Where the images show that the lens is round with another
/// width, that one is taken; `observations` then carries it.
Refinement with_round_lens(Observations& observations, Refinement refinement) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector2d pixel_mm =
        pixel_of_round_lens(refinement.calibration.camera, observations.pixel_mm);
    if (!matters(observations, refinement.calibration, pixel_mm)) break;
    Observations other = observations;
    other.pixel_mm = pixel_mm;
    const auto found = refine(other, refinement.calibration, true);
    if (!found || !(found->calibration.reprojection_px < refinement.calibration.reprojection_px)) {
      break;
    }
    observations = std::move(other);
    refinement = *found;
  }
  return refinement;
}

/// An answer to all the points, good or bad, and their errors.
struct Attempt {
  PerspectiveCalibration calibration;
  std::vector<double> errors_px;
};

std::variant<Attempt, PerspectiveRefusal> attempt(const Observations& given,
                                                  const PerspectiveOptions& options) {
  Observations observations = given;
  if (auto refusal = lacking(observations)) return *refusal;
  const bool planar = observations.planar();
  const auto start = starting_state(observations, options, planar);
  if (!start) return not_determined();

  PerspectiveCalibration calibration;
  PerspectiveState state = *start;
  if (const auto found = iterate(observations, *start, options.distortion_inside && !planar)) {
    state = found->state;
    calibration.iterations = found->iterations;
    calibration.matrix_object_from_hand = state.object_from_hand;
    calibration.matrices = state.matrices;
  } else if (options.start.object_from_hand || !options.start.matrices.empty()) {
    return PerspectiveRefusal{"no_convergence",
                              "Gauss-Newton does not converge from the start given: leave it out"};
  }
  const auto parts = taken_apart(state);
  if (!parts) {
    return PerspectiveRefusal{"inconsistent",
                              "no camera makes these images: do u and v run right and down, and is "
                              "the object's frame right-handed?"};
  }
  if (!can_begin(observations, *parts, options.distortion_inside)) {
    return PerspectiveRefusal{
        "inconsistent",
        "points would lie behind the camera or off its lens: are object and "
        "hand both in mm, hand1_from_hand not its inverse, and no points mixed up?"};
  }
  auto refinement = refine(observations, *parts, options.distortion_inside);
  if (!refinement) return not_determined();
  if (options.distortion_inside) {
    refinement = with_round_lens(observations, std::move(*refinement));
  }
  if (auto refusal = doubtful(observations, *refinement)) return *refusal;
  calibration.refined = refinement->calibration;
  calibration.sigma = refinement->sigma;
  calibration.pixel_mm = observations.pixel_mm;
  return Attempt{std::move(calibration), std::move(refinement->errors_px)};
}

/// Leaves out the points at places among those of `rest`; `left_out` and `places` count among all
/// the points there ever were, `places` of those that are left.
void leave_out(const std::vector<std::size_t>& gross, Observations& rest,
               std::vector<std::size_t>& places, std::vector<std::size_t>& left_out) {
  rest = without_points(rest, gross);
  for (auto place = gross.rbegin(); place != gross.rend(); ++place) {
    const auto at = places.begin() + static_cast<std::ptrdiff_t>(*place);
    left_out.push_back(*at);
    places.erase(at);
  }
  std::ranges::sort(left_out);
}

}  // namespace

std::variant<PerspectiveCalibration, PerspectiveRefusal> calibrate_perspective(
    const Observations& observations, const PerspectiveOptions& options) {
  Observations rest = observations;
  std::vector<std::size_t> places(observations.point_count());
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::vector<std::size_t> left_out;
  while (true) {
    auto found = attempt(rest, options);
    if (auto* refusal = std::get_if<PerspectiveRefusal>(&found)) return std::move(*refusal);
    auto& [calibration, errors_px] = std::get<Attempt>(found);
    const std::vector<std::size_t> gross = gross_outliers(rest, errors_px);
    if (gross.empty()) {
      calibration.left_out = std::move(left_out);
      return std::move(calibration);
    }
    leave_out(gross, rest, places, left_out);
  }
}

}  // namespace handeye
