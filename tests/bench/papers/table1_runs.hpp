// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// What the replays of one set-up of Schmidt, Vogt and Niemann's Table 1 said, summed up over the
/// simulated scopes.
namespace handeye::papers {

/// Medians over the runs in which the method found an answer; NaN where there was none.
struct MethodFigures {
  std::string name;
  std::size_t solved{0};
  double translation_percent{0};
  double translation_norm_percent{0};
  double rotation_deg{0};
  double rotation_percent{0};
  double time_ms{0};
  double error_deg{0};  ///< against the simulator's truth
  double error_mm{0};
};

struct SetupFigures {
  std::string name;
  std::size_t runs{0};
  int images{0};               ///< of a run
  double noise_deg{0};         ///< of the tracker, per axis
  double noise_mm{0};          ///< likewise
  double largest_turn_deg{0};  ///< of the scope, about each axis
  double largest_shift_mm{0};  ///< likewise, along
  std::string board;
  std::size_t accepted{0};          ///< runs without a pattern that were
  std::size_t pattern_accepted{0};  ///< runs with the pattern that were
  std::vector<MethodFigures> without_pattern;
  std::vector<MethodFigures> with_pattern;
};

/// Reads FOLDER/N.truth.json, N.sfm.json and N.pattern.json (the simulator's truth and the results
/// of `handeye replay --json`) for N = 1, 2, ... The folder's name becomes the set-up's. Throws
/// InputError for a file that cannot be used.
SetupFigures read_setup(const std::filesystem::path& folder);

}  // namespace handeye::papers
