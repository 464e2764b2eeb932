// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace handeye {

/// The lower envelope of points that come in order of time: of each slice of a sliding window the
/// lowest point counts, and the line is the one that a tenth of these lie below, each with the
/// weight of its slice's observations (quantile regression: Koenker and Bassett, Econometrica 46,
/// 1978), its slope within limits. Points that
/// are late by what is never negative crowd at the line, and it is theirs within some microseconds;
/// where the device's own stamps are noisy, which makes points early, the earliest of all do not
/// drag it down. A point that is earlier than such noise proves that the line was too high, which
/// then goes down to it. Constant time and no allocation.
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

  const Slice& slice(std::size_t index) const { return slices_[(first_ + index) % kSlices]; }
  /// Of a slice's lowest point, since the window began.
  double since_begin_s(std::size_t index) const {
    return slice(index).lowest.device_s - slice(0).lowest.device_s;
  }
  void drop_oldest();
  bool file(const Point& point);
  void fit();
  /// The line of this slope.
  struct Fit {
    double height_s{0};  ///< where the window begins
    double lowest_s{0};  ///< of the points, seen along the line
    double pull{0};      ///< positive: a larger slope fits better
  };
  Fit fit_height(double slope) const;

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
