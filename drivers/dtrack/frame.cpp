// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/frame.hpp"

#include <algorithm>

namespace handeye::dtrack {

const Body* Frame::find_body(std::int32_t id) const {
  const auto found = std::ranges::find(bodies, id, &Body::id);
  return found == bodies.end() ? nullptr : &*found;
}

}  // namespace handeye::dtrack
