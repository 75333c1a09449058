// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiment/replay/replay.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"

namespace test {

inline constexpr std::int64_t steps = 300;

/// One rover with a noisy IMU and a wall before it; steps of 0.01 s, a hash every 50.
inline std::string driven_world(const std::string& more = "") {
  return "shoal: 1\nname: testing ground\nrun: {seed: 3, hash_every_steps: 50}\nphysics: {step_s: 0.01}\n"
         "objects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n"
         "  - {name: crate, position_m: [3, 0, 0.5], parts: [{shape: box, mass_kg: 5}]}\n"
         "vehicles:\n  - {name: r1, file: rover.yaml}\n" +
         more;
}

inline shoal::twist_command_t forward(double mps) {
  shoal::twist_command_t command{};
  command.forward_mps = mps;
  return command;
}

class ReplayTest : public testing::Test {
 protected:
  /// A client drives: ten messages a second.
  void record(const std::string& yaml, const std::function<void(RecordedRun&, std::int64_t)>& more = {}) {
    RecordedRun run(yaml, log);
    run.run(steps, [&](std::int64_t step) {
      if (step % 10 == 0) run.send("r1.drive.cmd", forward(0.5 + 0.001 * static_cast<double>(step)));
      if (more) more(run, step);
    });
    state_hash = run.world.state().hash();
  }

  /// What is on the log up to a byte is another log.
  void cut(const std::string& whole, std::uintmax_t bytes) {
    log = folder.file("cut.lcm");
    std::filesystem::copy_file(whole, log, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(log, bytes);
  }

  experiment::ReplayOutcome again(const std::vector<std::string>& sets = {}) const {
    experiment::ReplayOptions options;
    options.log = log;
    options.load.sets = sets;
    options.quiet = true;
    options.threads = 1;
    return experiment::replay(options);
  }

  std::string error() const {
    try {
      again();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  }

  test_support::ScratchFolder folder;
  std::string log = folder.file("run.lcm");
  std::uint64_t state_hash = 0;
};

}  // namespace test
