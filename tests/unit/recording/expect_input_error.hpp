// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <initializer_list>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/exit_codes.hpp"

namespace handeye {

/// Expects an InputError of one line that holds all of the words.
inline void expect_input_error(const std::function<void()>& act,
                               const std::initializer_list<std::string>& words) {
  try {
    act();
    ADD_FAILURE() << "no InputError";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_THAT(text, testing::Not(testing::HasSubstr("\n")));
    for (const std::string& word : words) EXPECT_THAT(text, testing::HasSubstr(word));
  }
}

}  // namespace handeye
