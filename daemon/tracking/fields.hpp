// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// How much one image looks like two fields of different instants, woven together.
struct Combing {
  /// Share of what the odd lines show beyond the even ones about them that a movement between the
  /// two explains; near 0 of an image taken at once.
  double explained{0};
  /// That movement, median over the image [px]; 0 where nothing can be told.
  double movement_px{0};

  bool is_clear() const;
};

/// Measures it. The odd lines are predicted from the even ones by interpolation; what is missing is
/// explained by a movement cell by cell (Lucas-Kanade, one step). Of a progressive image what is
/// missing is noise and fine texture, which no movement explains, not even a texture of lines.
class CombingMeter {
 public:
  /// Of a CV_8UC1 image; some of its lines are read.
  Combing measure(const cv::Mat& grey);

 private:
  /// Sums of the normal equations of one cell's movement.
  struct Cell {
    double xx{0}, xy{0}, yy{0}, xe{0}, ye{0}, ee{0};
    double yw{0};  ///< steps down the image over two lines times those over six

    bool is_resolved() const;
  };
  void add_line(const cv::Mat& grey, int y, Cell* cells);

  std::vector<Cell> cells_;
  /// Lines, a few pixels together: the odd one, and the even ones about it.
  std::vector<int> above_, here_, below_, far_above_, far_below_;
  std::vector<double> movements_;
};

/// The even lines of an interlaced image as a whole image, of one instant: the odd lines are
/// interpolated between them. A scene point keeps its pixel coordinates: even lines stay where they
/// are, and an odd line is made for its own place, half way between its neighbours. (Doubling
/// lines, or shrinking and growing an image, would move everything by half a line.) The last line,
/// if odd, repeats the one above.
void keep_even_field(const cv::Mat& grey, cv::Mat& progressive);

/// Notices interlaced input and makes it progressive. One stream of images; memory is kept.
class FieldSeparation {
 public:
  /// The image to work on: `grey` itself, or its even field. Valid until the next call.
  const cv::Mat& take(const cv::Mat& grey);

  /// Whether only one field of the last image was used. While the camera stands still there is no
  /// telling, nor need; once some images were clear every one is taken for interlaced, until none
  /// has been clear for a hundred images.
  bool used_one_field() const { return interlaced_; }

 private:
  void weigh(bool clear);

  CombingMeter meter_;
  cv::Mat progressive_;
  int evidence_{0};
  bool interlaced_{false};
  std::int64_t images_{0};  ///< since there was interlacing
};

}  // namespace handeye
