// SPDX-License-Identifier: BSD-3-Clause
// Tracking 300 features through a rendered endoscopy, with all that belongs to it (pyramid,
// detection of new corners), beside OpenCV's pyramidal Lucas-Kanade there and back (21x21, three
// levels beyond the image, 30 iterations, 0.01) on the same frames with the same threads; OpenCV's
// corners come from goodFeaturesToTrack, or are given for nothing.
#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "daemon/tracking/feature_tracker.hpp"
#include "tests/sequences/sequence.hpp"

namespace {

using handeye::Observation;
using handeye::TrackedFrame;

constexpr int kFeatures = 300;
constexpr int kFrames = 24;
constexpr std::int64_t kFrameNs = 40'000'000;

/// A stretch of movement, rendered once a size.
const std::vector<cv::Mat>& frames_of(int width) {
  static std::map<int, std::vector<cv::Mat>> rendered;
  std::vector<cv::Mat>& frames = rendered[width];
  if (!frames.empty()) return frames;
  const int height = width == 640 ? 480 : width * 9 / 16;
  handeye::sequences::Sequence sequence(
      "plain", {.duration_s = kFrames / 25.0, .width = width, .height = height});
  handeye::sequences::SequenceFrame frame;
  while (sequence.next(frame)) frames.push_back(frame.grey.clone());
  return frames;
}

/// Forth and back, so that the movement never jumps.
std::size_t frame_at(std::int64_t step) {
  const std::int64_t phase = step % (2 * kFrames - 2);
  return static_cast<std::size_t>(phase < kFrames ? phase : 2 * kFrames - 2 - phase);
}

void ours(benchmark::State& state, int width, int threads) {
  const std::vector<cv::Mat>& frames = frames_of(width);
  cv::setNumThreads(threads);
  const auto tracker =
      handeye::make_feature_tracker({.max_features = kFeatures, .threads = threads});
  TrackedFrame tracked;
  std::int64_t step = 0;
  double features = 0;
  tracker->track(frames[0], {}, 0, tracked);
  for (auto _ : state) {
    ++step;
    tracker->track(frames[frame_at(step)], {}, step * kFrameNs, tracked);
    features += static_cast<double>(tracked.observations.size());
  }
  state.counters["features"] = features / static_cast<double>(step);
}

/// `detects`: lost features are made up for, as a tracker must.
void opencv(benchmark::State& state, int width, int threads, bool detects) {
  const std::vector<cv::Mat>& frames = frames_of(width);
  cv::setNumThreads(threads);
  const cv::Size window(21, 21);
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(frames[0], corners, kFeatures, 0.01, 10);
  std::vector<cv::Mat> last;
  std::vector<cv::Mat> now;
  cv::buildOpticalFlowPyramid(frames[0], last, window, 3);
  std::vector<cv::Point2f> from = corners;
  std::vector<cv::Point2f> to;
  std::vector<cv::Point2f> back;
  std::vector<std::uint8_t> found;
  std::vector<std::uint8_t> found_back;
  std::int64_t step = 0;
  double features = 0;
  for (auto _ : state) {
    ++step;
    const cv::Mat& image = frames[frame_at(step)];
    cv::buildOpticalFlowPyramid(image, now, window, 3);
    cv::calcOpticalFlowPyrLK(last, now, from, to, found, cv::noArray(), window, 3, criteria);
    cv::calcOpticalFlowPyrLK(now, last, to, back, found_back, cv::noArray(), window, 3, criteria);
    features += static_cast<double>(from.size());
    std::vector<cv::Point2f> kept;
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (found[i] != 0 && found_back[i] != 0 && cv::norm(back[i] - from[i]) < 0.5) {
        kept.push_back(to[i]);
      }
    }
    if (detects) {
      cv::Mat free(image.size(), CV_8UC1, cv::Scalar(255));
      for (const cv::Point2f& pixel : kept) cv::circle(free, pixel, 10, 0, cv::FILLED);
      const int room = kFeatures - static_cast<int>(kept.size());
      if (room > 0) cv::goodFeaturesToTrack(image, corners, room, 0.01, 10, free);
      if (room > 0) kept.insert(kept.end(), corners.begin(), corners.end());
    } else {
      // As many as before: the lost ones stay where they were.
      for (std::size_t i = 0; kept.size() < static_cast<std::size_t>(kFeatures) && i < from.size();
           ++i) {
        if (found[i] == 0 || found_back[i] == 0) kept.push_back(from[i]);
      }
    }
    from = kept;
    std::swap(last, now);
  }
  state.counters["features"] = features / static_cast<double>(step);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const int width : {640, 1280, 1920}) {
    for (const int threads : {1, 2}) {
      const auto name = [&](const char* what) {
        return fmt::format("{}/{}/threads:{}", what, width, threads);
      };
      const auto measure = [&](const std::string& title, auto body) {
        benchmark::RegisterBenchmark(title.c_str(), body)
            ->Unit(benchmark::kMillisecond)
            ->MeasureProcessCPUTime()
            ->UseRealTime();
      };
      measure(name("ours"), [=](benchmark::State& state) { ours(state, width, threads); });
      measure(name("opencv_flow_alone"),
              [=](benchmark::State& state) { opencv(state, width, threads, false); });
      measure(name("opencv_with_detection"),
              [=](benchmark::State& state) { opencv(state, width, threads, true); });
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
