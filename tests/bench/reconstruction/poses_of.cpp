// SPDX-License-Identifier: BSD-3-Clause
// Camera poses of a recording by this project's tracker and reconstruction, with the lens it
// brings. Usage: reconstruction_poses RECORDING OUT   writes OUT/poses.csv and OUT/seconds (wall,
// CPU)
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <fmt/format.h>

#include "daemon/session/eye_source.hpp"
#include "daemon/session/image_stage.hpp"
#include "daemon/session/stopwatch.hpp"
#include "drivers/recording/recording.hpp"
#include "protocol/exit_codes.hpp"

namespace {

using namespace handeye;

/// The file of each frame, by its time stamp.
std::map<std::int64_t, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::int64_t, std::string> files;
  std::ifstream list(folder / "frames.csv");
  std::string line;
  std::getline(list, line);
  while (std::getline(list, line)) {
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos) continue;
    files[std::stoll(line.substr(0, comma))] = line.substr(comma + 1);
  }
  return files;
}

Reconstruction reconstruct(const std::filesystem::path& folder, IntrinsicsMode intrinsics) {
  Recording recording = open_recording(folder);
  if (!recording.camera_model) {
    throw InputError(fmt::format("{}: has no camera.json", folder.string()));
  }
  if (const auto problem = recording.camera->open()) throw InputError(*problem);
  const auto images = make_image_stage(std::nullopt, recording.mask,
                                       known_lens(*recording.camera_model, intrinsics));
  const auto eye = make_eye_source(std::nullopt, *recording.camera_model, intrinsics, {});
  Frame frame;
  TrackedFrame tracked;
  while (recording.camera->grab(frame, std::chrono::milliseconds(0)) == GrabStatus::kFrame) {
    images->process(frame, tracked);
    eye->add(tracked);
  }
  return eye->finish();
}

void write_poses(const std::filesystem::path& path, const Reconstruction& result,
                 const std::map<std::int64_t, std::string>& files) {
  std::ofstream out(path);
  out << "file,eye_from_scene_qw,qx,qy,qz,x,y,z\n";
  for (const RegisteredFrame& frame : result.frames) {
    if (frame.part != 0) continue;
    const Eigen::Quaterniond q(frame.eye_from_scene.linear());
    const Eigen::Vector3d& t = frame.eye_from_scene.translation();
    out << fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}\n",
                       files.at(frame.timestamp_ns), q.w(), q.x(), q.y(), q.z(), t.x(), t.y(),
                       t.z());
  }
}

void write_lens(const std::filesystem::path& path, const Lens& lens) {
  const CameraModel& camera = lens.camera;
  std::ofstream(path) << fmt::format("{} f {:.1f} centre {:.1f} {:.1f} k1 {:.4f} k2 {:.4f}\n",
                                     lens.observable ? "believed" : "unobservable", camera.fx,
                                     camera.cx, camera.cy, camera.distortion[0],
                                     camera.distortion[1]);
}

void run(const std::filesystem::path& folder, const std::filesystem::path& out, bool free_lens) {
  std::filesystem::create_directories(out);
  const Stopwatch stopwatch;
  const std::clock_t cpu_start = std::clock();
  const Reconstruction result =
      reconstruct(folder, free_lens ? IntrinsicsMode::kEstimate : IntrinsicsMode::kFixed);
  const double cpu_s = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  std::ofstream(out / "seconds") << fmt::format("{:.3f} {:.3f}\n", 1e-3 * stopwatch.elapsed_ms(),
                                                cpu_s);
  write_lens(out / "camera.txt", result.lens);
  write_poses(out / "poses.csv", result, files_of(folder));
  fmt::print(stderr, "{} frames in {} parts, {} points, {:.3f} px\n", result.frames.size(),
             result.parts, result.points, result.reprojection_px);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string lens = argc == 4 ? argv[3] : "known";
  if (argc < 3 || argc > 4 || (lens != "known" && lens != "free")) {
    fmt::print(stderr, "usage: reconstruction_poses RECORDING OUT [known|free]\n");
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    run(argv[1], argv[2], lens == "free");
  } catch (const std::exception& error) {
    fmt::print(stderr, "reconstruction_poses: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
  return static_cast<int>(ExitCode::kOk);
}
