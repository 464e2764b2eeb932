// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/section.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_word(std::string_view word,
                         const std::set<std::string, std::less<>>& candidates) {
  std::string nearest;
  std::size_t nearest_distance = word.size() / 2 + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

Section::Section(const toml::table& root, std::string_view name, std::string_view file)
    : name_(name), file_(file) {
  const toml::node* node = root.get(name);
  if (node == nullptr) return;
  table_ = node->as_table();
  if (table_ == nullptr) {
    throw UsageError(fmt::format("{}:{}: '{}' must be a section: write [{}]", file_,
                                 node->source().begin.line, name_, name_));
  }
}

const toml::node* Section::find(std::string_view key) {
  known_.emplace(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

void Section::read(std::string_view key, std::string& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto text = node->value_exact<std::string>();
  if (!text) fail(key, "must be a text in quotes");
  value = *text;
}

void Section::read(std::string_view key, bool& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto flag = node->value_exact<bool>();
  if (!flag) fail(key, "must be true or false");
  value = *flag;
}

void Section::read(std::string_view key, double& value, double lowest, double highest) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto number = node->is_number() ? node->value<double>() : std::nullopt;
  if (!number || !std::isfinite(*number) || *number < lowest || *number > highest) {
    fail(key, fmt::format("must be a number from {} to {}", lowest, highest));
  }
  value = *number;
}

void Section::read(std::string_view key, int& value, int lowest, int highest) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto number = node->value_exact<std::int64_t>();
  if (!number || *number < lowest || *number > highest) {
    fail(key, fmt::format("must be a whole number from {} to {}", lowest, highest));
  }
  value = static_cast<int>(*number);
}

void Section::reject_unknown_keys() const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    if (known_.contains(key.str())) continue;
    const std::string meant = nearest_word(key.str(), known_);
    fail(key.str(), meant.empty() ? "is not a key of this section"
                                  : fmt::format("is not a key; did you mean '{}'?", meant));
  }
}

void Section::fail(std::string_view key, std::string_view problem) const {
  const toml::node* node = table_ == nullptr ? nullptr : table_->get(key);
  const auto line = node == nullptr ? 0 : node->source().begin.line;
  throw UsageError(fmt::format("{}:{}: [{}] {}: {}", file_, line, name_, key, problem));
}

}  // namespace handeye
