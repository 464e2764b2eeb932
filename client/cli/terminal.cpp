// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/terminal.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace handeye::cli {
namespace {

constexpr std::string_view kEraseLine = "\r\033[K";

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

void write_stderr(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::string Palette::paint(std::string_view code, std::string_view text) const {
  return enabled_ ? fmt::format("\033[{}m{}\033[0m", code, text) : std::string(text);
}

Palette stdout_palette(ColorChoice choice) {
  if (choice != ColorChoice::kAuto) return Palette(choice == ColorChoice::kAlways);
  const char* no_color = std::getenv("NO_COLOR");
  const bool forbidden = no_color != nullptr && *no_color != '\0';
  return Palette(!forbidden && isatty(STDOUT_FILENO) == 1);
}

std::string printable(std::string_view text) {
  std::string clean(text);
  std::ranges::replace_if(
      clean,
      [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte == 0x7f;
      },
      '?');
  return clean;
}

ProgressLine::ProgressLine() : visible_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(std::string_view text) {
  if (!visible_) return;
  // The last column stays free: a full line would wrap and could not be drawn over.
  const std::size_t room = terminal_width() - 1;
  write_stderr(fmt::format("{}{}", kEraseLine, text.substr(0, room)));
  drawn_ = true;
}

void ProgressLine::clear() {
  if (drawn_) write_stderr(kEraseLine);
  drawn_ = false;
}

std::string progress_bar(double fraction, int width) {
  const double within = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(std::floor(within * width));
  return fmt::format("[{:#<{}}{:.<{}}]", "", filled, "", width - filled);
}

void print_error(std::string_view text) {
  write_stderr(fmt::format("handeye: {}\n", text));
}

bool print_line(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fputc('\n', stdout);
  return std::fflush(stdout) == 0;
}

}  // namespace handeye::cli
