// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye::cli {

/// Counts one channel's messages and, by the gaps in their numbers, the ones that got lost on LCM.
class StreamCounter {
 public:
  /// session_id and seq of a message. A sender that starts anew is no loss.
  void take(std::int64_t session_id, std::int64_t seq) {
    if (received_ > 0 && session_id == session_id_ && seq > next_seq_) lost_ += seq - next_seq_;
    session_id_ = session_id;
    next_seq_ = seq + 1;
    ++received_;
  }

  std::int64_t received() const { return received_; }
  std::int64_t lost() const { return lost_; }

 private:
  std::int64_t session_id_{0};
  std::int64_t next_seq_{0};
  std::int64_t received_{0};
  std::int64_t lost_{0};
};

}  // namespace handeye::cli
