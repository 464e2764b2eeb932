// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/sandwich_stages.hpp"

namespace handeye::sandwich {

std::vector<Stage> stages(ErrorModel model) {
  const Stage translation{.rows = Rows::kTranslation, .shift = true};
  const Stage quaternions{.rows = Rows::kQuaternions, .turn = true};
  const Stage scale{.rows = Rows::kTranslation, .shift = true, .scale = true};
  const Stage dual{
      .rows = Rows::kDualQuaternionVectors, .turn = true, .shift = true, .weighted = true};
  // With the scale free as well, the length costs nothing to keep.
  const Stage joint{
      .rows = Rows::kQuaternionsTranslation, .turn = true, .shift = true, .length = true};
  switch (model) {
    case ErrorModel::kNone:
      return {};
    case ErrorModel::kQuaternions:
      return {quaternions, translation};
    case ErrorModel::kGibbsVector:
      return {{.rows = Rows::kGibbsVector, .turn = true}, translation};
    case ErrorModel::kAxisFrames:
      return {{.rows = Rows::kAxisFrames, .turn = true, .shape = 6}, translation};
    case ErrorModel::kLogarithms:
      return {{.rows = Rows::kLogarithms, .turn = true}, translation};
    case ErrorModel::kEntries:
      return {{.rows = Rows::kEntriesTranslation,
               .turn = true,
               .shift = true,
               .shape = 5,
               .weighted = true},
              translation};
    case ErrorModel::kScrews:
      return {{.rows = Rows::kAxes, .turn = true}, {.rows = Rows::kScrewMoments, .shift = true}};
    case ErrorModel::kQuaternionsJoint:
      return {joint};
    case ErrorModel::kDualQuaternions:
      return {dual};
    case ErrorModel::kScaleDualQuaternions:
      return {quaternions, scale, dual};
    case ErrorModel::kScaleQuaternionsJoint:
      return {quaternions, scale, joint};
    case ErrorModel::kEquation7:
      return {{.rows = Rows::kQuaternionsTranslation, .turn = true, .shift = true, .scale = true},
              dual};
    case ErrorModel::kEquation15:
      return {{.rows = Rows::kSimilarityQuaternions, .turn = true, .shift = true, .scale = true},
              dual};
    case ErrorModel::kEntriesJoint:
      return {{.rows = Rows::kEntriesTranslation,
               .turn = true,
               .shift = true,
               .scale = true,
               .shape = 5}};
  }
  return {};
}

std::vector<Eigen::Index> unknowns_of(const Stage& stage) {
  std::vector<Eigen::Index> unknowns;
  const auto add = [&](int first, int count) {
    for (int k = first; k < first + count; ++k) unknowns.push_back(k);
  };
  if (stage.turn) add(kTurn, 3);
  if (stage.shift) add(kShift, 3);
  if (stage.scale) add(kScale, 1);
  add(kShape, stage.shape);
  if (stage.length) add(kLength, 1);
  return unknowns;
}

}  // namespace handeye::sandwich
