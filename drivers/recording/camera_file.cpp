// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/camera_file.hpp"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "drivers/recording/file.hpp"
#include "drivers/recording/recording.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

using nlohmann::json;

/// Strict access to the keys of camera.json.
class CameraJson {
 public:
  CameraJson(const std::filesystem::path& path, const std::string& text) : path_(path) {
    try {
      document_ = json::parse(text);
    } catch (const json::parse_error& error) {
      const auto end =
          text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
      throw InputError(
          fmt::format("{}: line {}: not valid JSON (which has no NaN or Infinity); "
                      "correct or calibrate anew",
                      path_.string(), 1 + std::count(text.begin(), end, '\n')));
    } catch (const json::out_of_range&) {
      fail("", "a number in it is out of range; correct or calibrate anew");
    }
    if (!document_.is_object()) fail("", R"(must be an object {"width":..., "fx":...})");
  }

  int integer(const char* key) const {
    const json& value = at(key);
    if (!value.is_number_integer()) fail(key, "must be a whole number");
    const auto number = value.get<std::int64_t>();
    if (number < std::numeric_limits<int>::min() || number > std::numeric_limits<int>::max()) {
      fail(key, "is out of range");
    }
    return static_cast<int>(number);
  }

  double number(const char* key) const {
    const json& value = at(key);
    if (!value.is_number()) fail(key, "must be a number");
    return value.get<double>();
  }

  std::vector<double> numbers(const char* key) const {
    const json& value = at(key);
    const bool good = value.is_array() && std::all_of(value.begin(), value.end(),
                                                      [](const json& v) { return v.is_number(); });
    if (!good) fail(key, "must be a list of numbers");
    return value.get<std::vector<double>>();
  }

 private:
  const json& at(const char* key) const {
    const auto found = document_.find(key);
    if (found == document_.end()) fail(key, "is missing");
    return *found;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw InputError(fmt::format("{}: {}{}{}", path_.string(), key, key.empty() ? "" : " ", what));
  }

  const std::filesystem::path& path_;
  json document_;
};

CameraModel parse_camera_json(const std::filesystem::path& path, const std::string& text) {
  const CameraJson file(path, text);
  CameraModel camera;
  camera.width = file.integer("width");
  camera.height = file.integer("height");
  camera.fx = file.number("fx");
  camera.fy = file.number("fy");
  camera.cx = file.number("cx");
  camera.cy = file.number("cy");
  set_distortion(camera, file.numbers("distortion"), path, "distortion");
  return camera;
}

}  // namespace

CameraModel read_camera_model(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  const std::string extension = path.extension().string();
  CameraModel camera;
  if (extension == ".json") {
    camera = parse_camera_json(path, text);
  } else if (extension == ".yml" || extension == ".yaml" || extension == ".xml") {
    camera = parse_camera_file_storage(path, text);
  } else {
    throw InputError(fmt::format(
        "{}: no camera file; its name must end in .json, .yml, .yaml or .xml", path.string()));
  }
  if (const auto problem = camera.problem()) {
    throw InputError(fmt::format("{}: {}; correct or calibrate anew", path.string(), *problem));
  }
  return camera;
}

void set_distortion(CameraModel& camera, const std::vector<double>& coefficients,
                    const std::filesystem::path& path, const std::string& key) {
  constexpr std::size_t kMin = 4;
  const std::size_t kUsed = camera.distortion.size();
  const auto is_not_zero = [](double coefficient) { return coefficient != 0; };
  if (coefficients.size() < kMin) {
    throw InputError(
        fmt::format("{}: {} must hold k1, k2, p1, p2 and, if you like, k3", path.string(), key));
  }
  const std::size_t used = std::min(kUsed, coefficients.size());
  const auto rest = coefficients.begin() + static_cast<std::ptrdiff_t>(used);
  if (std::any_of(rest, coefficients.end(), is_not_zero)) {
    throw InputError(
        fmt::format("{}: {} holds more than k1, k2, p1, p2, k3; calibrate with these five alone",
                    path.string(), key));
  }
  std::copy(coefficients.begin(), rest, camera.distortion.begin());
}

void write_camera_model(const std::filesystem::path& path, const CameraModel& camera) {
  if (const auto problem = camera.problem()) {
    throw InputError(fmt::format("{}: not written: {}", path.string(), *problem));
  }
  nlohmann::ordered_json document;
  document["width"] = camera.width;
  document["height"] = camera.height;
  document["fx"] = camera.fx;
  document["fy"] = camera.fy;
  document["cx"] = camera.cx;
  document["cy"] = camera.cy;
  document["distortion"] = camera.distortion;
  std::ofstream file(path, std::ios::binary);
  file << document.dump() << '\n';
  file.close();
  if (!file) {
    throw InputError(
        fmt::format("{}: cannot be written; check folder, rights and disk", path.string()));
  }
}

}  // namespace handeye
