// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/image_inspector.hpp"

#include <array>
#include <cstdint>

namespace handeye {
namespace {

// Grey levels of block means. Of a black picture noise and glow remain, at most a faint one all
// over; a few bright words may be written on it.
constexpr double kBrightQuantile = 0.95;
constexpr double kDarkQuantile = 0.05;
constexpr int kNothing = 20;  ///< brighter parts below this: dark, whatever its contrast
constexpr int kFaint = 45;    ///< below this: dark if it has no contrast
constexpr int kFaintContrast = 10;
constexpr int kLit = 24;  ///< within the field of view, roughly
constexpr int kBurnt = 248;
constexpr double kBurntShare = 0.6;  ///< of what is lit
constexpr double kBlurredBelow = 0.5;

/// How many blocks there are of each grey level.
class Histogram {
 public:
  explicit Histogram(const cv::Mat1b& means) {
    for (const std::uint8_t mean : means) ++counts_[mean];
  }

  int quantile(double fraction) const {
    const double wanted = fraction * count_from(0);
    double below = 0;
    for (int level = 0; level < 255; ++level) {
      below += counts_[static_cast<std::size_t>(level)];
      if (below > wanted) return level;
    }
    return 255;
  }

  int count_from(int lowest) const {
    int count = 0;
    for (int level = lowest; level < 256; ++level) {
      count += counts_[static_cast<std::size_t>(level)];
    }
    return count;
  }

 private:
  std::array<int, 256> counts_{};
};

bool is_dark(const Histogram& histogram) {
  const int bright = histogram.quantile(kBrightQuantile);
  if (bright < kNothing) return true;
  return bright < kFaint && bright - histogram.quantile(kDarkQuantile) < kFaintContrast;
}

bool is_burnt_out(const Histogram& histogram) {
  return histogram.count_from(kBurnt) > kBurntShare * histogram.count_from(kLit);
}

}  // namespace

ImageCondition ImageInspector::inspect(const cv::Mat& grey) {
  if (grey.empty() || grey.type() != CV_8UC1) return ImageCondition::kUnusable;
  blocks_.take(grey);
  const Histogram histogram(blocks_.means());
  if (is_dark(histogram)) return ImageCondition::kDark;
  if (repeated_.is_repetition(grey)) return ImageCondition::kFrozen;
  if (is_burnt_out(histogram)) return ImageCondition::kBright;
  const double sharpness = sharpness_.beside_recent(blocks_.means());
  return sharpness < kBlurredBelow ? ImageCondition::kBlurred : ImageCondition::kGood;
}

}  // namespace handeye
