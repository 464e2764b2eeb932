// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/clock_report.hpp"

#include <algorithm>

namespace handeye {

void RecentQuantile::add(double value) {
  values_[count_++ % kValues] = static_cast<float>(value);
}

double RecentQuantile::at(double share) const {
  const std::size_t size = std::min(count_, kValues);
  if (size == 0) return 0;
  std::array<float, kValues> sorted = values_;
  const auto rank = std::min(size - 1, static_cast<std::size_t>(share * static_cast<double>(size)));
  const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(sorted.begin(), nth, sorted.begin() + static_cast<std::ptrdiff_t>(size));
  return static_cast<double>(*nth);
}

}  // namespace handeye
