// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/verdict.hpp"

namespace handeye {

Reason reason_to_refuse(const Evidence& evidence) {
  if (evidence.frames_received == 0) return Reason::kCameraLost;
  return Reason::kUncertain;
}

}  // namespace handeye
