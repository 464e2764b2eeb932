// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/estimate.hpp"

namespace handeye {

/// What a lens that is not exactly known adds to the covariance of hand_from_eye, of (w [rad],
/// dt [mm]) as there. An error of the lens moves all poses of the eye together, which their
/// residuals do not show. So hand-eye is solved again with the keyframes as they would be with the
/// lens off by one standard deviation, along each of its principal directions; the outer products
/// of what the answer moves by add up. Zero where the lens was given; nothing where it was not and
/// what it adds is not known.
std::optional<Matrix6d> lens_covariance(const Reconstruction& reconstruction,
                                        const Estimate& estimate, const PoseBuffer& hand);

/// How far the eye turns for each degree that the hand turns: 1, whatever hand_from_eye is, unless
/// the lens is wrong. Nothing where the hand hardly turns.
std::optional<double> rotation_ratio(std::span<const HandEyeObservation> observations);

/// Whether that ratio is so far from 1 that the lens must be wrong: as a focal length is off, so is
/// the ratio, about.
bool hand_contradicts_lens(std::span<const HandEyeObservation> observations);

}  // namespace handeye
