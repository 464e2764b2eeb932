// SPDX-License-Identifier: BSD-3-Clause
// docs/onestep.md must show what the program prints.
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/unit/client/program_run.hpp"

namespace handeye {
namespace {

using namespace test;

/// Without the spaces at the ends of lines, which a page does not keep.
std::string trimmed(const std::string& text) {
  std::istringstream lines(text);
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    all += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return all;
}

/// The commands of docs/onestep.md, each with what the page says that it prints.
struct Example {
  std::vector<std::string> words;
  std::string output;
};

std::vector<Example> examples(const std::filesystem::path& page) {
  const std::string prompt = "    $ handeye ";
  std::istringstream text(read_text(page));
  std::vector<Example> found;
  bool in_output = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with(prompt)) {
      std::istringstream words(line.substr(prompt.size()));
      found.emplace_back();
      for (std::string word; words >> word;) found.back().words.push_back(word);
      in_output = true;
    } else if (in_output && line.starts_with("    ")) {
      found.back().output += line.substr(4) + "\n";
    } else {
      in_output = false;
    }
  }
  return found;
}

TEST(OnestepDocs, TheExamplesRunAsWritten) {
  const std::filesystem::path root = HANDEYE_SOURCE_DIR;
  const TemporaryFolder folder;
  const auto all = examples(root / "docs/onestep.md");
  EXPECT_EQ(all.size(), 2U);
  for (Example example : all) {
    for (std::string& word : example.words) {
      if (word.starts_with("tests/")) word = root / word;
      if (word == "result.json") word = folder / word;
    }
    const Finished finished = run_handeye(example.words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(trimmed(finished.out), example.output);
  }
}

}  // namespace
}  // namespace handeye
