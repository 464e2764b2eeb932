// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/line_context.hpp"

#include <algorithm>

namespace handeye::dtrack {
namespace {

/// Backwards: the pools are stacks, so each element gets its own memory back in the next frame.
template <typename Element>
void release_all(std::vector<Element>& elements, LineMemory& memory) {
  std::for_each(elements.rbegin(), elements.rend(),
                [&](Element& element) { release(element, memory); });
  elements.clear();
}

}  // namespace

void reset(Frame& frame, LineMemory& memory) {
  frame.number = 0;
  frame.seconds_of_day.reset();
  frame.unix_time.reset();
  frame.calibrated_bodies.reset();
  frame.calibrated_hands.reset();
  frame.bodies.clear();
  frame.covariances.clear();
  release_all(frame.flysticks, memory);
  release_all(frame.tools, memory);
  frame.tool_references.clear();
  frame.markers.clear();
  release_all(frame.hands, memory);
  release_all(frame.humans, memory);
  if (frame.system_status) release(*frame.system_status, memory);
  frame.system_status.reset();
  memory.hybrid_bodies.clear();
}

}  // namespace handeye::dtrack
