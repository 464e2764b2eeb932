// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/command_answer.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace handeye::dtrack {
namespace {

constexpr std::size_t kLongestExcerpt = 40;

bool is_printable(char c) {
  return c >= 0x20 && c <= 0x7e;
}

std::string printable(std::string_view bytes) {
  std::string clean(bytes);
  std::ranges::replace_if(
      clean, [](char c) { return !is_printable(c); }, '?');
  return clean;
}

CommandAnswer malformed(std::string_view text) {
  return {.kind = AnswerKind::kMalformed,
          .text = fmt::format("the answer '{}' is not DTrack's", excerpt(text))};
}

/// Words of a line, one after the other.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {
    const std::size_t last = rest_.find_last_not_of(' ');
    rest_ = rest_.substr(0, last == std::string_view::npos ? 0 : last + 1);
  }

  /// Empty when there is none left.
  std::string_view next() {
    const std::string_view word = rest_.substr(0, std::min(rest_.find(' '), rest_.size()));
    rest_.remove_prefix(word.size());
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    return word;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

std::optional<int> to_int(std::string_view word) {
  int number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// CODE "TEXT"
std::optional<CommandAnswer> read_error(Words& words) {
  const auto code = to_int(words.next());
  const std::string_view quoted = words.rest();
  if (!code || quoted.size() < 2 || quoted.front() != '"' || quoted.back() != '"') {
    return std::nullopt;
  }
  return CommandAnswer{.kind = AnswerKind::kError,
                       .error_code = *code,
                       .text = printable(quoted.substr(1, quoted.size() - 2))};
}

/// CATEGORY NAME VALUE
std::optional<CommandAnswer> read_value(Words& words) {
  CommandAnswer answer{.kind = AnswerKind::kValue};
  answer.category = words.next();
  answer.name = words.next();
  answer.value = printable(words.rest());
  if (answer.name.empty()) return std::nullopt;
  return answer;
}

}  // namespace

std::string excerpt(std::string_view bytes) {
  const bool whole = bytes.size() <= kLongestExcerpt;
  return printable(bytes.substr(0, kLongestExcerpt)) + (whole ? "" : "...");
}

CommandAnswer parse_answer(std::string_view text) {
  // A line's end or a tab has no place in an answer; what has them speaks another protocol.
  const auto is_control = [](char c) { return (c >= 0 && c < 0x20) || c == 0x7f; };
  if (text.size() > kLongestAnswer || std::ranges::any_of(text, is_control)) return malformed(text);
  Words words(text);
  if (words.next() != "dtrack2") return malformed(text);
  const std::string_view what = words.next();
  std::optional<CommandAnswer> answer;
  if (what == "ok" && words.rest().empty()) answer = CommandAnswer{.kind = AnswerKind::kOk};
  if (what == "err") answer = read_error(words);
  if (what == "set") answer = read_value(words);
  return answer ? *answer : malformed(text);
}

}  // namespace handeye::dtrack
