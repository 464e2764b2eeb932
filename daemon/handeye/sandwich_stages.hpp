// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/sandwich_rows.hpp"
#include "daemon/handeye/types.hpp"

namespace handeye::sandwich {

// The unknowns' errors: of X = eye_from_hand w (R_X -> Exp(w) R_X) and t (mm by the scale found),
// of log s, of the shape where nine entries are free (LinearRows::of_shape), and of log |q|^2, by
// which the printed eq 7 lengthens R_X t_H.
inline constexpr int kTurn = 0;
inline constexpr int kShift = 3;
inline constexpr int kScale = 6;
inline constexpr int kShape = 7;
inline constexpr int kLength = 13;
inline constexpr int kUnknowns = 14;

/// Which unknowns a stage solves for, the rest being as stages before left them.
struct Stage {
  Rows rows;
  bool turn{false};
  bool shift{false};
  bool scale{false};
  int shape{0};          ///< 5: det R_X = 1; 6: free
  bool length{false};    ///< held by the penalty (1 - |q|^2)^2 alone
  bool weighted{false};  ///< the last three rows, by translation_weights
};

/// In the order in which the method solves them; none for ErrorModel::kNone.
std::vector<Stage> stages(ErrorModel model);

/// Columns of the unknowns that the stage solves for.
std::vector<Eigen::Index> unknowns_of(const Stage& stage);

}  // namespace handeye::sandwich
