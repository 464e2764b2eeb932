// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace handeye::cli {

enum class ColorChoice { kAuto, kAlways, kNever };

/// Colours, or plain text where they are not wanted.
class Palette {
 public:
  explicit Palette(bool enabled) : enabled_(enabled) {}

  std::string green(std::string_view text) const { return paint("32;1", text); }
  std::string red(std::string_view text) const { return paint("31;1", text); }
  std::string yellow(std::string_view text) const { return paint("33", text); }
  std::string bold(std::string_view text) const { return paint("1", text); }
  std::string dim(std::string_view text) const { return paint("2", text); }

 private:
  std::string paint(std::string_view code, std::string_view text) const;

  bool enabled_;
};

/// kAuto: colours when stdout is a terminal and NO_COLOR is not set (no-color.org).
Palette stdout_palette(ColorChoice choice);

/// Text from the network with control characters replaced by '?': a terminal must not obey it.
std::string printable(std::string_view text);

/// One line on stderr that is drawn over and over; nothing at all unless stderr is a terminal, so
/// that logs and pipes stay clean. Erased when it goes.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool visible() const { return visible_; }

  /// Shows ASCII text, cut to the terminal's width.
  void show(std::string_view text);
  void clear();

 private:
  bool visible_;
  bool drawn_{false};
};

/// "[#####.....]", fraction within 0..1 (else the nearest end), `width` characters between the
/// brackets.
std::string progress_bar(double fraction, int width);

/// "handeye: text" on stderr: how every failure is told.
void print_error(std::string_view text);

/// Writes to stdout at once, with a newline; false: the reader has gone.
bool print_line(std::string_view text);

}  // namespace handeye::cli
