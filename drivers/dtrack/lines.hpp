// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "drivers/dtrack/line_context.hpp"
#include "drivers/dtrack/scanner.hpp"

/// The readers of all line types but `fr`. Each gets the payload behind the identifier and its
/// blank, and either publishes the whole line in the frame or returns false and leaves the frame
/// alone. The layout of each line is in the vendor's manual, appendix "Output".
namespace handeye::dtrack {

using LineReader = bool (*)(Scanner& line, LineContext& context);

// Scalars.
bool read_ts(Scanner& line, LineContext& context);
bool read_ts2(Scanner& line, LineContext& context);
bool read_6dcal(Scanner& line, LineContext& context);
bool read_glcal(Scanner& line, LineContext& context);
// Bodies.
bool read_6d(Scanner& line, LineContext& context);
bool read_6di(Scanner& line, LineContext& context);
bool read_6dcov(Scanner& line, LineContext& context);
// Devices.
bool read_6df(Scanner& line, LineContext& context);
bool read_6df2(Scanner& line, LineContext& context);
bool read_6dmt(Scanner& line, LineContext& context);
bool read_6dmt2(Scanner& line, LineContext& context);
bool read_6dmtr(Scanner& line, LineContext& context);
bool read_3d(Scanner& line, LineContext& context);
// People.
bool read_gl(Scanner& line, LineContext& context);
bool read_6dj(Scanner& line, LineContext& context);
// The system.
bool read_st(Scanner& line, LineContext& context);

/// A line type: how to read it and which part of the frame it fills. The old and the new format of
/// a device fill the same part, so of both in one datagram the last wins like of any line sent
/// twice.
struct LineType {
  LineReader read{nullptr};  ///< null: not known
  int part{0};               ///< 0..31
};

/// By the whole identifier; case matters.
LineType find_line_type(std::string_view identifier);

/// Brings the lines of a datagram together, whatever their order: covariances without a body of
/// line 6d go, hybrid bodies join the others, old-format devices come off the calibrated bodies.
void settle_lines(LineContext& context);

}  // namespace handeye::dtrack
