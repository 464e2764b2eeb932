// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <Eigen/Core>

#include "drivers/dtrack/frame.hpp"

namespace handeye::dtrack {

/// The vendor's Euler angles (eta, theta, phi) [rad] of R = Rx(eta) * Ry(theta) * Rz(phi),
/// theta in [-pi/2, pi/2]. Where theta is +-pi/2 only eta +- phi is defined: eta is 0 there.
Eigen::Vector3d euler_angles_rad(const Eigen::Matrix3d& rotation);

/// Writes a frame as a controller sends it: fr, then ts, ts2, 6dcal, 6dcov and 3d where the frame
/// has them, and 6d always, with its tracked bodies only (`6d 0` without any). Lines end with CR
/// LF; positions %.3f mm, angles %.4f deg, matrices %.6f column by column, covariances %.3e,
/// seconds
/// %.6f; never by locale.
/// Numbers must be finite. Replaces the content of `datagram`, whose memory is reused.
void format_datagram(const Frame& frame, std::string& datagram);

}  // namespace handeye::dtrack
