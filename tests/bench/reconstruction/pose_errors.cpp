// SPDX-License-Identifier: BSD-3-Clause
// How far camera poses are from reference poses, after the similarity that fits best.
// Usage: reconstruction_pose_errors REFERENCE.csv POSES.csv [SCENE_DISTANCE]
// Prints one line: frames of the reference, frames registered, rotation rms [deg], position rms [%
// of SCENE_DISTANCE, without it of the extent of the reference's positions], mean difference of the
// relative rotations of pairs at least 5 frames apart [deg]. Both files have the columns
// file,eye_from_scene_qw,qx,qy,qz,x,y,z.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "daemon/geometry/pose.hpp"
#include "protocol/exit_codes.hpp"

namespace {

using namespace handeye;

constexpr int kPairFrames = 5;

struct NamedPose {
  std::string file;
  Pose eye_from_scene;
};

std::vector<NamedPose> read_poses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path));
  std::vector<NamedPose> poses;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    NamedPose pose;
    std::getline(fields, pose.file, ',');
    std::vector<double> v;
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    if (v.size() != 7) throw InputError(fmt::format("{}: '{}' is no pose", path, line));
    pose.eye_from_scene = make_pose({v[0], v[1], v[2], v[3]}, {v[4], v[5], v[6]});
    poses.push_back(pose);
  }
  return poses;
}

/// A frame that both know.
struct Pair {
  int index;  ///< in the reference
  Pose reference, found;
};

std::vector<Pair> pair_up(const std::vector<NamedPose>& reference,
                          const std::vector<NamedPose>& found) {
  std::map<std::string, const Pose*> by_file;
  for (const NamedPose& pose : found) by_file[pose.file] = &pose.eye_from_scene;
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto match = by_file.find(reference[i].file);
    if (match == by_file.end()) continue;
    pairs.push_back({static_cast<int>(i), reference[i].eye_from_scene, *match->second});
  }
  return pairs;
}

double rotation_rms_deg(const std::vector<Pair>& pairs) {
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (const Pair& pair : pairs) {
    correlation += pair.reference.linear().transpose() * pair.found.linear();
  }
  const Eigen::Matrix3d reference_from_found = nearest_rotation(correlation);
  double sum = 0;
  for (const Pair& pair : pairs) {
    const double angle =
        rotation_angle_rad(pair.found.linear(), pair.reference.linear() * reference_from_found);
    sum += angle * angle;
  }
  return deg_from_rad(std::sqrt(sum / static_cast<double>(pairs.size())));
}

/// Rms of the camera centres in units of the reference, and the extent of the reference's.
struct Positions {
  double rms, extent;
};

Positions position_rms(const std::vector<Pair>& pairs) {
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd found(3, count), reference(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    found.col(i) = pairs[static_cast<std::size_t>(i)].found.inverse().translation();
    reference.col(i) = pairs[static_cast<std::size_t>(i)].reference.inverse().translation();
  }
  const Eigen::Matrix4d similarity = Eigen::umeyama(found, reference, true);
  const Eigen::Matrix3Xd rest =
      ((similarity.topLeftCorner<3, 3>() * found).colwise() + similarity.topRightCorner<3, 1>()) -
      reference;
  const Eigen::Vector3d mean = reference.rowwise().mean();
  return {std::sqrt(rest.squaredNorm() / static_cast<double>(count)),
          std::sqrt((reference.colwise() - mean).squaredNorm() / static_cast<double>(count))};
}

double relative_rotation_deg(const std::vector<Pair>& pairs) {
  double sum = 0;
  int count = 0;
  for (const Pair& a : pairs) {
    for (const Pair& b : pairs) {
      if (b.index - a.index < kPairFrames) continue;
      const Eigen::Matrix3d expected = a.reference.linear() * b.reference.linear().transpose();
      const Eigen::Matrix3d found = a.found.linear() * b.found.linear().transpose();
      sum += rotation_angle_rad(found, expected);
      ++count;
    }
  }
  return deg_from_rad(sum / std::max(1, count));
}

void print_errors(const std::vector<NamedPose>& reference, const std::vector<Pair>& pairs,
                  double scene_distance) {
  if (pairs.size() < 3) {
    fmt::print("{} {} nan nan nan\n", reference.size(), pairs.size());
    return;
  }
  const Positions positions = position_rms(pairs);
  const double unit = scene_distance > 0 ? scene_distance : positions.extent;
  fmt::print("{} {} {:.4f} {:.4f} {:.4f}\n", reference.size(), pairs.size(),
             rotation_rms_deg(pairs), 100 * positions.rms / unit, relative_rotation_deg(pairs));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    fmt::print(stderr, "usage: reconstruction_pose_errors REFERENCE.csv POSES.csv [DISTANCE]\n");
    return static_cast<int>(ExitCode::kUsage);
  }
  try {
    const auto reference = read_poses(argv[1]);
    print_errors(reference, pair_up(reference, read_poses(argv[2])),
                 argc == 4 ? std::atof(argv[3]) : 0);
  } catch (const std::exception& error) {
    fmt::print(stderr, "reconstruction_pose_errors: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
  return static_cast<int>(ExitCode::kOk);
}
