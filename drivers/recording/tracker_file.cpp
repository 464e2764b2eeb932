// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/tracker_file.hpp"

#include <fmt/format.h>

#include "drivers/recording/file.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65507;

struct Header {
  std::int64_t arrival_ns;
  std::size_t byte_count;
};

/// Parses `@ <arrival_ns> <byte count>`.
std::optional<Header> parse_header(std::string_view line) {
  if (!line.starts_with("@ ")) return std::nullopt;
  line.remove_prefix(2);
  const std::size_t blank = line.find(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const auto arrival_ns = parse_integer<std::int64_t>(line.substr(0, blank));
  const auto byte_count = parse_integer<std::size_t>(line.substr(blank + 1));
  if (!arrival_ns || *arrival_ns < 0 || !byte_count || *byte_count > kMaxDatagramBytes) {
    return std::nullopt;
  }
  return Header{*arrival_ns, *byte_count};
}

}  // namespace

std::vector<RecordedDatagram> read_tracker_file(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  std::vector<RecordedDatagram> datagrams;
  std::size_t position = 0;
  const auto fail = [&](const char* what) {
    throw InputError(fmt::format("{}: datagram {} at byte {}: {}; record or copy it anew",
                                 path.string(), datagrams.size() + 1, position, what));
  };
  while (position < text.size()) {
    const std::size_t line_end = text.find('\n', position);
    if (line_end == std::string::npos) fail("cut short");
    const auto header = parse_header(std::string_view(text).substr(position, line_end - position));
    if (!header) fail("a line '@ ARRIVAL_NS BYTE_COUNT' must be here");
    const std::size_t begin = line_end + 1;
    if (text.size() - begin < header->byte_count + 1) fail("cut short");
    if (text[begin + header->byte_count] != '\n') fail("the byte count is wrong");
    if (!datagrams.empty() && header->arrival_ns < datagrams.back().arrival_ns) {
      fail("it arrived before the one before");
    }
    datagrams.push_back({header->arrival_ns, text.substr(begin, header->byte_count)});
    position = begin + header->byte_count + 1;
  }
  return datagrams;
}

}  // namespace handeye
