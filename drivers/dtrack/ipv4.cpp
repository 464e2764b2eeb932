// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/ipv4.hpp"

#include <arpa/inet.h>

#include "protocol/exit_codes.hpp"

namespace handeye::dtrack {

in_addr parse_ipv4(const std::string& text, const std::string& option) {
  in_addr address{};
  if (inet_pton(AF_INET, text.c_str(), &address) != 1) {
    throw UsageError("tracker: " + option + " '" + text +
                     "' is no IPv4 address: write it like 192.168.0.5");
  }
  return address;
}

sockaddr_in socket_address(in_addr address, std::uint16_t port) {
  sockaddr_in whole{};
  whole.sin_family = AF_INET;
  whole.sin_port = htons(port);
  whole.sin_addr = address;
  return whole;
}

}  // namespace handeye::dtrack
