// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <handeye/clock_status_t.hpp>
#include <handeye/device_status_t.hpp>
#include <handeye/status_t.hpp>

namespace handeye::cli {

// The codes of STATUS in words, the same for people and for programs; "state 17" for one that this
// version does not know.

/// "idle", "collecting", ...
std::string session_state_word(std::int32_t state);

/// "absent", "waiting", "streaming", "silent", "failed".
std::string device_state_word(std::int32_t state);

/// "absent", "settling", "steady", "unstable".
std::string clock_state_word(std::int32_t state);

/// "off", "unchecked", "holds", "doubtful", "broken".
std::string watch_state_word(std::int32_t state);

/// "none", "hand_hidden", "tilt_up_and_down", ...
std::string guide_word(std::int32_t code);

}  // namespace handeye::cli
