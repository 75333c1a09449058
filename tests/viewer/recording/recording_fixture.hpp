// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string>

#include "bridges/view/view_publisher.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"

namespace recording_fixture {

inline constexpr const char* end_of_script = "</script><script>alert(1)</script><!--";

/// A log of a ball that falls for five seconds, with an event whose text is markup.
struct Log {
  Log() {
    test::RecordedRun run(
        "shoal: 1\nname: fall\nphysics: {step_s: 0.01}\nobjects: [{name: ball, position_m: [1, 2, 200], parts: "
        "[{shape: sphere, mass_kg: 1}]}]\nevents: [{name: half, at: 1, do: [{log: \"" +
            std::string(end_of_script) + "\"}]}]\n",
        path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 0; i < 500; ++i) {
      run.world.step();
      view.after_step();
    }
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

}  // namespace recording_fixture
