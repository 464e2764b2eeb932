// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/recording/file.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {

std::ifstream open_for_reading(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(fmt::format("{}: not there; check the path", path.string()));
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: is a folder, but a file is needed", path.string()));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  }
  return file;
}

std::string read_whole_file(const std::filesystem::path& path) {
  std::ifstream file = open_for_reading(path);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) {
    throw InputError(fmt::format("{}: reading failed; is the disk in order?", path.string()));
  }
  return bytes;
}

}  // namespace handeye
