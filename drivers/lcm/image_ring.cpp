// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lcm/image_ring.hpp"

namespace handeye {

bool ImageRing::push(const image_t& message, std::int64_t arrival_ns) {
  const bool full = size_ == slots_.size();
  if (full) pop();
  ReceivedImage& slot = slots_[(first_ + size_) % slots_.size()];
  slot.message = message;
  slot.arrival_ns = arrival_ns;
  ++size_;
  return !full;
}

void ImageRing::pop() {
  first_ = (first_ + 1) % slots_.size();
  --size_;
}

}  // namespace handeye
