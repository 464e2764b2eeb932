// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <memory>

#include <CLI/Option.hpp>
#include <fmt/format.h>

#include "client/cli/commands.hpp"
#include "client/cli/eye_options.hpp"
#include "client/cli/intrinsics_text.hpp"
#include "client/cli/options.hpp"
#include "client/cli/result_output.hpp"
#include "client/cli/status_text.hpp"
#include "drivers/recording/recording.hpp"

namespace handeye::cli {
namespace {

struct IntrinsicsCommandOptions {
  OutputOptions output;
  std::vector<std::filesystem::path> images;
  std::string board;
  std::filesystem::path camera_file{"camera.json"};
};

ExitCode run_intrinsics(const IntrinsicsCommandOptions& options) {
  const Board board = board_from(options.board);
  ProgressLine progress;
  const BoardImages images = find_board(board, options.images, [&](std::size_t done) {
    progress.show(fmt::format("{} of {} images", done, options.images.size()));
  });
  progress.show("calibrating ...");
  const Intrinsics intrinsics = calibrate_intrinsics(board, images.views(), images.size);
  progress.clear();
  const bool accepted = intrinsics.problem == IntrinsicsProblem::kNone;
  if (accepted) write_camera_model(options.camera_file, intrinsics.camera);
  if (options.output.json) {
    auto json = intrinsics_json(intrinsics, board, images);
    json["camera_file"] = nullptr;
    if (accepted) json["camera_file"] = options.camera_file.string();
    print_text(dump_json(json) + "\n");
  } else {
    std::string text = intrinsics_text(intrinsics, images, options.output.palette());
    if (accepted) text += fmt::format("  written to {}\n", options.camera_file.string());
    print_text(text);
  }
  return accepted ? ExitCode::kOk : ExitCode::kRefused;
}

}  // namespace

void add_intrinsics_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<IntrinsicsCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "intrinsics", "calibrate a camera from pictures of a board (Zhang); needs no daemon");
  command
      ->add_option("images", options->images,
                   "pictures of the board: at least 3, better 10, tilted by 20 to 40 degrees in "
                   "different ways, all over the view")
      ->required()
      ->type_name("IMAGES...");
  add_board_option(*command, options->board);
  command->add_option("--output", options->camera_file, "where the camera goes")
      ->type_name("FILE")
      ->capture_default_str();
  add_output_options(*command, options->output);
  command->footer(
      "Exit code: 0 written, 3 refused: the images do not determine the camera, 2 images that "
      "cannot be used.");
  command->callback(
      [options, &action] { action = [options] { return run_intrinsics(*options); }; });
}

}  // namespace handeye::cli
