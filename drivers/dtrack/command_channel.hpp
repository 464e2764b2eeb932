// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "drivers/dtrack/command_answer.hpp"
#include "drivers/dtrack/tcp_socket.hpp"

namespace handeye::dtrack {

/// Where DTrack2 and DTRACK3 listen for commands.
constexpr std::uint16_t kCommandPort = 50105;

struct CommandOptions {
  std::string controller;  ///< IPv4 address in dotted form
  std::uint16_t port{kCommandPort};
  std::chrono::milliseconds connect_timeout{3'000};  ///< at most `timeout`
  std::chrono::milliseconds timeout{10'000};         ///< of everything together
};

/// The controller's TCP port for commands: connect, act, and let go. Who is connected first has the
/// whole control, so a channel kept open would lock out the operator's own program.
///
/// A command is words with one blank between them and a NUL; so is its one answer. After anything
/// but an answer (AnswerKind up to kError) the connection is closed: what came late would be taken
/// for the answer to the next command.
class CommandChannel {
 public:
  /// Throws UsageError when `controller` is no address. Does not connect; the time runs from here.
  explicit CommandChannel(const CommandOptions& options, std::stop_token stop = {});

  /// Connects. Nothing: it stands; else kUnreachable or kInterrupted.
  std::optional<CommandAnswer> connect();

  /// Sends `command` ("dtrack2 tracking start") and waits for its answer. Connects if need be.
  CommandAnswer ask(std::string_view command);

 private:
  CommandAnswer read_answer();
  CommandAnswer close_with(AnswerKind kind, std::string text);
  CommandAnswer broken(TcpResult result, std::string_view received);

  CommandOptions options_;
  sockaddr_in address_;
  Patience patience_;
  std::optional<TcpSocket> socket_;
};

}  // namespace handeye::dtrack
