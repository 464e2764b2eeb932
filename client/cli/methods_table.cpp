// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/methods_table.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "daemon/handeye/types.hpp"

namespace handeye::cli {
namespace {

struct Row {
  std::string_view name;
  std::string_view scale;
  std::string_view source;
};

/// Those of known scale first; a method that is in both tables from the same source is one row.
std::vector<Row> rows() {
  std::vector<Row> rows;
  for (const Method& method : methods(ScaleMode::kKnown)) {
    rows.push_back({method.name, "known", method.source});
  }
  for (const Method& method : methods(ScaleMode::kUnknown)) {
    const auto same = std::ranges::find_if(rows, [&](const Row& row) {
      return row.name == method.name && row.source == method.source;
    });
    if (same != rows.end()) {
      // The answer comes last in either table, and so it does here.
      rows.erase(same);
      rows.push_back({method.name, "both", method.source});
    } else {
      rows.push_back({method.name, "unknown", method.source});
    }
  }
  return rows;
}

}  // namespace

std::string methods_table() {
  std::string text = fmt::format("{:<27}{:<9}{}", "method", "scale", "source");
  for (const Row& row : rows()) {
    text += fmt::format("\n{:<27}{:<9}{}", row.name, row.scale, row.source);
  }
  return text;
}

std::string method_names() {
  std::vector<std::string_view> names;
  for (const Row& row : rows()) {
    if (std::ranges::find(names, row.name) == names.end()) names.push_back(row.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace handeye::cli
