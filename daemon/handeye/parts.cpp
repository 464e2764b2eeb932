// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/parts.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace handeye {

std::vector<Part> parts_of(std::span<const HandEyeObservation> observations) {
  std::map<int, std::vector<std::size_t>> by_number;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    by_number[observations[k].part].push_back(k);
  }
  std::vector<Part> parts;
  for (auto& [number, members] : by_number) parts.push_back({number, std::move(members)});
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.members.size() > b.members.size();
  });
  return parts;
}

std::vector<PosePair> poses_of(std::span<const HandEyeObservation> observations, const Part& part) {
  std::vector<PosePair> poses;
  poses.reserve(part.members.size());
  for (const std::size_t k : part.members) poses.push_back(observations[k].poses);
  return poses;
}

}  // namespace handeye
