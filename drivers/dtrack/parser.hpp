// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "drivers/dtrack/frame.hpp"
#include "drivers/dtrack/line_context.hpp"
#include "drivers/dtrack/parse_report.hpp"

namespace handeye::dtrack {

/// Parses DTrack datagrams: line types fr ts ts2 6dcal 6d 6di 6dcov 6df 6df2 6dmt 6dmt2 6dmtr 3d gl
/// glcal 6dj st; others are skipped.
///
/// A line is read only inside its own bytes and published wholly or not at all, so a bad line never
/// touches another. Only a body whose matrix is no rotation is dropped alone. Every refusal is
/// counted by its kind. Numbers do not depend on the locale.
///
/// A published rotation is the printed one with its round-off removed (nearest rotation). A target
/// of quality below 0 is not tracked: where the list has `tracked` that is false and the pose the
/// identity, otherwise it is left out. Where 6d and 6di list the same body, the pose is 6d's and
/// the inertial state 6di's.
///
/// Reuse one parser and one frame: once both have seen the largest datagram nothing is allocated.
/// Caps on ids and counts: limits.hpp. Wire format: the vendor's ASCII output of DTrack 1 to 3.
class Parser {
 public:
  /// Overwrites `frame` with what `datagram` (0..65507 bytes) says; empty if it is rejected.
  ParseStatus parse(std::string_view datagram, Frame& frame);

  const ParseCounters& counters() const { return counters_; }

 private:
  ParseStatus reject(ErrorKind error, Frame& frame);
  void read_line(std::string_view identifier, std::string_view payload, LineContext& context);

  ParseCounters counters_;
  LineMemory memory_;
};

}  // namespace handeye::dtrack
