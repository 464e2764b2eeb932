// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/handeye/judge.hpp"
#include "tests/unit/handeye/one_step_motions.hpp"
#include "tests/unit/handeye/one_step_scenes.hpp"

/// Motions that lack something, and what is said of them.
namespace handeye::synthetic {

struct Degenerate {
  std::string name;
  std::function<MotionShape(double amplitude)> shape;  ///< 0: what it is called; 1: a good motion
  MotionProblem problem;                               ///< at 0
  MissingMotion missing;                               ///< at 0
};

const std::vector<Degenerate>& degenerate_motions();

/// What is said of one answer, and how wrong it is.
struct Verdict {
  Judgement judgement;
  double rotation_in_sigmas{0};  ///< error to the judgement's standard deviation; 0: no answer
  double translation_in_sigmas{0};

  bool accepted() const { return judgement.problem == MotionProblem::kNone; }
};

struct Verdicts {
  Verdict one_step;
  Verdict likelihood;
};

/// Judges a scene as the daemon does: without a structure by the hand's motion alone.
Verdicts verdicts(const OneStepSceneOptions& options, std::uint32_t seed,
                  const JudgeOptions& wanted = {});

Verdicts verdicts(const Degenerate& motion, double amplitude, std::uint32_t seed, int frames = 130);

}  // namespace handeye::synthetic
