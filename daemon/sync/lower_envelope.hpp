// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace handeye {

/// The lower envelope of points that come in order of time: the line below all points of a sliding
/// window that is nearest to them (the edge of the lower convex hull below their mean), its slope
/// within limits. The hull needs only the lowest point of each slice of the window, which is what
/// is kept. Constant time and no allocation.
class LowerEnvelope {
 public:
  /// An observation: device time and how much later the host's clock read when it arrived, both
  /// since some start.
  struct Point {
    double device_s{0};
    double lateness_s{0};
  };

  LowerEnvelope(double window_s, double max_slope) : window_s_(window_s), max_slope_(max_slope) {}

  /// Takes a point; true when the line has been fitted again.
  bool insert(const Point& point);
  void clear();

  double at(double device_s) const {
    return line_.lateness_s + slope_ * (device_s - line_.device_s);
  }
  double slope() const { return slope_; }

 private:
  /// A slice of the window: its lowest point and how many observations it saw.
  struct Slice {
    Point lowest;
    double observations{0};
  };
  static constexpr std::size_t kSlices = 80;
  /// Lower convex hull of the slices' points, left to right.
  struct Hull {
    std::array<Point, kSlices> points;
    std::size_t size{0};
    double mean_device_s{0};
  };

  const Slice& slice(std::size_t index) const { return slices_[(first_ + index) % kSlices]; }
  void drop_oldest();
  bool file(const Point& point);
  Hull hull() const;
  void fit();

  double window_s_;
  double max_slope_;
  std::array<Slice, kSlices> slices_{};  ///< ring of those that saw an observation, in order
  std::size_t first_{0};
  std::size_t count_{0};
  std::int64_t newest_slice_{0};
  Point line_;  ///< a point of the line
  double slope_{0};
};

}  // namespace handeye
