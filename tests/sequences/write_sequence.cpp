// SPDX-License-Identifier: BSD-3-Clause
// Writes a named sequence as a recording, for programs that read files: write_sequence NAME OUT.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "drivers/simulator/record.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/sequences/sequence.hpp"

namespace {

using namespace handeye;
using namespace handeye::sequences;

/// The true pose of every frame's time stamp, missing frames included.
void write_true_poses(const Sequence& sequence, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "timestamp_ns,qw,qx,qy,qz,x_mm,y_mm,z_mm\n";
  const simulator::EndoscopeView view(sequence.world());
  for (std::uint32_t number = 0; number < sequence.frames(); ++number) {
    const std::int64_t timestamp_ns =
        sequence.world().host_ns(view.exposed_s(number) + sequence.world().camera_delay_s);
    const Pose scene_from_eye = sequence.scene_from_eye(timestamp_ns);
    const Eigen::Quaterniond q(scene_from_eye.linear());
    const Eigen::Vector3d t = scene_from_eye.translation();
    file << fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.9g},{:.9g},{:.9g}\n", timestamp_ns,
                        q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z());
  }
  file.close();
  if (!file) throw InputError(fmt::format("{}: cannot be written", path.string()));
}

int write(int argc, char** argv) {
  std::string name;
  std::filesystem::path out;
  SequenceOptions options;
  CLI::App program("Writes a rendered sequence with known truth as a recording", "write_sequence");
  program.add_option("name", name, "plain, flicker, ...")->required();
  program.add_option("out", out, "A new folder")->required();
  program.add_option("--seed", options.seed)->capture_default_str();
  program.add_option("--duration", options.duration_s, "Seconds")->capture_default_str();
  program.add_option("--rate", options.camera_rate_hz, "Frames a second")->capture_default_str();
  program.add_option("--width", options.width, "px")->capture_default_str();
  program.add_option("--height", options.height, "px")->capture_default_str();
  CLI11_PARSE(program, argc, argv);

  const Sequence sequence(name, options);
  const auto counts = simulator::record(sequence.world(), options.duration_s, out);
  write_true_poses(sequence, out / "truth_poses.csv");
  fmt::print("{}: {} frames, {} datagrams\n", out.string(), counts.frames, counts.datagrams);
  return static_cast<int>(ExitCode::kOk);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return write(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "write_sequence: {}\n", error.what());
    return static_cast<int>(ExitCode::kInput);
  }
}
