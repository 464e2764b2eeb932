// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "daemon/session/result.hpp"

namespace handeye {

struct ReplayOptions {
  std::filesystem::path recording;
  std::optional<std::filesystem::path> camera_file;   ///< overrides the recording's camera.json
  std::optional<std::filesystem::path> mask_file;     ///< overrides the recording's mask.png
  IntrinsicsMode intrinsics{IntrinsicsMode::kFixed};  ///< kEstimate: a camera file may be missing
  int body_id{-1};                                    ///< -1: the first body that is seen
  WantedSigma wanted;
  std::optional<Board> board;  ///< the eye's poses from it; nothing: from a reconstruction
  /// Called now and then with the number of frames done; for progress on a terminal. May be empty.
  std::function<void(std::int64_t frames_done)> progress;
};

/// The daemon's own pipeline on a recording, as fast as it goes; the same answer every time,
/// timings aside. Throws InputError for files that cannot be used.
CalibrationResult replay(const ReplayOptions& options);

}  // namespace handeye
