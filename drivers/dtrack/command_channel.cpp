// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/command_channel.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "drivers/dtrack/ipv4.hpp"

namespace handeye::dtrack {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

double seconds(milliseconds duration) {
  return std::chrono::duration<double>(duration).count();
}

/// After the answer's NUL only what other programs may put behind a line.
bool is_filling(char c) {
  return c == '\0' || c == '\r' || c == '\n';
}

}  // namespace

CommandChannel::CommandChannel(const CommandOptions& options, std::stop_token stop)
    : options_(options),
      address_(socket_address(parse_ipv4(options.controller, "controller"), options.port)),
      patience_{steady_clock::now() + options.timeout, std::move(stop)} {}

std::optional<CommandAnswer> CommandChannel::connect() {
  const milliseconds allowed = std::min(options_.connect_timeout, options_.timeout);
  const Patience patience{std::min(patience_.deadline, steady_clock::now() + allowed),
                          patience_.stop};
  socket_.emplace();
  switch (socket_->connect(address_, patience)) {
    case TcpResult::kDone:
      return std::nullopt;
    case TcpResult::kInterrupted:
      return close_with(AnswerKind::kInterrupted, "interrupted");
    case TcpResult::kTimedOut:
      return close_with(AnswerKind::kUnreachable,
                        fmt::format("nobody there within {} s", seconds(allowed)));
    default:
      return close_with(AnswerKind::kUnreachable, socket_->why());
  }
}

CommandAnswer CommandChannel::ask(std::string_view command) {
  if (!socket_) {
    if (auto failure = connect()) return *failure;
  }
  const std::string line = fmt::format("{}{}", command, '\0');
  const TcpResult sent = socket_->send(line, patience_);
  return sent == TcpResult::kDone ? read_answer() : broken(sent, "");
}

CommandAnswer CommandChannel::read_answer() {
  std::array<char, kLongestAnswer + 1> room;
  std::size_t received = 0;
  while (received < room.size()) {
    std::size_t count = 0;
    const std::span free = std::span(room).subspan(received);
    const TcpResult result = socket_->receive(free, count, patience_);
    if (result != TcpResult::kDone) return broken(result, {room.data(), received});
    received += count;
    const std::string_view bytes(room.data(), received);
    const std::size_t end = bytes.find('\0');
    if (end == std::string_view::npos) continue;
    if (!std::ranges::all_of(bytes.substr(end), is_filling)) {
      return close_with(AnswerKind::kMalformed,
                        fmt::format("after the answer '{}' came more that nobody asked for",
                                    excerpt(bytes.substr(0, end))));
    }
    CommandAnswer answer = parse_answer(bytes.substr(0, end));
    if (answer.kind == AnswerKind::kMalformed) socket_.reset();
    return answer;
  }
  return close_with(AnswerKind::kMalformed,
                    fmt::format("the answer '{}' has no end within {} bytes",
                                excerpt({room.data(), received}), kLongestAnswer));
}

CommandAnswer CommandChannel::close_with(AnswerKind kind, std::string text) {
  socket_.reset();
  return {.kind = kind, .text = std::move(text)};
}

CommandAnswer CommandChannel::broken(TcpResult result, std::string_view received) {
  const std::string part =
      received.empty() ? "" : fmt::format(", only '{}' came", excerpt(received));
  switch (result) {
    case TcpResult::kInterrupted:
      return close_with(AnswerKind::kInterrupted, "interrupted");
    case TcpResult::kTimedOut:
      return close_with(AnswerKind::kTimedOut,
                        fmt::format("no answer within {} s{}", seconds(options_.timeout), part));
    case TcpResult::kClosed:
      if (!received.empty()) {
        return close_with(AnswerKind::kMalformed,
                          fmt::format("the connection was closed within an answer{}", part));
      }
      return close_with(AnswerKind::kUnreachable, "the connection was closed without an answer");
    default:
      return close_with(AnswerKind::kUnreachable, socket_->why());
  }
}

}  // namespace handeye::dtrack
