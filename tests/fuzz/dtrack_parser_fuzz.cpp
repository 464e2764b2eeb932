// SPDX-License-Identifier: BSD-3-Clause
// Any bytes whatever: no crash, no read outside them, and what is published keeps its promises.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "drivers/dtrack/parser.hpp"

namespace {

using handeye::Pose;
using handeye::dtrack::Frame;
using handeye::dtrack::Parser;
using handeye::dtrack::ParseStatus;

void demand(bool promise) {
  if (!promise) std::abort();
}

void check_pose(const Pose& pose) {
  const Eigen::Matrix3d gram = pose.linear().transpose() * pose.linear();
  demand(pose.matrix().allFinite() && (gram - Eigen::Matrix3d::Identity()).norm() < 1e-5);
}

template <typename Element>
void check_ids(const std::vector<Element>& list) {
  if (list.size() > 100) return;  // quadratic
  for (std::size_t i = 0; i < list.size(); ++i) {
    demand(list[i].id >= 0);
    for (std::size_t k = 0; k < i; ++k) demand(list[i].id != list[k].id);
  }
}

void check(const Frame& frame) {
  for (const auto& body : frame.bodies) check_pose(body.room_from_body);
  for (const auto& flystick : frame.flysticks) check_pose(flystick.room_from_body);
  for (const auto& tool : frame.tools) check_pose(tool.room_from_tool);
  for (const auto& reference : frame.tool_references) check_pose(reference.room_from_reference);
  for (const auto& hand : frame.hands) check_pose(hand.room_from_hand_back);
  for (const auto& human : frame.humans) check_ids(human.joints);
  for (const auto& body : frame.covariances) demand(frame.find_body(body.id) != nullptr);
  check_ids(frame.bodies);
  check_ids(frame.flysticks);
  check_ids(frame.tools);
  check_ids(frame.markers);
  check_ids(frame.hands);
  check_ids(frame.humans);
  demand(!frame.calibrated_bodies || *frame.calibrated_bodies >= 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Parser parser;
  static Frame frame;
  const std::string_view datagram(reinterpret_cast<const char*>(data), size);
  const ParseStatus status = parser.parse(datagram, frame);
  check(frame);
  demand(status != ParseStatus::kRejected || frame.bodies.empty());
  demand(parser.parse(datagram, frame) == status);
  return 0;
}
