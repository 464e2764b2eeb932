// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace handeye::dtrack {

/// Why a datagram, a line or a body was refused.
enum class ErrorKind : std::uint8_t {
  // The datagram is refused: the frame comes out empty.
  kNulByte,            ///< NUL before the last byte
  kNoFrameNumber,      ///< the first line that is not blank is no valid `fr`
  kSecondFrameNumber,  ///< another `fr`: two frames run into each other
  // The line is refused: the frame is as if it had not been sent.
  kBadCount,          ///< a count is negative, above its cap, or contradicts another (ndef < n)
  kBadId,             ///< an id is negative or above its cap
  kMissingTarget,     ///< fewer targets or blocks than the count says
  kMissingValue,      ///< fewer values than the block or line needs
  kUnclosedBlock,     ///< `[` without its `]`
  kBadNumber,         ///< no decimal number: text, nan, inf, hexadecimal, decimal comma
  kNumberOutOfRange,  ///< overflow, or outside what the field can mean
  kTrailingText,      ///< text behind the end of the line's content
  // The body is refused, its line goes on.
  kBadRotation,  ///< tracked, but the matrix is no rotation (tolerance 1e-3)
};
inline constexpr std::size_t kErrorKinds = 12;

/// What is worth counting although nothing was refused.
enum class WarningKind : std::uint8_t {
  kSurplusTargets,         ///< more targets than the count says; the surplus is not read
  kDuplicateId,            ///< an id twice in a line; the last wins
  kDuplicateLine,          ///< a line type twice in a datagram; the last wins
  kCovarianceWithoutBody,  ///< 6dcov for an id that 6d does not list; ignored
  kCalibratedBelowZero,    ///< 6dcal less old-format devices is negative; taken as 0
  kUnknownLine,            ///< identifier not known; skipped
};
inline constexpr std::size_t kWarningKinds = 6;

/// Some words for a person: "count contradicts or exceeds its cap".
std::string_view name(ErrorKind kind);
std::string_view name(WarningKind kind);

/// What became of one datagram.
enum class ParseStatus : std::uint8_t {
  kComplete,  ///< everything in it was understood (warnings possible)
  kPartial,   ///< the frame is good, but at least one line or body was refused
  kRejected,  ///< nothing of it can be used; the frame is empty
};

/// Counted since construction of the parser.
struct ParseCounters {
  std::uint64_t datagrams{0};
  std::uint64_t rejected_datagrams{0};
  std::uint64_t lines{0};  ///< of known type, in datagrams that were not rejected at their head
  std::uint64_t rejected_lines{0};
  std::uint64_t rejected_bodies{0};
  std::array<std::uint64_t, kErrorKinds> errors{};
  std::array<std::uint64_t, kWarningKinds> warnings{};

  std::uint64_t& operator[](ErrorKind kind) { return errors[static_cast<std::size_t>(kind)]; }
  std::uint64_t operator[](ErrorKind kind) const { return errors[static_cast<std::size_t>(kind)]; }
  std::uint64_t& operator[](WarningKind kind) { return warnings[static_cast<std::size_t>(kind)]; }
  std::uint64_t operator[](WarningKind kind) const {
    return warnings[static_cast<std::size_t>(kind)];
  }
};

}  // namespace handeye::dtrack
