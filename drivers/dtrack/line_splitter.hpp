// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <string_view>

namespace handeye::dtrack {

/// Cuts a datagram into its lines. CR, LF or both end a line; blank ones are passed over; the last
/// one needs no end.
class LineSplitter {
 public:
  explicit LineSplitter(std::string_view datagram)
      : at_(datagram.data()),
        end_(datagram.data() + datagram.size()),
        line_feed_(find('\n', end_)) {}

  /// False when there is no further line.
  bool next(std::string_view& line) {
    while (at_ != end_) {
      if (line_feed_ < at_) line_feed_ = find('\n', end_);
      const char* const line_end = find('\r', line_feed_);
      line = {at_, line_end};
      at_ = line_end == end_ ? end_ : line_end + 1;
      if (!line.empty()) return true;
    }
    return false;
  }

 private:
  const char* find(char character, const char* limit) const {
    const auto length = static_cast<std::size_t>(limit - at_);
    if (length == 0) return limit;
    const void* const found = std::memchr(at_, character, length);
    return found ? static_cast<const char*>(found) : limit;
  }

  const char* at_;
  const char* end_;
  const char* line_feed_;  ///< the next one at or behind at_, looked for once only
};

}  // namespace handeye::dtrack
