// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/head_turn.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

constexpr double kTakes_s = 0.5;
constexpr double kLargest_deg = 180.0;

constexpr std::array<std::pair<HeadTurn::About, std::string_view>, 3> kNames{{
    {HeadTurn::About::kRoll, "roll"},
    {HeadTurn::About::kTilt, "tilt"},
    {HeadTurn::About::kTurn, "turn"},
}};

[[noreturn]] void refuse(std::string_view text) {
  throw UsageError(fmt::format(
      "head turn '{}': write SECONDS:DEG[:roll|tilt|turn], SECONDS from 0, DEG from -180 to 180",
      text));
}

double number_in(std::string_view number, std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (error != std::errc() || end != number.data() + number.size()) refuse(text);
  return value;
}

Eigen::Vector3d axis_of(HeadTurn::About about) {
  switch (about) {
    case HeadTurn::About::kTilt:
      return Eigen::Vector3d::UnitX();
    case HeadTurn::About::kTurn:
      return Eigen::Vector3d::UnitY();
    case HeadTurn::About::kRoll:
      break;
  }
  return Eigen::Vector3d::UnitZ();
}

}  // namespace

HeadTurn parse_head_turn(std::string_view text) {
  const std::size_t first = text.find(':');
  if (first == std::string_view::npos) refuse(text);
  const std::size_t second = text.find(':', first + 1);
  HeadTurn turn;
  turn.at_s = number_in(text.substr(0, first), text);
  turn.deg = number_in(text.substr(first + 1, second - first - 1), text);
  if (!(turn.at_s >= 0) || !(std::abs(turn.deg) <= kLargest_deg)) refuse(text);
  if (second == std::string_view::npos) return turn;
  const auto* const named =
      std::ranges::find(kNames, text.substr(second + 1), [](const auto& n) { return n.second; });
  if (named == kNames.end()) refuse(text);
  turn.about = named->first;
  return turn;
}

std::string spelling(const HeadTurn& turn) {
  const auto* const named =
      std::ranges::find(kNames, turn.about, [](const auto& n) { return n.first; });
  return fmt::format("{}:{}:{}", turn.at_s, turn.deg, named->second);
}

Pose old_eye_from_eye(const HeadTurn& turn, double time_s) {
  const double done = std::clamp((time_s - turn.at_s) / kTakes_s, 0.0, 1.0);
  const double eased = done * done * (3 - 2 * done);
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(eased * rad_from_deg(turn.deg) * axis_of(turn.about));
  return pose;
}

}  // namespace handeye::simulator
