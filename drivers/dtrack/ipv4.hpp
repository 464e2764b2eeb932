// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <netinet/in.h>
#include <string>

namespace handeye::dtrack {

/// "192.168.0.5" to an address. Throws UsageError that names `option` if it is none.
in_addr parse_ipv4(const std::string& text, const std::string& option);

/// Address and port as the socket calls take them.
sockaddr_in socket_address(in_addr address, std::uint16_t port);

}  // namespace handeye::dtrack
