// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <handeye/image_t.hpp>

namespace handeye {

/// An image as it came in.
struct ReceivedImage {
  std::int64_t arrival_ns{0};  ///< host CLOCK_MONOTONIC
  image_t message;
};

/// The images that wait to be taken, oldest first. Bounded: a full ring gives up its oldest image,
/// for what is late is worth less than what is new. Its slots keep their memory.
class ImageRing {
 public:
  explicit ImageRing(std::size_t capacity) : slots_(capacity) {}

  /// Copies the image behind the others. False: the oldest had to go for it.
  bool push(const image_t& message, std::int64_t arrival_ns);

  /// The oldest image, valid until it is popped or pushed out; nullptr: none waits.
  const ReceivedImage* front() const { return size_ == 0 ? nullptr : &slots_[first_]; }

  /// Forgets the oldest image. Only when there is one.
  void pop();

  void clear() { size_ = 0; }

 private:
  std::vector<ReceivedImage> slots_;
  std::size_t first_{0};
  std::size_t size_{0};
};

}  // namespace handeye
