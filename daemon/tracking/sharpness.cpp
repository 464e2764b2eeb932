// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/sharpness.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace handeye {
namespace {

/// Share of the brightness that one difference counts at most: the rim of the field of view and
/// highlights stay sharp in the most blurred image.
constexpr double kLargestDifference = 0.12;
constexpr int kBlack = 12;  ///< grey; both blocks darker: nothing there
/// The standard rises quickly with sharper images and falls slowly: blur that lasts for seconds
/// must not become what is expected, but another scene must.
constexpr double kRise = 0.3;
constexpr double kFall = 0.02;

void follow(double measured, double& recent) {
  recent += (measured > recent ? kRise : kFall) * (measured - recent);
}

double ratio(double measured, double recent) {
  return recent > 0 ? std::min(1.0, measured / recent) : 1.0;
}

/// Sum of the differences between neighbours, and of their brightness.
class Differences {
 public:
  explicit Differences(int largest) : largest_(largest) {}

  void add(int a, int b) {
    if (std::max(a, b) < kBlack) return;
    sum_ += std::min(std::abs(a - b), largest_);
    ++count_;
  }
  double mean() const { return count_ > 0 ? sum_ / count_ : 0.0; }

 private:
  int largest_;
  double sum_{0};
  int count_{0};
};

}  // namespace

double Sharpness::beside_recent(const cv::Mat1b& means) {
  const Detail detail = measure(means);
  if (recent_.across <= 0 && recent_.down <= 0) recent_ = detail;
  const double sharpness =
      std::min(ratio(detail.across, recent_.across), ratio(detail.down, recent_.down));
  follow(detail.across, recent_.across);
  follow(detail.down, recent_.down);
  return sharpness;
}

Sharpness::Detail Sharpness::measure(const cv::Mat1b& means) {
  double brightness = 0;
  int lit = 0;
  for (const std::uint8_t mean : means) {
    if (mean < kBlack) continue;
    brightness += mean;
    ++lit;
  }
  if (lit == 0) return {};
  brightness /= lit;
  const int largest = std::max(1, static_cast<int>(kLargestDifference * brightness));
  Differences across(largest);
  Differences down(largest);
  for (int pair = 0; pair + 1 < means.rows; pair += 2) {
    const std::uint8_t* upper = means[pair];
    const std::uint8_t* lower = means[pair + 1];
    for (int x = 0; x + 1 < means.cols; ++x) {
      across.add(upper[x], upper[x + 1]);
      across.add(lower[x], lower[x + 1]);
      down.add(upper[x], lower[x]);
    }
  }
  return {across.mean() / brightness, down.mean() / brightness};
}

}  // namespace handeye
