// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace handeye {

/// Gives a file new content, whole or not at all: whoever reads it finds the old text or the new,
/// also after the machine lost its power in the middle. Writes `FILE.tmp` beside it, so one writer
/// at a time. Throws InputError; the file is as it was then.
void replace_file(const std::filesystem::path& file, std::string_view text);

}  // namespace handeye
