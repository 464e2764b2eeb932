// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/field_outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

constexpr double kCloseFraction = 0.06;  ///< of the width: shadows at the rim this wide are bridged
constexpr int kSpeckPx = 2;              ///< radius; letters and noise are thinner
constexpr double kMinArea = 0.08;        ///< of the image
constexpr double kMaxArea = 0.97;        ///< beyond it there is no rim
constexpr double kMinSolidity = 0.8;     ///< area over that of the convex hull
/// Share of the outline, where it is not the image's border, that must lie on circle or rectangle.
constexpr double kMinShaped = 0.55;
constexpr double kShapePx = 1.5;
constexpr double kShapeFraction = 0.015;  ///< of the radius, on top
constexpr int kCircleSamples = 48;        ///< points of the outline that circles are laid through
/// A rim is sharp where it is so much brighter a little inside than a little outside.
constexpr double kRimFraction = 0.04;  ///< of the radius
constexpr double kRimPx = 1.5;
constexpr double kRimContrast = 3.0;
constexpr double kMinSharp = 0.6;  ///< share of the outline

using Outline = std::vector<cv::Point>;

/// Dilated by a disc, at the same cost whatever its radius.
cv::Mat grown(const cv::Mat& region, double radius) {
  cv::Mat distance;
  cv::distanceTransform(~region, distance, cv::DIST_L2, cv::DIST_MASK_5);
  return distance <= radius;
}

cv::Mat shrunk(const cv::Mat& region, double radius) {
  return ~grown(~region, radius);
}

/// Without specks, and with shadows bridged; the largest region of it.
Outline largest_outline(const cv::Mat& lit) {
  const int close = cvRound(kCloseFraction * lit.cols);
  cv::Mat region;
  cv::copyMakeBorder(grown(shrunk(lit, kSpeckPx), kSpeckPx), region, close, close, close, close,
                     cv::BORDER_CONSTANT, 0);
  region = shrunk(grown(region, close), close);
  std::vector<Outline> outlines;
  cv::findContours(region, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE, {-close, -close});
  if (outlines.empty()) return {};
  return *std::max_element(outlines.begin(), outlines.end(), [](const auto& a, const auto& b) {
    return cv::contourArea(a) < cv::contourArea(b);
  });
}

/// Only there it is the optics' and not the sensor's.
Outline off_the_border(const Outline& outline, cv::Size size) {
  Outline inner;
  std::ranges::copy_if(outline, std::back_inserter(inner), [&](cv::Point point) {
    return point.x > 1 && point.y > 1 && point.x < size.width - 2 && point.y < size.height - 2;
  });
  return inner;
}

struct Circle {
  cv::Point2d centre;
  double radius;
};

std::optional<Circle> circle_through(cv::Point2d a, cv::Point2d b, cv::Point2d c) {
  const cv::Point2d ab = b - a;
  const cv::Point2d ac = c - a;
  const double twice_cross = 2 * ab.cross(ac);
  if (std::abs(twice_cross) < 1e-9) return std::nullopt;
  const cv::Point2d to_centre((ac.y * ab.dot(ab) - ab.y * ac.dot(ac)) / twice_cross,
                              (ab.x * ac.dot(ac) - ac.x * ab.dot(ab)) / twice_cross);
  return Circle{a + to_centre, std::sqrt(to_centre.dot(to_centre))};
}

bool is_on(const Circle& circle, cv::Point2d point) {
  const cv::Point2d arm = point - circle.centre;
  return std::abs(std::sqrt(arm.dot(arm)) - circle.radius) <
         kShapePx + kShapeFraction * circle.radius;
}

bool is_on(const cv::Rect& rectangle, cv::Point point) {
  const int from_sides = std::min({point.x - rectangle.x, rectangle.br().x - 1 - point.x,
                                   point.y - rectangle.y, rectangle.br().y - 1 - point.y});
  return from_sides <= kShapePx;
}

/// The circle that most of the outline lies on, among those through three of its points.
std::optional<Circle> best_circle(const Outline& outline, double largest_radius) {
  const auto point = [&](int sample) {
    return outline[static_cast<std::size_t>(sample % kCircleSamples) * outline.size() /
                   kCircleSamples];
  };
  std::optional<Circle> best;
  int most = 0;
  for (int apart = kCircleSamples / 8; apart <= kCircleSamples / 3; apart += 2) {
    for (int first = 0; first < kCircleSamples; ++first) {
      const auto circle =
          circle_through(point(first), point(first + apart), point(first + 2 * apart));
      if (!circle || circle->radius > largest_radius) continue;
      int on = 0;
      for (int sample = 0; sample < kCircleSamples; ++sample) on += is_on(*circle, point(sample));
      if (on <= most) continue;
      most = on;
      best = circle;
    }
  }
  return best;
}

bool has_shape(const Outline& outline, const Outline& inner, cv::Size size) {
  const cv::Rect bounds = cv::boundingRect(outline);
  const auto circle = best_circle(inner, std::hypot(size.width, size.height));
  const auto shaped = std::ranges::count_if(inner, [&](cv::Point point) {
    return is_on(bounds, point) || (circle && is_on(*circle, point));
  });
  return static_cast<double>(shaped) > kMinShaped * static_cast<double>(inner.size());
}

bool is_sharp(const Outline& inner, cv::Point2d middle, double radius,
              const cv::Mat1f& brightness) {
  const cv::Rect image({0, 0}, brightness.size());
  const double step = kRimPx + kRimFraction * radius;
  int seen = 0;
  int sharp = 0;
  for (const cv::Point2d point : inner) {
    const cv::Point2d arm = point - middle;
    const cv::Point2d outwards = arm * (step / std::max(1.0, std::sqrt(arm.dot(arm))));
    const cv::Point inside(point - outwards);
    const cv::Point outside(point + outwards);
    if (!image.contains(inside) || !image.contains(outside)) continue;
    ++seen;
    if (brightness(inside) > kRimContrast * brightness(outside)) ++sharp;
  }
  return sharp > kMinSharp * seen;
}

}  // namespace

std::vector<cv::Point> find_field_outline(const cv::Mat& lit, const cv::Mat1f& brightness) {
  const Outline outline = largest_outline(lit);
  if (outline.empty()) return {};
  const double area = cv::contourArea(outline);
  const double image_area = lit.size().area();
  Outline hull;
  cv::convexHull(outline, hull);
  if (area < kMinArea * image_area || area > kMaxArea * image_area ||
      area < kMinSolidity * cv::contourArea(hull)) {
    return {};
  }
  const Outline inner = off_the_border(outline, lit.size());
  if (inner.size() < kCircleSamples || !has_shape(outline, inner, lit.size())) return {};
  const cv::Moments moments = cv::moments(outline);
  const cv::Point2d middle(moments.m10 / moments.m00, moments.m01 / moments.m00);
  if (!is_sharp(inner, middle, std::sqrt(area / CV_PI), brightness)) return {};
  return outline;
}

}  // namespace handeye
