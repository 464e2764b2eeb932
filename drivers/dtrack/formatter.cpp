// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/formatter.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace handeye::dtrack {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

template <typename Integer>
void append_integer(std::string& text, Integer value) {
  std::array<char, 24> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

void append_fixed(std::string& text, double value, int decimals) {
  std::array<char, 384> digits;  // the largest double has 309 digits before the point
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::fixed, decimals);
  text.append(digits.data(), end);
}

void append_scientific(std::string& text, double value, int decimals) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::scientific, decimals);
  text.append(digits.data(), end);
}

template <typename Values>
void append_values(std::string& text, const Values& values, int decimals) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (i > 0) text += ' ';
    append_fixed(text, values(i), decimals);
  }
}

/// `[id quality]`
void append_head(std::string& text, std::int32_t id, double quality) {
  text += '[';
  append_integer(text, id);
  text += ' ';
  append_fixed(text, quality, 3);
  text += ']';
}

/// `[x y z eta theta phi][b0 .. b8]`
void append_pose(std::string& text, const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  const Eigen::Vector3d angles_deg = euler_angles_rad(rotation) * deg_from_rad(1.0);
  text += '[';
  append_values(text, pose.translation(), 3);
  text += ' ';
  append_values(text, angles_deg, 4);
  text += "][";
  append_values(text, rotation.reshaped(), 6);  // Eigen runs through columns, as the wire does
  text += ']';
}

void append_times(std::string& text, const Frame& frame) {
  if (frame.seconds_of_day) {
    text += "ts ";
    append_fixed(text, *frame.seconds_of_day, 6);
    text += kLineEnd;
  }
  if (frame.unix_time) {
    text += "ts2 ";
    append_integer(text, frame.unix_time->seconds);
    text += ' ';
    append_integer(text, frame.unix_time->microseconds);
    text += ' ';
    append_integer(text, frame.unix_time->latency_us);
    text += kLineEnd;
  }
}

void append_bodies(std::string& text, const std::vector<Body>& bodies) {
  text += "6d ";
  append_integer(text, std::ranges::count(bodies, true, &Body::tracked));
  for (const Body& body : bodies) {
    if (!body.tracked) continue;
    text += ' ';
    append_head(text, body.id, body.quality);
    append_pose(text, body.room_from_body);
  }
  text += kLineEnd;
}

void append_covariances(std::string& text, const std::vector<BodyCovariance>& covariances) {
  if (covariances.empty()) return;
  text += "6dcov ";
  append_integer(text, covariances.size());
  for (const BodyCovariance& body : covariances) {
    text += " [";
    append_integer(text, body.id);
    text += ' ';
    append_values(text, body.reference_point_mm, 3);
    text += "][";
    for (Eigen::Index row = 0; row < 6; ++row) {
      for (Eigen::Index column = row; column < 6; ++column) {
        if (row + column > 0) text += ' ';
        append_scientific(text, body.covariance(row, column), 3);
      }
    }
    text += ']';
  }
  text += kLineEnd;
}

void append_markers(std::string& text, const std::vector<Marker>& markers) {
  if (markers.empty()) return;
  text += "3d ";
  append_integer(text, markers.size());
  for (const Marker& marker : markers) {
    text += ' ';
    append_head(text, marker.id, marker.quality);
    text += '[';
    append_values(text, marker.position_mm, 3);
    text += ']';
  }
  text += kLineEnd;
}

}  // namespace

Eigen::Vector3d euler_angles_rad(const Eigen::Matrix3d& rotation) {
  const double sine_theta = std::clamp(rotation(0, 2), -1.0, 1.0);
  const double theta = std::asin(sine_theta);
  if (1.0 - std::abs(sine_theta) < 1e-12) {
    return {0.0, theta, std::atan2(rotation(1, 0), rotation(1, 1))};
  }
  return {std::atan2(-rotation(1, 2), rotation(2, 2)), theta,
          std::atan2(-rotation(0, 1), rotation(0, 0))};
}

void format_datagram(const Frame& frame, std::string& datagram) {
  datagram.assign("fr ");
  append_integer(datagram, frame.number);
  datagram += kLineEnd;
  append_times(datagram, frame);
  if (frame.calibrated_bodies) {
    datagram += "6dcal ";
    append_integer(datagram, *frame.calibrated_bodies);
    datagram += kLineEnd;
  }
  append_bodies(datagram, frame.bodies);
  append_covariances(datagram, frame.covariances);
  append_markers(datagram, frame.markers);
}

}  // namespace handeye::dtrack
