// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/geometry/pose.hpp"
#include "drivers/dtrack/frame.hpp"

namespace handeye {

/// What the tracker says of its own uncertainty (line 6dcov), as the mathematics wants it: of
/// (w [rad], dt [mm]) in the room, R = Exp(w) R_measured, t = t_measured + dt, t the body's origin.
///
/// The line tells of a reference point p = R b + t, b fixed to the body, and of the Euler angles in
/// R = Rx(eta) Ry(theta) Rz(phi); to first order w = e_x d_eta + Rx e_y d_theta + Rx Ry e_z d_phi
/// and dt = dp - w x (p - t).
///
/// Nothing where it cannot be meant: not positive semi-definite beyond the rounding of the printed
/// digits, a standard deviation below 1e-4 mm or 1e-7 rad or above 100 mm or 0.5 rad, or a
/// reference point beyond 2 m from the origin.
std::optional<Eigen::Matrix<float, 6, 6>> covariance_of_body(const dtrack::BodyCovariance& said,
                                                             const Pose& room_from_body);

}  // namespace handeye
