// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "client/cli/board_images.hpp"
#include "client/cli/terminal.hpp"
#include "daemon/pattern/intrinsics.hpp"

namespace handeye::cli {

/// An intrinsic calibration for a person: verdict, a line an image, the camera with its standard
/// deviations. Several lines, the last with its newline.
std::string intrinsics_text(const Intrinsics& intrinsics, const BoardImages& images,
                            const Palette& palette);

/// The same for a program: {"verdict", "reason", "advice", "board", "camera", "sigma",
/// "reprojection_px", "images": [{"file", "found", "corners", "reprojection_px"}]}.
nlohmann::ordered_json intrinsics_json(const Intrinsics& intrinsics, const Board& board,
                                       const BoardImages& images);

}  // namespace handeye::cli
