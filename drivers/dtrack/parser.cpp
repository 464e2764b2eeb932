// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/parser.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "drivers/dtrack/line_splitter.hpp"
#include "drivers/dtrack/lines.hpp"
#include "drivers/dtrack/scanner.hpp"

namespace handeye::dtrack {
namespace {

/// `identifier payload`, parted by the first blank.
struct Line {
  explicit Line(std::string_view text)
      : identifier(text.substr(0, text.find(' '))),
        payload(text.substr(std::min(text.size(), identifier.size() + 1))) {}

  std::string_view identifier;
  std::string_view payload;
};

constexpr std::string_view kFrameNumber = "fr";

std::string_view without_final_nul(std::string_view datagram) {
  if (datagram.ends_with('\0')) datagram.remove_suffix(1);
  return datagram;
}

bool read_frame_number(const Line& line, std::uint32_t& number) {
  Scanner scanner(line.payload);
  std::uint32_t value = 0;
  if (line.identifier != kFrameNumber ||
      !scanner.read(value, 0, std::numeric_limits<std::uint32_t>::max()) || !scanner.finish()) {
    return false;
  }
  number = value;
  return true;
}

}  // namespace

ParseStatus Parser::parse(std::string_view datagram, Frame& frame) {
  ++counters_.datagrams;
  reset(frame, memory_);
  datagram = without_final_nul(datagram);
  if (datagram.find('\0') != std::string_view::npos) return reject(ErrorKind::kNulByte, frame);

  LineSplitter lines(datagram);
  std::string_view text;
  if (!lines.next(text) || !read_frame_number(Line(text), frame.number)) {
    return reject(ErrorKind::kNoFrameNumber, frame);
  }
  const std::uint64_t refused_before = counters_.rejected_lines + counters_.rejected_bodies;
  LineContext context{frame, counters_, memory_};
  while (lines.next(text)) {
    const Line line(text);
    if (line.identifier == kFrameNumber) return reject(ErrorKind::kSecondFrameNumber, frame);
    read_line(line.identifier, line.payload, context);
  }
  settle_lines(context);
  const std::uint64_t refused = counters_.rejected_lines + counters_.rejected_bodies;
  return refused == refused_before ? ParseStatus::kComplete : ParseStatus::kPartial;
}

ParseStatus Parser::reject(ErrorKind error, Frame& frame) {
  ++counters_.rejected_datagrams;
  ++counters_[error];
  reset(frame, memory_);
  return ParseStatus::kRejected;
}

void Parser::read_line(std::string_view identifier, std::string_view payload,
                       LineContext& context) {
  const LineType type = find_line_type(identifier);
  if (type.read == nullptr) {
    ++counters_[WarningKind::kUnknownLine];
    return;
  }
  ++counters_.lines;
  Scanner scanner(payload);
  if (!type.read(scanner, context)) {
    ++counters_.rejected_lines;
    ++counters_[scanner.error()];
    return;
  }
  const std::uint32_t part = 1U << type.part;
  if ((context.parts_seen & part) != 0) ++counters_[WarningKind::kDuplicateLine];
  context.parts_seen |= part;
}

}  // namespace handeye::dtrack
