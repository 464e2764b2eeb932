// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>

#include "client/cli/commands.hpp"
#include "client/cli/eye_options.hpp"
#include "client/cli/interrupt.hpp"
#include "client/cli/options.hpp"
#include "client/cli/result_output.hpp"
#include "client/cli/status_text.hpp"
#include "client/library/remote_calibration.hpp"
#include "daemon/session/result_message.hpp"

namespace handeye::cli {
namespace {

using std::chrono::milliseconds;
using Kind = CalibrationOutcome::Kind;

struct CalibrateOptions {
  ClientOptions client;
  OutputOptions output;
  EyeOptions eye;
  StartRequest start;
  WantedSigma wanted{0, 0};  ///< 0: the daemon's configured one
  double timeout_s{0};       ///< 0: the daemon's longest duration and time to solve on top
  std::filesystem::path save;
};

CalibrationLimits limits_of(const CalibrateOptions& options) {
  CalibrationLimits limits;
  if (options.timeout_s > 0) {
    limits.total = milliseconds(static_cast<std::int64_t>(options.timeout_s * 1000));
  }
  return limits;
}

void show_progress(ProgressLine& progress, const Client& client,
                   const RemoteCalibration& calibration) {
  const auto& status = client.last_status();
  if (status && status->request_id == calibration.request_id()) {
    progress.show(progress_text(*status));
  }
}

/// Runs the calibration to its end. The first Ctrl-C cancels it; the second only stops waiting for
/// the daemon's confirmation, and then there is no outcome.
std::optional<CalibrationOutcome> run_to_its_end(Client& client, Interrupt& interrupt,
                                                 const CalibrateOptions& options) {
  ProgressLine progress;
  progress.show("waiting for the daemon ... (Ctrl-C cancels)");
  RemoteCalibration calibration(client, options.start, limits_of(options));
  bool cancelling = false;
  while (!calibration.outcome()) {
    if (interrupt.wait(client.file_descriptor(), milliseconds(50))) {
      if (cancelling) return std::nullopt;
      cancelling = true;
      calibration.cancel();
      progress.show("cancelling ...");
    }
    while (!calibration.outcome() && calibration.spin_once(milliseconds(0))) {
      if (!cancelling) show_progress(progress, client, calibration);
    }
  }
  return calibration.outcome();
}

std::string_view refusal_word(std::int32_t acknowledgement_code) {
  switch (acknowledgement_code) {
    case status_t::ACK_BUSY:
      return "busy";
    case status_t::ACK_NOTHING_TO_DO:
      return "nothing_to_do";
    default:
      return "bad_request";
  }
}

/// An end without a RESULT: the verdict and why, in the result JSON's words.
ExitCode print_bare_verdict(std::string_view verdict, std::string_view reason,
                            const CalibrationOutcome& outcome, const CalibrateOptions& options) {
  const nlohmann::ordered_json json{{"verdict", verdict},
                                    {"reason", reason},
                                    {"advice", outcome.text},
                                    {"request_id", outcome.request_id},
                                    {"hand_from_eye", nullptr}};
  if (options.output.json) print_line(dump_json(json));
  if (!options.save.empty()) save_json(options.save, json);
  print_error(printable(outcome.text));
  return ExitCode::kRefused;
}

ExitCode report(const CalibrationOutcome& outcome, std::chrono::duration<double> elapsed,
                const Client& client, const CalibrateOptions& options) {
  if (outcome.result) {
    const ExitCode code = print_result(from_message(*outcome.result), options.output, options.save);
    if (!options.output.json) {
      print_line(fmt::format("  {:.1f} s from request to result", elapsed.count()));
    }
    return code;
  }
  switch (outcome.kind) {
    case Kind::kRequestRefused:
      return print_bare_verdict("refused", refusal_word(outcome.acknowledgement->code), outcome,
                                options);
    case Kind::kCancelled:
      return print_bare_verdict("cancelled", "cancelled", outcome, options);
    case Kind::kTimedOut:
      print_error(outcome.text);
      return ExitCode::kTimedOut;
    case Kind::kNoStatus:
      print_error(no_status_text(client, options.client));
      return ExitCode::kInput;
    default:
      print_error(outcome.text);
      return ExitCode::kInput;
  }
}

ExitCode run_calibrate(CalibrateOptions options) {
  if (const auto board = chosen_board(options.eye)) options.start.board = to_string(*board);
  options.start.wanted_sigma_rotation_deg = options.wanted.rotation_deg;
  options.start.wanted_sigma_translation_mm = options.wanted.translation_mm;
  Interrupt interrupt;
  Client client(options.client);
  const auto requested = std::chrono::steady_clock::now();
  const auto outcome = run_to_its_end(client, interrupt, options);
  if (!outcome) {
    print_error("stopped before the daemon confirmed the cancellation");
    return ExitCode::kRefused;
  }
  return report(*outcome, std::chrono::steady_clock::now() - requested, client, options);
}

}  // namespace

void add_calibrate_command(CLI::App& app, Action& action) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate", "ask the daemon for a calibration, show what to do, print the result");
  command
      ->add_option("--body", options->start.body_id,
                   "body on the scope, the tracker's number from 0; default: the configured one")
      ->check(CLI::Range(0, 999))
      ->type_name("N");
  add_eye_options(*command, options->eye);
  add_sigma_option(*command, options->wanted, "default: the configured one");
  command
      ->add_option("--max-duration", options->start.max_duration_s,
                   "give up collecting after this; default: the configured one")
      ->check(CLI::Range(1.0, 600.0))
      ->type_name("S");
  command
      ->add_option("--timeout", options->timeout_s,
                   "wait at most this long for the result; default: the longest duration and 30 s")
      ->check(CLI::Range(1.0, 3600.0))
      ->type_name("S");
  add_save_option(*command, options->save);
  add_output_options(*command, options->output);
  add_client_options(*command, options->client);
  command->footer(
      "Ctrl-C cancels. Exit code: 0 accepted, 3 refused or cancelled, 2 no daemon, 4 no answer in "
      "time.");
  command->callback([options, &action] { action = [options] { return run_calibrate(*options); }; });
}

}  // namespace handeye::cli
