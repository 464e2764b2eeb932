// SPDX-License-Identifier: BSD-3-Clause
// How far camera poses are from a recording's true or reference poses, after the similarity that
// fits best. Usage: reconstruction_pose_errors RECORDING POSES.csv [SCENE_DISTANCE_MM] RECORDING
// holds frames.csv and truth_poses.csv (of write_sequence: timestamp_ns and scene_from_eye) or
// reference_poses.csv (file and eye_from_scene), which are the columns of POSES.csv too.
// Prints one line: frames, frames registered, rotation rms [deg], position rms [% of the scene's
// distance, without one of the extent of the true positions], rotation rms with the orientations
// aligned by themselves [deg], mean difference of the relative rotations of pairs at least 5 frames
// apart [deg].
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "daemon/geometry/pose.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/sequences/pose_error.hpp"

namespace {

using namespace handeye;

constexpr int kPairFrames = 5;

/// The rows of a file with a header line, cut at the commas.
std::vector<std::vector<std::string>> read_rows(const std::filesystem::path& path,
                                                std::size_t columns) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
    if (rows.back().size() < columns) {
      throw InputError(fmt::format("{}: '{}' has too few columns", path.string(), line));
    }
  }
  return rows;
}

/// Poses by the first column, from a row KEY,qw,qx,qy,qz,x,y,z.
std::map<std::string, Pose> read_poses(const std::filesystem::path& path) {
  std::map<std::string, Pose> poses;
  for (const auto& row : read_rows(path, 8)) {
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::stod(row[i + 1]);
    poses[row[0]] = make_pose({v[0], v[1], v[2], v[3]}, {v[4], v[5], v[6]});
  }
  return poses;
}

/// A frame of the recording, as it was and as it was found.
struct Frame {
  Pose true_scene_from_eye;
  std::optional<Pose> found_scene_from_eye;
};

std::vector<Frame> read_frames(const std::filesystem::path& folder,
                               const std::filesystem::path& found_path) {
  const bool rendered = exists(folder / "truth_poses.csv");
  const auto truth = read_poses(folder / (rendered ? "truth_poses.csv" : "reference_poses.csv"));
  const auto found = read_poses(found_path);
  std::vector<Frame> frames;
  for (const auto& row : read_rows(folder / "frames.csv", 2)) {
    const auto known = truth.find(row[rendered ? 0 : 1]);
    if (known == truth.end()) continue;
    Frame& frame = frames.emplace_back();
    frame.true_scene_from_eye = rendered ? known->second : known->second.inverse();
    const auto match = found.find(row[1]);
    if (match != found.end()) frame.found_scene_from_eye = match->second.inverse();
  }
  return frames;
}

double relative_rotation_deg(const std::vector<Frame>& frames) {
  double sum = 0;
  int count = 0;
  for (std::size_t a = 0; a < frames.size(); ++a) {
    for (std::size_t b = a + kPairFrames; b < frames.size(); ++b) {
      if (!frames[a].found_scene_from_eye || !frames[b].found_scene_from_eye) continue;
      const Pose expected = frames[a].true_scene_from_eye.inverse() * frames[b].true_scene_from_eye;
      const Pose found =
          frames[a].found_scene_from_eye->inverse() * *frames[b].found_scene_from_eye;
      sum += rotation_angle_rad(found.linear(), expected.linear());
      ++count;
    }
  }
  return deg_from_rad(sum / std::max(1, count));
}

/// Rms distance of the true positions from their mean [unit of the truth].
double extent(const std::vector<sequences::PosePair>& pairs) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const auto count = static_cast<double>(pairs.size());
  for (const auto& pair : pairs) mean += pair.true_scene_from_eye.translation() / count;
  double sum = 0;
  for (const auto& pair : pairs) {
    sum += (pair.true_scene_from_eye.translation() - mean).squaredNorm();
  }
  return std::sqrt(sum / count);
}

void print_errors(const std::vector<Frame>& frames, double scene_distance) {
  std::vector<sequences::PosePair> pairs;
  for (const Frame& frame : frames) {
    if (!frame.found_scene_from_eye) continue;
    pairs.push_back({frame.true_scene_from_eye, *frame.found_scene_from_eye});
  }
  const auto error =
      sequences::pose_error(pairs, scene_distance > 0 ? scene_distance : extent(pairs));
  if (!error) {
    fmt::print("{} {} nan nan nan nan\n", frames.size(), pairs.size());
    return;
  }
  fmt::print("{} {} {:.4f} {:.4f} {:.4f} {:.4f}\n", frames.size(), pairs.size(),
             error->rotation_rms_deg, 100 * error->position_rms, error->turning_rms_deg,
             relative_rotation_deg(frames));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    fmt::print(stderr, "usage: reconstruction_pose_errors RECORDING POSES.csv [DISTANCE_MM]\n");
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    print_errors(read_frames(argv[1], argv[2]), argc == 4 ? std::atof(argv[3]) : 0);
  } catch (const std::exception& error) {
    fmt::print(stderr, "reconstruction_pose_errors: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
  return static_cast<int>(ExitCode::kOk);
}
