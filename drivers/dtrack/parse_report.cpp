// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/parse_report.hpp"

namespace handeye::dtrack {

std::string_view name(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kNulByte:
      return "NUL inside the datagram";
    case ErrorKind::kNoFrameNumber:
      return "no frame number at the head of the datagram";
    case ErrorKind::kSecondFrameNumber:
      return "two frames in one datagram";
    case ErrorKind::kBadCount:
      return "count out of range or contradicting another";
    case ErrorKind::kBadId:
      return "id out of range";
    case ErrorKind::kMissingTarget:
      return "fewer targets than announced";
    case ErrorKind::kMissingValue:
      return "value missing";
    case ErrorKind::kUnclosedBlock:
      return "bracket not closed";
    case ErrorKind::kBadNumber:
      return "not a decimal number";
    case ErrorKind::kNumberOutOfRange:
      return "number out of range";
    case ErrorKind::kTrailingText:
      return "unexpected text in the line";
    case ErrorKind::kBadRotation:
      return "matrix of a tracked body is no rotation";
  }
  return "unknown error";
}

std::string_view name(WarningKind kind) {
  switch (kind) {
    case WarningKind::kSurplusTargets:
      return "more targets than announced";
    case WarningKind::kDuplicateId:
      return "id twice in a line";
    case WarningKind::kDuplicateLine:
      return "line twice in a datagram";
    case WarningKind::kCovarianceWithoutBody:
      return "covariance of a body that is not listed";
    case WarningKind::kCalibratedBelowZero:
      return "fewer calibrated bodies than old devices";
    case WarningKind::kUnknownLine:
      return "unknown line type";
  }
  return "unknown warning";
}

}  // namespace handeye::dtrack
