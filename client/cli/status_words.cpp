// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/status_words.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

namespace handeye::cli {
namespace {

// The protocol's constants count from 0.
constexpr std::array<std::string_view, 6> kSessionStates{"idle", "collecting", "solving",
                                                         "done", "refused",    "cancelled"};
constexpr std::array<std::string_view, 5> kDeviceStates{"absent", "waiting", "streaming", "silent",
                                                        "failed"};
constexpr std::array<std::string_view, 4> kClockStates{"absent", "settling", "steady", "unstable"};
constexpr std::array<std::string_view, 5> kWatchStates{"off", "unchecked", "holds", "doubtful",
                                                       "broken"};
constexpr std::array<std::string_view, 17> kGuides{"none",
                                                   "no_image",
                                                   "hand_hidden",
                                                   "image_unusable",
                                                   "too_dark",
                                                   "frozen",
                                                   "too_bright",
                                                   "slower",
                                                   "little_to_see",
                                                   "show_board",
                                                   "whole_board",
                                                   "tilt_up_and_down",
                                                   "turn_left_and_right",
                                                   "roll",
                                                   "slide_in_and_out",
                                                   "slide_sideways",
                                                   "keep_moving"};

static_assert(kSessionStates[status_t::CANCELLED] == "cancelled");
static_assert(kDeviceStates[device_status_t::FAILED] == "failed");
static_assert(kClockStates[clock_status_t::UNSTABLE] == "unstable");
static_assert(kWatchStates[status_t::WATCH_BROKEN] == "broken");
static_assert(kGuides[status_t::GUIDE_WHOLE_BOARD] == "whole_board");
static_assert(kGuides[status_t::GUIDE_KEEP_MOVING] == "keep_moving");

template <std::size_t N>
std::string word_of(const std::array<std::string_view, N>& words, std::int32_t code,
                    std::string_view kind) {
  if (code < 0 || static_cast<std::size_t>(code) >= N) return fmt::format("{} {}", kind, code);
  return std::string(words[static_cast<std::size_t>(code)]);
}

}  // namespace

std::string session_state_word(std::int32_t state) {
  return word_of(kSessionStates, state, "state");
}

std::string device_state_word(std::int32_t state) {
  return word_of(kDeviceStates, state, "state");
}

std::string clock_state_word(std::int32_t state) {
  return word_of(kClockStates, state, "state");
}

std::string watch_state_word(std::int32_t state) {
  return word_of(kWatchStates, state, "state");
}

std::string guide_word(std::int32_t code) {
  return word_of(kGuides, code, "guide");
}

}  // namespace handeye::cli
