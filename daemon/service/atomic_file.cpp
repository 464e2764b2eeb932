// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/atomic_file.hpp"

#include <cerrno>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

class OpenFile {
 public:
  OpenFile(const std::filesystem::path& path, int flags)
      : path_(path), descriptor_(open(path.c_str(), flags | O_CLOEXEC, 0640)) {
    if (descriptor_ < 0) fail("cannot be opened");
  }
  ~OpenFile() { close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  void write_all(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t written = write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("cannot be written");
      text.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  /// Until it is on the disk.
  void sync() const {
    if (fsync(descriptor_) != 0) fail("cannot be written to the disk");
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(
        fmt::format("{} {}: {}", path_.string(), what, std::generic_category().message(errno)));
  }

  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace

void replace_file(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path written = file.string() + ".tmp";
  {
    const OpenFile target(written, O_WRONLY | O_CREAT | O_TRUNC);
    target.write_all(text);
    target.sync();
  }
  std::error_code error;
  std::filesystem::rename(written, file, error);
  if (error) {
    throw InputError(fmt::format("{} cannot be renamed to {}: {}", written.string(), file.string(),
                                 error.message()));
  }
  // The new name is only safe once the folder is.
  const std::filesystem::path folder = file.parent_path();
  OpenFile(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY).sync();
}

}  // namespace handeye
