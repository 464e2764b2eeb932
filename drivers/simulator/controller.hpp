// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "drivers/simulator/controller_answers.hpp"

namespace handeye::simulator {

struct ControllerOptions {
  std::string bind_address{"127.0.0.1"};  ///< IPv4; 0.0.0.0: every address of this machine
  std::uint16_t port{50105};              ///< 0: any free one, see Controller::port()
  std::optional<ControllerFault> fault;
};

/// The command port of a simulated DTrack controller: TCP, commands and answers end with NUL. Like
/// the real one it gives the control to whoever is connected first, and tells all others so.
class Controller {
 public:
  /// Listens from here on, in a thread of its own. Throws UsageError for an address that is none,
  /// InputError when the port cannot be had.
  explicit Controller(const ControllerOptions& options);
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  std::uint16_t port() const { return port_; }
  /// Off at first. From any thread.
  bool tracking() const { return answers_.tracking(); }

 private:
  struct Client {
    int descriptor;
    std::string address;
    std::string received;          ///< of a command that is not complete
    std::deque<char> waiting{};    ///< of answers, with kSlow
    std::int64_t next_byte_ns{0};  ///< when the next of these is due
  };

  void run(const std::stop_token& stop);
  void wait_for_work();
  void accept_client();
  /// False: the client has gone, or must go.
  bool serve(Client& client);
  bool answer(Client& client, const std::string& command);
  bool drip(Client& client);

  ControllerOptions options_;
  int listener_{-1};
  std::uint16_t port_{0};
  ControllerAnswers answers_;
  std::vector<Client> clients_;  ///< in the order in which they came
  std::jthread thread_;
};

}  // namespace handeye::simulator
