// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

namespace handeye {

/// CLOCK_REALTIME [us], the first field of every message.
std::int64_t realtime_us();

/// CLOCK_MONOTONIC [ns], the clock of every time stamp.
std::int64_t monotonic_ns();

/// A random 64-bit number that is not 0: for session_id and request_id.
std::int64_t random_id();

/// One connection to LCM with this project's delivery rules: raw subscriptions decoded here, what
/// does not decode is counted, nothing is printed, no descriptor limit (poll, never select).
///
/// Threads: one thread calls handle(); any number may publish through Publishers of their own.
class Bus {
 public:
  /// Connects. Throws InputError with the command that helps when there is no route for multicast,
  /// or when the provider URL cannot be used.
  explicit Bus(const std::string& provider_url);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Calls handler with every message of the channel, in the thread that calls handle().
  /// The handler must only copy: LCM's queue drops the newest message when it is full.
  template <typename Message>
  void subscribe(const std::string& channel, std::function<void(const Message&)> handler) {
    subscribe_raw(channel, [this, handler = std::move(handler), message = Message()](
                               const void* data, std::uint32_t size) mutable {
      if (decodes(message, data, size)) {
        handler(message);
      } else {
        ++undecodable_;
      }
    });
  }

  /// Waits at most `timeout` for one message and handles it. False: none came.
  bool handle(std::chrono::milliseconds timeout);

  /// Readable when a message waits: for an event loop that then calls handle(0 ms).
  int file_descriptor() const;

  /// Messages on subscribed channels that were not of the subscribed type.
  std::uint64_t undecodable() const { return undecodable_; }

  /// Random per Bus; goes into every message published through it.
  std::int64_t session_id() const { return session_id_; }

  lcm::LCM& lcm() { return *lcm_; }

 private:
  /// The generated code believes whatever length a message claims, and throws when that is absurd.
  template <typename Message>
  static bool decodes(Message& message, const void* data, std::uint32_t size) {
    try {
      return message.decode(data, 0, static_cast<int>(size)) >= 0;
    } catch (const std::exception&) {
      return false;
    }
  }

  using RawHandler = std::function<void(const void* data, std::uint32_t size)>;
  void subscribe_raw(const std::string& channel, RawHandler handler);

  std::unique_ptr<lcm::LCM> lcm_;
  std::vector<std::unique_ptr<RawHandler>> handlers_;
  std::atomic<std::uint64_t> undecodable_{0};
  std::int64_t session_id_;
};

/// Publishes one type on one channel; stamps utime, session_id and seq. One thread at a time.
/// Reuses its buffer: no allocation once the largest message has been seen.
template <typename Message>
class Publisher {
 public:
  Publisher(Bus& bus, std::string channel) : bus_(&bus), channel_(std::move(channel)) {}

  /// False: LCM could not send (interface down); the message is lost, the next one may go through.
  bool publish(Message& message) {
    message.utime = realtime_us();
    message.session_id = bus_->session_id();
    message.seq = seq_++;
    buffer_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    const int size = static_cast<int>(buffer_.size());
    if (message.encode(buffer_.data(), 0, size) != size) return false;
    return bus_->lcm().publish(channel_, buffer_.data(), static_cast<unsigned>(size)) == 0;
  }

 private:
  Bus* bus_;
  std::string channel_;
  std::int64_t seq_{0};
  std::vector<std::uint8_t> buffer_;
};

}  // namespace handeye
