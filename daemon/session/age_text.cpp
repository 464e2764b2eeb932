// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/age_text.hpp"

#include <cstdint>

#include <fmt/format.h>

namespace handeye {

std::string age_text(const std::optional<double>& age_s) {
  if (!age_s) return "of unknown age";
  const auto seconds = static_cast<std::int64_t>(*age_s);
  const std::int64_t minutes = seconds / 60;
  const std::int64_t hours = minutes / 60;
  if (minutes == 0) return fmt::format("{} s old", seconds);
  if (hours == 0) return fmt::format("{} min old", minutes);
  if (hours < 48) return fmt::format("{} h {} min old", hours, minutes % 60);
  return fmt::format("{} days old", hours / 24);
}

}  // namespace handeye
