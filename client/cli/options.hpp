// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include <CLI/App.hpp>

#include "client/cli/terminal.hpp"
#include "client/library/client.hpp"
#include "daemon/session/result.hpp"

namespace handeye::cli {

/// How the result is to be printed.
struct OutputOptions {
  bool json{false};
  ColorChoice color{ColorChoice::kAuto};

  Palette palette() const { return stdout_palette(color); }
};

/// --lcm-url and --prefix.
void add_client_options(CLI::App& command, ClientOptions& options);

/// --json and --color.
void add_output_options(CLI::App& command, OutputOptions& options);

/// NAME DEG,MM: standard deviations of rotation and translation, two positive numbers.
void add_deviation_option(CLI::App& command, const std::string& name,
                          const std::function<void(double deg, double mm)>& set,
                          const std::string& help);

/// --sigma DEG,MM, two positive numbers. default_text: what holds without it, for the help.
void add_sigma_option(CLI::App& command, WantedSigma& wanted, const std::string& default_text);

/// --save FILE.
void add_save_option(CLI::App& command, std::filesystem::path& file);

/// Why no daemon is heard, as far as can be told, and what to check; one line.
std::string no_status_text(const Client& client, const ClientOptions& options);

}  // namespace handeye::cli
