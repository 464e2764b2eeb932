// SPDX-License-Identifier: BSD-3-Clause
// The configuration that the package installs, beside docs/configuration.md.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "daemon/config/config.hpp"

namespace handeye {
namespace {

namespace fs = std::filesystem;

const fs::path kShipped = fs::path(HANDEYE_SOURCE_DIR) / "systemd" / "handeyed.toml";
const fs::path kDocument = fs::path(HANDEYE_SOURCE_DIR) / "docs" / "configuration.md";

/// "[section] key" of every key that has a line; `commented`: also those with a # before them.
std::set<std::string> keys_of(const fs::path& file, bool commented) {
  std::set<std::string> keys;
  std::ifstream in(file);
  std::string section;
  std::smatch match;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, match, std::regex(R"((\[[a-z_]+\]))"))) section = match[1];
    const std::regex key(commented ? "#?([a-z_]+) = .*" : "([a-z_]+) = .*");
    if (std::regex_match(line, match, key)) keys.insert(section + " " + match[1].str());
  }
  return keys;
}

/// Those of the document's table; a row may name several keys of one section.
std::set<std::string> documented_keys() {
  std::set<std::string> keys;
  std::ifstream in(kDocument);
  for (std::string line; std::getline(in, line);) {
    std::smatch row;
    if (!std::regex_search(line, row, std::regex(R"(^\| `(\[[a-z_]+\]) ([^|]*)\|)"))) continue;
    const std::string names = row[2];
    const std::regex name("[a-z_0-9]+");
    for (std::sregex_iterator at(names.begin(), names.end(), name), end; at != end; ++at) {
      keys.insert(row[1].str() + " " + at->str());
    }
  }
  return keys;
}

TEST(ShippedConfig, IsReadyToStartWith) {
  const Config config = load_config(kShipped);
  EXPECT_EQ(config.camera.intrinsics_mode, IntrinsicsMode::kEstimate);
  EXPECT_TRUE(config.camera.intrinsics.empty()) << "a new installation has no camera file";
}

TEST(ShippedConfig, ShowsEveryDefaultAsItIs) {
  std::ifstream in(kShipped);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const fs::path uncommented = fs::temp_directory_path() / "handeyed-shipped-config-test.toml";
  std::ofstream(uncommented) << std::regex_replace(text, std::regex("(^|\n)#([a-z_]+ = )"), "$1$2");
  const Config shown = load_config(uncommented);
  fs::remove(uncommented);
  EXPECT_TRUE(shown == load_config(kShipped));
}

TEST(ShippedConfig, NamesEveryDocumentedKeyAndNoOther) {
  std::set<std::string> shown = keys_of(kShipped, true);
  shown.insert("[camera] intrinsics");  // in an example: there is no default
  EXPECT_EQ(shown, documented_keys());
}

}  // namespace
}  // namespace handeye
