// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace handeye::dtrack {

/// What became of one command to the controller.
enum class AnswerKind {
  kOk,           ///< `dtrack2 ok`
  kValue,        ///< `dtrack2 set CATEGORY NAME VALUE`, the answer to a get
  kError,        ///< `dtrack2 err CODE "TEXT"`: understood, and refused
  kUnreachable,  ///< no connection, or it broke off before an answer
  kTimedOut,     ///< connected, but no whole answer in time
  kMalformed,    ///< an answer that is none of the above
  kInterrupted,  ///< given up because the caller was told to stop
};

struct CommandAnswer {
  AnswerKind kind{AnswerKind::kMalformed};
  std::string category;  ///< kValue
  std::string name;      ///< kValue
  std::string value;     ///< kValue; may hold blanks, may be empty
  int error_code{0};     ///< kError
  /// kError: the controller's words. kUnreachable, kTimedOut, kMalformed, kInterrupted: what
  /// happened, for a person. Printable ASCII.
  std::string text;
};

/// Answers are far below 200 bytes (the vendor's SDK takes no more); whatever goes on without its
/// NUL is not the command channel of a DTrack.
constexpr std::size_t kLongestAnswer = 1024;

/// An answer without its NUL. Blanks may be doubled and stand at the end; all else must be exactly
/// as above, else kMalformed.
CommandAnswer parse_answer(std::string_view text);

/// The beginning of what was received, fit to be shown: at most 40 characters, and '?' for each
/// byte that is no printable ASCII.
std::string excerpt(std::string_view bytes);

}  // namespace handeye::dtrack
