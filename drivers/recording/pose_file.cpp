// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/pose_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "drivers/recording/file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::size_t kColumns = 14;
constexpr double kLargest = 1e15;        // beyond it squares of lengths lose their meaning
constexpr double kNormTolerance = 1e-3;  // figures rounded to four decimals are well within
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // which spreadsheets put first
constexpr std::size_t kQuotedCharacters = 40;                // of a field or line in a message

using Fields = std::array<std::string_view, kColumns>;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// The start of a text, fit to be shown in one line.
std::string quoted(std::string_view text) {
  std::string shown(text.substr(0, kQuotedCharacters));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return "'" + shown + (text.size() > kQuotedCharacters ? "...'" : "'");
}

/// One line's place in the file; throws what is wrong there.
class Line {
 public:
  Line(const std::filesystem::path& path, std::size_t number) : path_(path), number_(number) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", path_.string(), number_, what));
  }
  [[noreturn]] void fail_at(std::size_t column, std::string_view name,
                            const std::string& what) const {
    throw InputError(fmt::format("{}: line {}, column {} ({}): {}", path_.string(), number_,
                                 column + 1, name, what));
  }

 private:
  const std::filesystem::path& path_;
  std::size_t number_;
};

/// The fields of a line without the spaces round them; counts all, keeps as many as belong there.
std::size_t split(std::string_view line, Fields& fields) {
  std::size_t count = 0;
  for (std::size_t begin = 0;; ++count) {
    const std::size_t comma = std::min(line.find(',', begin), line.size());
    if (count < kColumns) fields[count] = trimmed(line.substr(begin, comma - begin));
    if (comma == line.size()) return count + 1;
    begin = comma + 1;
  }
}

const Fields& column_names() {
  static const Fields kNames = [] {
    Fields names;
    split(kPoseFileHeader, names);
    return names;
  }();
  return kNames;
}

void require_header(std::string_view text, const Line& line) {
  Fields fields;
  if (split(text, fields) != kColumns || fields != column_names()) {
    line.fail(fmt::format("the header must be '{}', not {}", kPoseFileHeader, quoted(text)));
  }
}

double number_in(std::string_view field, std::size_t column, const Line& line) {
  const std::string_view name = column_names()[column];
  if (field.empty()) line.fail_at(column, name, "is empty; write a number or take the row out");
  std::string_view digits = field;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool too_large = std::isfinite(value) && std::abs(value) > kLargest;
  if (error == std::errc::result_out_of_range || too_large) {
    line.fail_at(column, name, quoted(field) + " is beyond any pose; take the row out");
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    line.fail_at(column, name, quoted(field) + " is not a number; write one such as -0.25");
  }
  if (!std::isfinite(value)) {
    line.fail_at(column, name,
                 quoted(field) + " is no pose; take out rows in which nothing was seen");
  }
  return value;
}

/// Seven numbers from `first` on: w, x, y, z of the rotation, then the translation.
Pose pose_at(const std::array<double, kColumns>& values, std::size_t first, const Line& line) {
  const double* v = values.data() + first;
  const Eigen::Quaterniond rotation(v[0], v[1], v[2], v[3]);
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1.0) <= kNormTolerance)) {
    line.fail_at(first, column_names()[first],
                 fmt::format("the quaternion's norm is {:.6g} instead of 1; it must be a rotation, "
                             "its real part w first",
                             norm));
  }
  return make_pose(rotation, {v[4], v[5], v[6]});
}

PoseRow parse_row(std::string_view text, const Line& line) {
  Fields fields;
  const std::size_t count = split(text, fields);
  if (count != kColumns) {
    line.fail(fmt::format("has {} of {} fields; is the file cut short, or a decimal comma in it?",
                          count, kColumns));
  }
  std::array<double, kColumns> values{};
  for (std::size_t k = 0; k < kColumns; ++k) values[k] = number_in(fields[k], k, line);
  return {pose_at(values, 0, line), pose_at(values, 7, line)};
}

}  // namespace

std::vector<PoseRow> read_pose_file(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  const std::size_t last = rest.find_last_not_of(" \t\r\n");
  rest = rest.substr(0, last == std::string_view::npos ? 0 : last + 1);

  std::vector<PoseRow> rows;
  for (std::size_t number = 1; number == 1 || !rest.empty(); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view content = trimmed(rest.substr(0, end));
    const Line line(path, number);
    if (number == 1) {
      require_header(content, line);
    } else {
      rows.push_back(parse_row(content, line));
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return rows;
}

}  // namespace handeye
