// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/onestep_input.hpp"

#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "client/cli/json_file.hpp"
#include "daemon/handeye/perspective/gibbs.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::cli {
namespace {

using Json = nlohmann::json;

constexpr double kUnitLength = 0.01;  // a quaternion's norm may be off by this
constexpr int kLargestImage_px = 100000;

/// A place in a file, for messages.
struct Place {
  const Json& json;
  std::string name;  ///< file and path inside it

  [[noreturn]] void fail(const std::string& what) const { throw InputError(name + ": " + what); }

  /// There, and not null.
  bool has(const char* key) const {
    return json.is_object() && json.contains(key) && !json.at(key).is_null();
  }

  /// The object of that name; nothing when it is not there or null.
  std::optional<Place> object(const char* key) const {
    if (!has(key)) return std::nullopt;
    const Place place = at(key);
    if (!place.json.is_object()) place.fail("an object is wanted");
    return place;
  }

  Place at(const char* key) const {
    if (!json.is_object() || !json.contains(key)) fail(fmt::format("'{}' is missing", key));
    return {json.at(key), fmt::format("{}: {}", name, key)};
  }

  Place at(std::size_t index) const {
    return {json.at(index), fmt::format("{} {}", name, index + 1)};
  }

  std::size_t list_size() const {
    if (!json.is_array()) fail("a list is wanted");
    return json.size();
  }

  double number() const {
    if (!json.is_number() || !std::isfinite(json.get<double>())) fail("a finite number is wanted");
    return json.get<double>();
  }

  template <int size>
  Eigen::Matrix<double, size, 1> numbers() const {
    if (!json.is_array() || json.size() != size) fail(fmt::format("{} numbers are wanted", size));
    Eigen::Matrix<double, size, 1> values;
    for (std::size_t i = 0; i < size; ++i) {
      values(static_cast<Eigen::Index>(i)) = at(i).number();
    }
    return values;
  }

  int positive_integer(int largest) const {
    if (!json.is_number_integer() || json.get<double>() < 1 || json.get<double>() > largest) {
      fail(fmt::format("a whole number from 1 to {} is wanted", largest));
    }
    return json.get<int>();
  }
};

Eigen::Quaterniond read_quaternion(const Place& place) {
  const Eigen::Vector4d q = place.numbers<4>();
  if (std::abs(q.norm() - 1.0) > kUnitLength) place.fail("a quaternion of length 1 is wanted");
  return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).normalized();
}

Pose read_pose(const Place& place) {
  return make_pose(read_quaternion(place.at("q_wxyz")), place.at("t_mm").numbers<3>());
}

ObservedPosition read_position(const Place& place) {
  ObservedPosition position{.hand1_from_hand = read_pose(place.at("hand1_from_hand"))};
  const Place points = place.at("points");
  const std::size_t count = points.list_size();
  position.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix<double, 5, 1> values = points.at(i).numbers<5>();
    position.points.push_back({values.head<3>(), values.tail<2>()});
  }
  return position;
}

/// Rotation given as Gibbs vector, quaternion, or both where they agree.
Pose read_starting_pose(const Place& place) {
  const Eigen::Vector3d t_mm = place.at("t_mm").numbers<3>();
  if (!place.has("gibbs")) return make_pose(read_quaternion(place.at("q_wxyz")), t_mm);
  const Eigen::Quaterniond rotation = rotation_from_gibbs(place.at("gibbs").numbers<3>());
  constexpr double kSame_rad = 1e-6;
  if (place.has("q_wxyz") &&
      rotation.angularDistance(read_quaternion(place.at("q_wxyz"))) > kSame_rad) {
    place.fail("gibbs and q_wxyz are different rotations: leave one of them out");
  }
  return make_pose(rotation, t_mm);
}

PerspectiveMatrix read_matrix(const Place& place, const Eigen::Vector3d& in_front) {
  PerspectiveMatrix matrix;
  if (place.list_size() != 3) place.fail("3 rows of 4 numbers are wanted");
  for (std::size_t row = 0; row < 3; ++row) {
    matrix.row(static_cast<Eigen::Index>(row)) = place.at(row).numbers<4>().transpose();
  }
  const auto unit = normalised(matrix, in_front);
  if (!unit) place.fail("the third row must not vanish");
  return *unit;
}

}  // namespace

Observations read_observations(const std::filesystem::path& file) {
  const Json json = read_json_object(file, "a file of observations");
  const Place root{json, file.string()};
  Observations observations;
  observations.width = root.at("width").positive_integer(kLargestImage_px);
  observations.height = root.at("height").positive_integer(kLargestImage_px);
  observations.pixel_mm = root.at("pixel_mm").numbers<2>();
  if (!(observations.pixel_mm.minCoeff() > 0.0)) {
    root.at("pixel_mm").fail("two positive numbers are wanted");
  }
  const Place positions = root.at("positions");
  const std::size_t count = positions.list_size();
  for (std::size_t i = 0; i < count; ++i) {
    observations.positions.push_back(read_position(positions.at(i)));
  }
  constexpr double kIdentity = 1e-6;
  if (count > 0 &&
      !observations.positions.front().hand1_from_hand.isApprox(Pose::Identity(), kIdentity)) {
    positions.at(std::size_t{0}).fail("hand1_from_hand of the first position must be the identity");
  }
  return observations;
}

PerspectiveStart read_start(const std::filesystem::path& file, const Observations& observations) {
  const Json json = read_json_object(file, "a start, such as an earlier result,");
  const Place root{json, file.string()};
  PerspectiveStart start;
  if (const auto pose = root.object("object_from_hand")) {
    start.object_from_hand = read_starting_pose(*pose);
  }
  if (const auto camera = root.object("camera")) {
    if (camera->has("k1_per_mm2")) start.k1_per_mm2 = camera->at("k1_per_mm2").number();
    if (camera->has("cx") || camera->has("cy")) {
      start.centre_px = Eigen::Vector2d(camera->at("cx").number(), camera->at("cy").number());
    }
  }
  if (root.has("perspective_matrices")) {
    const Place matrices = root.at("perspective_matrices");
    if (matrices.list_size() != observations.positions.size()) {
      matrices.fail(
          fmt::format("{} matrices are wanted, one a position", observations.positions.size()));
    }
    for (std::size_t i = 0; i < observations.positions.size(); ++i) {
      const auto& points = observations.positions[i].points;
      if (points.empty()) break;
      start.matrices.push_back(read_matrix(matrices.at(i), points.front().object_mm));
    }
  }
  if (!start.object_from_hand && !start.centre_px && !start.k1_per_mm2 && start.matrices.empty()) {
    root.fail(
        "no start: object_from_hand, camera (cx and cy, k1_per_mm2) or perspective_matrices is "
        "wanted");
  }
  const bool camera_alone = (start.centre_px || start.k1_per_mm2) && start.matrices.empty();
  if (camera_alone && observations.planar()) {
    root.fail("the object is a plane, for which a camera needs perspective_matrices beside it");
  }
  return start;
}

}  // namespace handeye::cli
