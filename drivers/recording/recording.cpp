// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/recording.hpp"

#include <fmt/format.h>

#include "drivers/recording/folder_frames.hpp"
#include "drivers/recording/folder_writer.hpp"
#include "drivers/recording/log_frames.hpp"
#include "drivers/recording/log_scan.hpp"
#include "drivers/recording/log_writer.hpp"
#include "drivers/recording/recording_camera.hpp"
#include "drivers/recording/tracker_file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

bool is_log(const std::filesystem::path& path) {
  return path.extension() == ".lcm";
}

/// OUT.lcm -> OUT.camera.json, OUT.mask.png.
std::filesystem::path beside_log(std::filesystem::path log, const char* extension) {
  return log.replace_extension(extension);
}

void add_optional_files(Recording& recording, const std::filesystem::path& camera_file,
                        const std::filesystem::path& mask_file) {
  if (std::filesystem::exists(camera_file)) recording.camera_model = read_camera_model(camera_file);
  if (std::filesystem::exists(mask_file)) recording.mask = read_mask(mask_file);
}

Recording open_log(const std::filesystem::path& path) {
  LogContents contents = scan_log(path);
  Recording recording;
  recording.camera = std::make_unique<RecordingCamera>(
      path, std::make_unique<LogFrames>(path, contents.frame_channel, contents.summary));
  recording.datagrams = std::move(contents.datagrams);
  add_optional_files(recording, beside_log(path, ".camera.json"), beside_log(path, ".mask.png"));
  return recording;
}

Recording open_folder(const std::filesystem::path& path) {
  Recording recording;
  recording.camera = std::make_unique<RecordingCamera>(path, std::make_unique<FolderFrames>(path));
  if (std::filesystem::exists(path / "tracker.txt")) {
    recording.datagrams = read_tracker_file(path / "tracker.txt");
  }
  add_optional_files(recording, path / "camera.json", path / "mask.png");
  return recording;
}

}  // namespace

Recording open_recording(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    throw InputError(fmt::format("{}: not there; check the path", path.string()));
  }
  if (is_log(path)) return open_log(path);
  if (std::filesystem::is_directory(path)) return open_folder(path);
  throw InputError(fmt::format(
      "{}: no recording; that is an LCM log, whose name ends in .lcm, or a folder with frames.csv",
      path.string()));
}

std::unique_ptr<RecordingWriter> create_recording(const std::filesystem::path& path,
                                                  const std::optional<CameraModel>& camera,
                                                  std::int64_t realtime_minus_monotonic_ns) {
  const std::filesystem::path camera_file =
      is_log(path) ? beside_log(path, ".camera.json") : path / "camera.json";
  for (const std::filesystem::path& target : {path, camera_file}) {
    if (std::filesystem::exists(target)) {
      throw InputError(fmt::format("{}: exists already and is not overwritten; choose another name",
                                   target.string()));
    }
  }
  std::unique_ptr<RecordingWriter> writer;
  if (is_log(path)) {
    writer = std::make_unique<LogWriter>(path, realtime_minus_monotonic_ns);
  } else {
    writer = std::make_unique<FolderWriter>(path);
  }
  if (camera) write_camera_model(camera_file, *camera);
  return writer;
}

}  // namespace handeye
