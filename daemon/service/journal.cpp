// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/journal.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <iterator>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/systemd_sink.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-journal.h>

namespace handeye {
namespace {

struct Kind {
  Event event;
  spdlog::level::level_enum level;
  std::string_view message_id;
};

constexpr std::array kKinds{
    Kind{Event::kReady, spdlog::level::info, "ad396c5821094c7ab0a23d01b96d97d9"},
    Kind{Event::kDeviceThere, spdlog::level::info, "547a11db1f744c9289c28cc498089a08"},
    Kind{Event::kDeviceLost, spdlog::level::warn, "8aef40a1a85e4b37958fc52ed676f129"},
    Kind{Event::kCalibrationStarted, spdlog::level::info, "91032613ad75496eb6d87d0877a40f3b"},
    Kind{Event::kCalibrationAccepted, spdlog::level::info, "59fa34e010fb4e7ba836c4dd773404e6"},
    Kind{Event::kCalibrationRefused, spdlog::level::warn, "bd5ad36069cd4f41bc432d3e30bc20ad"},
    Kind{Event::kCalibrationCancelled, spdlog::level::info, "9ddaddc9f3514546ba52c0eebe3e07a5"},
    Kind{Event::kCalibrationRestored, spdlog::level::info, "0b4d3deee52d48908338aab778601090"},
    Kind{Event::kCalibrationNotRestored, spdlog::level::warn, "fc2f7acbd9d8473d8a66321211f870d9"},
    Kind{Event::kCalibrationNotStored, spdlog::level::err, "8e5dd46aa1ad40628a8feaa850c2af50"},
    Kind{Event::kWatchBroken, spdlog::level::warn, "a17fca219a5b4a80bd84e79b8303d541"},
    Kind{Event::kWatchHolds, spdlog::level::info, "23ac35e0ab16416a8cc00ef5cf0832c8"},
    Kind{Event::kThreadStuck, spdlog::level::err, "5f5aae536d7b44b3ad06c9ca9613f53a"},
    Kind{Event::kThreadGoesOn, spdlog::level::info, "f804b06fa361415fa09aa1d02ec24559"},
};

std::atomic<bool> in_journal{false};

const Kind& kind_of(Event event) {
  return *std::ranges::find(kKinds, event, &Kind::event);
}

/// syslog's.
int priority_of(spdlog::level::level_enum level) {
  if (level == spdlog::level::err) return 3;
  return level == spdlog::level::warn ? 4 : 6;
}

}  // namespace

bool stderr_is_the_journal() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat file {};
  if (stream == nullptr || fstat(STDERR_FILENO, &file) != 0) return false;
  return fmt::format("{}:{}", file.st_dev, file.st_ino) == stream;
}

void set_up_logging(const std::string& level) {
  in_journal = stderr_is_the_journal();
  auto logger = in_journal ? spdlog::create<spdlog::sinks::systemd_sink_mt>("handeyed")
                           : spdlog::stderr_color_mt("handeyed");
  logger->set_level(spdlog::level::from_str(level));
  // The journal adds time, name and priority itself.
  logger->set_pattern(in_journal ? "%v" : "%Y-%m-%d %H:%M:%S.%e %^%l%$: %v");
  spdlog::set_default_logger(logger);
}

std::vector<std::string> journal_entry(Event event, const std::string& text,
                                       std::initializer_list<EventField> fields) {
  const Kind& kind = kind_of(event);
  std::vector<std::string> entry{
      fmt::format("MESSAGE={}", text), fmt::format("MESSAGE_ID={}", kind.message_id),
      fmt::format("PRIORITY={}", priority_of(kind.level)), "SYSLOG_IDENTIFIER=handeyed"};
  for (const EventField& field : fields) {
    entry.push_back(fmt::format("{}={}", field.name, field.value));
  }
  return entry;
}

void log_event(Event event, const std::string& text, std::initializer_list<EventField> fields) {
  const Kind& kind = kind_of(event);
  if (!in_journal) return spdlog::log(kind.level, "{}", text);
  if (!spdlog::should_log(kind.level)) return;
  std::vector<std::string> entry = journal_entry(event, text, fields);
  std::vector<iovec> parts;
  std::ranges::transform(entry, std::back_inserter(parts), [](std::string& line) {
    return iovec{line.data(), line.size()};
  });
  sd_journal_sendv(parts.data(), static_cast<int>(parts.size()));
}

}  // namespace handeye
