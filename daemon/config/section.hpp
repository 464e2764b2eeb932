// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <string_view>

#include <toml++/toml.h>

namespace handeye {

/// One [section] of the configuration while it is read: every key that is there is taken out once,
/// checked, and what is left over at the end is a mistake. All mistakes are UsageError.
class Section {
 public:
  /// A section that is absent is as good as an empty one.
  Section(const toml::table& root, std::string_view name, std::string_view file);

  void read(std::string_view key, std::string& value);
  void read(std::string_view key, bool& value);
  /// Numbers outside lowest..highest are mistakes.
  void read(std::string_view key, double& value, double lowest, double highest);
  void read(std::string_view key, int& value, int lowest, int highest);

  /// Reports the first key that was not read, with the nearest known one.
  void reject_unknown_keys() const;

  /// "FILE:LINE: [section] key: problem" as a UsageError.
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;

 private:
  const toml::node* find(std::string_view key);

  const toml::table* table_{nullptr};
  std::string name_;
  std::string file_;
  std::set<std::string, std::less<>> known_;
};

/// The candidate nearest to `word` by edit distance, empty when none is near.
std::string nearest_word(std::string_view word,
                         const std::set<std::string, std::less<>>& candidates);

}  // namespace handeye
