// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace handeye::test {

/// A UDP port that no socket was bound to, and that no other test gets as long as this object
/// lives: the programs under test bind it, so the test itself cannot hold it bound.
class ReservedPort {
 public:
  ReservedPort();
  ~ReservedPort();
  ReservedPort(const ReservedPort&) = delete;
  ReservedPort& operator=(const ReservedPort&) = delete;

  std::uint16_t number() const { return number_; }

 private:
  int reservation_{-1};
  std::uint16_t number_{0};
};

/// Binds a UDP port for as long as it lives: another program that is in the way.
class OccupiedPort {
 public:
  OccupiedPort();
  ~OccupiedPort();
  OccupiedPort(const OccupiedPort&) = delete;
  OccupiedPort& operator=(const OccupiedPort&) = delete;

  std::uint16_t number() const;

 private:
  int socket_;
};

}  // namespace handeye::test
