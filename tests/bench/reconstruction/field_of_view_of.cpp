// SPDX-License-Identifier: BSD-3-Clause
// The mask that this project finds for a recording, so that COLMAP can be given the same.
// Usage: reconstruction_field_of_view RECORDING OUT.png   (writes nothing where the whole image is
// used)
#include <exception>
#include <filesystem>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "daemon/tracking/field_of_view.hpp"
#include "drivers/recording/recording.hpp"
#include "protocol/exit_codes.hpp"

namespace {

using namespace handeye;

void write_mask(const std::filesystem::path& folder, const std::filesystem::path& out) {
  const Recording recording = open_recording(folder);
  if (const auto problem = recording.camera->open()) throw InputError(*problem);
  FieldOfView field;
  Frame frame;
  while (recording.camera->grab(frame, std::chrono::milliseconds(0)) == GrabStatus::kFrame) {
    field.look(frame.grey);
  }
  if (field.mask().empty()) return;
  if (!cv::imwrite(out.string(), field.mask())) {
    throw InputError(fmt::format("{}: cannot be written", out.string()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: reconstruction_field_of_view RECORDING OUT.png\n");
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    write_mask(argv[1], argv[2]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "reconstruction_field_of_view: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
  return static_cast<int>(ExitCode::kOk);
}
