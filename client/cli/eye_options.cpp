// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/eye_options.hpp"

#include <variant>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

#include "client/cli/terminal.hpp"
#include "daemon/pattern/board_detector.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {
namespace {

constexpr const char* kBoardForms =
    "chessboard:COLSxROWS:SQUARE_MM (inner corners) or "
    "charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY (squares)";

}  // namespace

void add_eye_options(CLI::App& command, EyeOptions& options) {
  command
      .add_option("--eye", options.eye,
                  "sfm: the camera's motion from whatever is in view; pattern: from a board")
      ->check(CLI::IsMember({"sfm", "pattern"}))
      ->capture_default_str();
  command.add_option("--board", options.board, std::string("with --eye pattern: ") + kBoardForms)
      ->type_name("BOARD");
}

void add_board_option(CLI::App& command, std::string& board) {
  command.add_option("--board", board, kBoardForms)->required()->type_name("BOARD");
}

std::optional<Board> chosen_board(const EyeOptions& options) {
  if (options.eye == "sfm") {
    if (options.board.empty()) return std::nullopt;
    throw UsageError("--board is for --eye pattern; give both, or neither");
  }
  if (options.board.empty()) {
    throw UsageError(std::string("--eye pattern needs --board ") + kBoardForms);
  }
  const Board board = board_from(options.board);
  if (is_ambiguous(board)) {
    print_error("note: a " + to_string(board) +
                " looks the same turned by half a turn; its corners are told apart by continuity. "
                "One with an odd and an even count cannot be mistaken");
  }
  return board;
}

Board board_from(const std::string& text) {
  const auto parsed = parse_board(text);
  if (const auto* problem = std::get_if<std::string>(&parsed)) throw UsageError(*problem);
  return std::get<Board>(parsed);
}

}  // namespace handeye::cli
