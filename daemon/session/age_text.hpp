// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace handeye {

/// How old something is, for a person: "12 s old", "3 h 5 min old", "12 days old"; "of unknown
/// age" where nobody knows.
std::string age_text(const std::optional<double>& age_s);

}  // namespace handeye
