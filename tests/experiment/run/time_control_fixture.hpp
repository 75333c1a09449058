// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "experiment/run/time_control.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/run_parts_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace test {

/// Notes what a run would do when its world moves in time.
struct NotedTimeline final : experiment::Timeline {
  void leave_branch(std::int64_t to_step, bool) override {
    if (refuses) throw std::runtime_error("the record cannot branch");
    done.push_back("leave for " + std::to_string(to_step));
  }
  void hold_here() override { done.emplace_back("hold"); }
  void start_branch(bool) override { done.emplace_back("start"); }

  std::vector<std::string> done;
  bool refuses = false;
};

/// A crate that falls in steps of 0.01 s, and the control of its time.
struct ControlledRun {
  explicit ControlledRun(const std::string& resolved_world = "name: well\n", double rewind_s = 10)
      : options{.rewind_s = rewind_s,
                .directory = folder.file("snapshots"),
                .resolved_world = resolved_world,
                .version = "1"} {
    time.after_step();  // before the first step
  }
  void run_to(std::int64_t step) {
    while (world.step_number() < step) {
      world.step();
      scoring.after_step();
      time.after_step();
    }
  }
  std::uint64_t hash() { return world.state().hash(); }

  test_support::ScratchFolder folder;
  experiment::TimeControl::Options options;
  PartsOfARun run;
  sim::World& world = run.parts.world;
  sim::RunControl& control = run.parts.control;
  experiment::Scoring scoring{world};
  experiment::RunInputs inputs{run.parts.buses, run.parts.journal, run.parts.service, run.parts.lockstep};
  NotedTimeline timeline;
  experiment::TimeControl time{world, control, scoring, run.parts.service, inputs, options, timeline};
};

}  // namespace test
