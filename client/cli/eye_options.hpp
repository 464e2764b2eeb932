// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "daemon/geometry/board.hpp"

namespace handeye::cli {

/// --eye and --board as given.
struct EyeOptions {
  std::string eye{"sfm"};
  std::string board;
};

/// --eye sfm|pattern and --board BOARD.
void add_eye_options(CLI::App& command, EyeOptions& options);

/// --board BOARD alone, which must be given.
void add_board_option(CLI::App& command, std::string& board);

/// The board of --eye pattern; nothing for sfm. Throws UsageError when one is given without the
/// other, and for a board that is none. An ambiguous board gets a word on stderr.
std::optional<Board> chosen_board(const EyeOptions& options);

/// Throws UsageError for a text that names no board.
Board board_from(const std::string& text);

}  // namespace handeye::cli
