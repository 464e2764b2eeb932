// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

/// Caps on what a datagram may claim. All lie far above what any installation sends; they only tell
/// nonsense from data, for nothing is ever allocated by a claimed number.
namespace handeye::dtrack {

inline constexpr std::int32_t kMaxId = 9'999;              ///< bodies, devices, hands, joints
inline constexpr std::int32_t kMaxMarkerId = 999'999'999;  ///< a lost marker returns with a new id
inline constexpr std::int32_t kMaxCount = 9'999;           ///< targets a line, calibrated bodies
inline constexpr std::int32_t kMaxButtons = 256;           ///< a Flystick or tool
inline constexpr std::int32_t kMaxJoysticks = 64;          ///< analog values of a Flystick
inline constexpr std::int32_t kMaxJoints = 200;            ///< a human model
inline constexpr std::int32_t kMaxCameras = 999;           ///< in the system status

/// Largest element of |R'R - I| of a rotation as printed; finger blocks have 4e-4 of round-off.
inline constexpr double kRotationTolerance = 1e-3;

}  // namespace handeye::dtrack
