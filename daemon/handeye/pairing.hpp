// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace handeye {

/// Pairs i < j of 0..n-1, each once, in which every element has about as many partners, spread over
/// the whole sequence: all pairs where n <= partners + 1, at most n * partners / 2 otherwise, n
/// where partners < 2.
std::vector<std::array<std::size_t, 2>> spread_pairs(std::size_t n, std::size_t partners);

}  // namespace handeye
