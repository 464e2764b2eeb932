// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace handeye {

/// What every program of this project returns to the shell. Scripts rely on these.
enum class ExitCode : int {
  kOk = 0,        ///< accepted, or simply done
  kUsage = 1,     ///< wrong command line, or a mistake in the configuration
  kInput = 2,     ///< input or connection: unreadable file, port in use, no STATUS heard
  kRefused = 3,   ///< the calibration was refused or cancelled; the reason is in the result
  kTimedOut = 4,  ///< no answer in time although the daemon had acknowledged
};

/// A mistake of the caller: command line or configuration. Ends a program with ExitCode::kUsage.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Input that cannot be used, or a connection that cannot be had. Ends a program with
/// ExitCode::kInput. The text is one line that names what, where, and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace handeye
