// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "client/cli/terminal.hpp"
#include "daemon/session/result.hpp"

namespace handeye::cli {

/// A result for a person: verdict, estimate with its uncertainty, the methods side by side, what it
/// rests on. Several lines, the last with its newline. A refused estimate is marked as such.
std::string result_text(const CalibrationResult& result, const Palette& palette);

}  // namespace handeye::cli
