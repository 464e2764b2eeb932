// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/command_answer.hpp"

#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>

namespace handeye::dtrack {
namespace {

AnswerKind kind_of(std::string_view text) {
  return parse_answer(text).kind;
}

bool is_printable(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return c >= 0x20 && c <= 0x7e; });
}

TEST(CommandAnswer, ReadsOk) {
  EXPECT_EQ(kind_of("dtrack2 ok"), AnswerKind::kOk);
  EXPECT_EQ(kind_of("dtrack2  ok "), AnswerKind::kOk) << "blanks";
}

TEST(CommandAnswer, ReadsErrors) {
  const CommandAnswer answer = parse_answer(R"(dtrack2 err 17 "no cameras: check "power" here")");
  EXPECT_EQ(answer.kind, AnswerKind::kError);
  EXPECT_EQ(answer.error_code, 17);
  EXPECT_EQ(answer.text, R"(no cameras: check "power" here)");

  EXPECT_EQ(parse_answer(R"(dtrack2 err -3 "")").error_code, -3);
  EXPECT_EQ(parse_answer(R"(dtrack2 err -3 "")").kind, AnswerKind::kError);
  EXPECT_EQ(parse_answer("dtrack2 err 1 \"Kamera \xfc\"").text, "Kamera ?");
}

TEST(CommandAnswer, ReadsValues) {
  const CommandAnswer answer = parse_answer("dtrack2 set status active mea");
  EXPECT_EQ(answer.kind, AnswerKind::kValue);
  EXPECT_EQ(answer.category, "status");
  EXPECT_EQ(answer.name, "active");
  EXPECT_EQ(answer.value, "mea");
  EXPECT_EQ(parse_answer("dtrack2 set  status  active   mea ").value, "mea") << "other blanks";
  EXPECT_EQ(parse_answer("dtrack2 set system accessed_by \"OR 3\" 10.0.0.9").value,
            "\"OR 3\" 10.0.0.9");
  EXPECT_EQ(parse_answer("dtrack2 set system accessed_by").value, "");
}

TEST(CommandAnswer, RefusesEverythingElse) {
  const std::string nul_inside("dtrack2 o\0k", 11);
  for (const std::string& text : {std::string(),
                                  std::string(" "),
                                  std::string("ok"),
                                  std::string("dtrack2"),
                                  std::string("dtrack2 "),
                                  std::string("dtrack2 okay"),
                                  std::string("dtrack2 ok now"),
                                  std::string("dtrack ok"),
                                  std::string("DTRACK2 OK"),
                                  std::string(" dtrack2 ok"),
                                  std::string("dtrack2\tok"),
                                  std::string("dtrack2 ok\r\n"),
                                  std::string("dtrack2 err"),
                                  std::string("dtrack2 err 5"),
                                  std::string("dtrack2 err 5 text"),
                                  std::string("dtrack2 err 5 \""),
                                  std::string("dtrack2 err 5 \"text"),
                                  std::string("dtrack2 err five \"text\""),
                                  std::string("dtrack2 err 0x5 \"text\""),
                                  std::string("dtrack2 err 5.0 \"text\""),
                                  std::string("dtrack2 err 99999999999 \"text\""),
                                  std::string("dtrack2 err \"text\""),
                                  std::string("dtrack2 set"),
                                  std::string("dtrack2 set status"),
                                  std::string("dtrack2 get status active"),
                                  std::string("dtrack2 msg system info 12 0x1f \"text\""),
                                  std::string("HTTP/1.1 400 Bad Request"),
                                  std::string("SSH-2.0-OpenSSH_9.2"),
                                  nul_inside,
                                  std::string(kLongestAnswer + 1, 'x'),
                                  "dtrack2 err 1 \"" + std::string(kLongestAnswer, 'x') + "\""}) {
    const CommandAnswer answer = parse_answer(text);
    EXPECT_EQ(answer.kind, AnswerKind::kMalformed) << text;
    EXPECT_TRUE(is_printable(answer.text)) << text;
    EXPECT_LT(answer.text.size(), 100U);
  }
}

TEST(CommandAnswer, IsAlwaysFitToBeShown) {
  constexpr int kDraws = 20'000;
  std::mt19937 random(7);
  const std::string valid = R"(dtrack2 err 17 "no cameras")";
  int refused = 0;
  for (int i = 0; i < kDraws; ++i) {
    std::string text = valid.substr(0, random() % (valid.size() + 1));
    const std::size_t changes = random() % 3;
    for (std::size_t change = 0; change < changes && !text.empty(); ++change) {
      text[random() % text.size()] = static_cast<char>(random() & 0xff);
    }
    const CommandAnswer answer = parse_answer(text);
    EXPECT_TRUE(is_printable(answer.text) && is_printable(answer.value)) << text;
    EXPECT_NE(answer.kind, AnswerKind::kOk) << text;
    if (answer.kind == AnswerKind::kMalformed) ++refused;
  }
  EXPECT_GT(refused, kDraws / 2);
}

}  // namespace
}  // namespace handeye::dtrack
