// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/options.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

namespace handeye::cli {
namespace {

std::optional<double> parse_positive(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool complete = error == std::errc() && end == text.data() + text.size();
  if (!complete || !std::isfinite(value) || value <= 0) return std::nullopt;
  return value;
}

struct Deviations {
  double rotation_deg{0};
  double translation_mm{0};
};

std::optional<Deviations> parse_deviations(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto rotation_deg = parse_positive(std::string_view(text).substr(0, comma));
  const auto translation_mm = parse_positive(std::string_view(text).substr(comma + 1));
  if (!rotation_deg || !translation_mm) return std::nullopt;
  return Deviations{*rotation_deg, *translation_mm};
}

}  // namespace

void add_client_options(CLI::App& command, ClientOptions& options) {
  command.add_option("--lcm-url", options.lcm_url, "LCM provider the daemon uses")
      ->capture_default_str();
  command.add_option("--prefix", options.channel_prefix, "channel prefix the daemon uses")
      ->check([](const std::string& prefix) {
        return is_valid_channel_prefix(prefix)
                   ? std::string()
                   : "at most 40 letters, digits, '_' and '-' are allowed, not '" + prefix + "'";
      })
      ->capture_default_str();
}

void add_output_options(CLI::App& command, OutputOptions& options) {
  static const std::map<std::string, ColorChoice> kChoices{{"auto", ColorChoice::kAuto},
                                                           {"always", ColorChoice::kAlways},
                                                           {"never", ColorChoice::kNever}};
  command.add_flag("--json", options.json, "print JSON on stdout and nothing else there");
  command
      .add_option_function<std::string>(
          "--color", [&options](const std::string& choice) { options.color = kChoices.at(choice); },
          "auto: on a terminal unless NO_COLOR is set")
      ->check(CLI::IsMember({"auto", "always", "never"}));
}

void add_deviation_option(CLI::App& command, const std::string& name,
                          const std::function<void(double deg, double mm)>& set,
                          const std::string& help) {
  const auto take = [set](const std::string& text) {
    const Deviations deviations = *parse_deviations(text);
    set(deviations.rotation_deg, deviations.translation_mm);
  };
  command.add_option_function<std::string>(name, take, help)
      ->check([](const std::string& text) {
        return parse_deviations(text)
                   ? std::string()
                   : "two positive numbers as in 0.3,1.5 are wanted, not '" + text + "'";
      })
      ->type_name("DEG,MM");
}

void add_sigma_option(CLI::App& command, WantedSigma& wanted, const std::string& default_text) {
  const auto set = [&wanted](double deg, double mm) { wanted = {deg, mm}; };
  add_deviation_option(
      command, "--sigma", set,
      "accept at or below this standard deviation of rotation [deg] and translation [mm]; " +
          default_text);
}

void add_save_option(CLI::App& command, std::filesystem::path& file) {
  command.add_option("--save", file, "also write the result JSON to this file")->type_name("FILE");
}

std::string no_status_text(const Client& client, const ClientOptions& options) {
  if (client.undecodable() > 0) {
    return fmt::format(
        "messages on '{}STATUS' are not of this version's type: handeyed and handeye must be of "
        "the same version",
        options.channel_prefix);
  }
  return fmt::format(
      "no STATUS heard on channel '{}STATUS' of {}: is handeyed running (systemctl status "
      "handeyed), with the same LCM URL and prefix?",
      options.channel_prefix, options.lcm_url);
}

}  // namespace handeye::cli
