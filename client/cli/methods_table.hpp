// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace handeye::cli {

/// Every hand-eye method: name, for which scale, source; a line each under a head line, without
/// the last newline. The program's list and the table in docs/methods.md are this text.
std::string methods_table();

/// Names only, for a help text: "a, b, c".
std::string method_names();

}  // namespace handeye::cli
