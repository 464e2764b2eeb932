// SPDX-License-Identifier: BSD-3-Clause
// A program of its own: it replaces the allocator of all.
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tracking/corner_grid.hpp"
#include "daemon/tracking/image_pyramid.hpp"
#include "daemon/tracking/motion_model.hpp"
#include "daemon/tracking/parallel_loop.hpp"
#include "daemon/tracking/track_table.hpp"
#include "tests/unit/tracking/moving_texture.hpp"

namespace {

std::atomic<std::int64_t> allocations{0};

void* allocate(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, whole == 0 ? alignment : whole);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace handeye {
namespace {

/// What a frame goes through, but for the description of new features, which is OpenCV's.
class Steps {
 public:
  void run(const cv::Mat& image, const cv::Mat& mask) {
    now_.build(image, mask, 0, 5);
    from_ = tracks_.pixel;
    to_ = from_;
    found_.resize(from_.size());
    loop_.run(from_.size(), [this](std::size_t i) {
      for (int level = 2; level >= 1; --level) {
        const auto scale = static_cast<float>(1 << level);
        Eigen::Vector2f at = to_[i] / scale;
        if (align_shift(before_, now_, level, from_[i] / scale, at).found) to_[i] = scale * at;
      }
      AffineWarp warp = tracks_.warp[i];
      warp.centre += to_[i] - from_[i];
      found_[i] = tracks_.appearance_of(i).align(now_, warp).found ? 1 : 0;
      tracks_.lost[i] = found_[i] == 0;
      if (found_[i] != 0) tracks_.warp[i] = warp;
      tracks_.pixel[i] = tracks_.warp[i] * tracks_.anchor[i];
    });
    model_.fit(from_, tracks_.pixel, found_);
    tracks_.drop_lost();
    grid_.detect(now_, tracks_.pixel, grid_.cell_count(), corners_);
    for (const Corner& corner : corners_) {
      if (tracks_.room() == 0) break;
      const Eigen::Vector2f pixel(static_cast<float>(corner.x), static_cast<float>(corner.y));
      tracks_.add(next_id_++, pixel, corner.strength);
      if (!tracks_.appearance_of(tracks_.size() - 1).take(now_, corner.x, corner.y)) {
        tracks_.lost.back() = 1;
      }
    }
    tracks_.drop_lost();
    std::swap(now_, before_);
  }
  std::size_t features() const { return tracks_.size(); }

 private:
  ParallelLoop loop_{2};
  TrackTable tracks_{200};
  ImagePyramid now_, before_;
  MotionModel model_;
  CornerGrid grid_{{640, 480}, 220, 10};
  std::vector<Eigen::Vector2f> from_, to_;
  std::vector<std::uint8_t> found_;
  std::vector<Corner> corners_;
  std::int64_t next_id_{0};
};

TEST(TrackingMemory, IsTakenOnceAndForAll) {
  const test::MovingTexture texture({640, 480});
  std::vector<cv::Mat> images;
  for (int f = 0; f < 12; ++f) images.push_back(texture.image(f));
  cv::Mat mask(480, 640, CV_8UC1, cv::Scalar(255));
  Steps steps;
  for (std::size_t f = 0; f < 6; ++f) {
    mask.at<std::uint8_t>(240, 320) = f % 2 == 0 ? 255 : 0;  // another mask every frame
    steps.run(images[f], mask);
  }
  ASSERT_GT(steps.features(), 150U);
  const std::int64_t before = allocations;
  for (std::size_t f = 6; f < images.size(); ++f) {
    mask.at<std::uint8_t>(240, 320) = f % 2 == 0 ? 255 : 0;
    steps.run(images[f], mask);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(steps.features(), 150U);
}

}  // namespace
}  // namespace handeye
