// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include "experiment/replay/replay.hpp"

namespace experiment {

int ReplayOutcome::exit_code() const {
  if (first) return 1;
  return complete ? 0 : 4;
}

std::string ReplayOutcome::to_text() const {
  std::string text;
  if (!world.empty()) text += "World (- in the log, + here):\n";
  for (const std::string& line : world) text += "  " + line + "\n";
  if (first) {
    text += fmt::format("differs first at step {} ({:.3f} s) of {}:\n", first->step,
                        static_cast<double>(first->step) * step_s, begin_step + steps);
    for (const std::string& what : first->what) text += "  " + what + "\n";
    text += motion.empty() ? "no difference of motion was seen\n" : "motion differs first at " + motion + "\n";
  } else {
    const std::string from = begin_step > 0 ? fmt::format("from step {}; ", begin_step) : "";
    text += fmt::format("equal for {} steps ({}{} hashes, {} messages)\n", steps, from, hashes, messages);
  }
  text += fmt::format("{:.3f} s in {:.2f} s: {:.1f} times real time\n", sim_time_s, wall_s,
                      wall_s > 0 ? sim_time_s / wall_s : 0.0);
  for (const std::string& note : notes) text += "note: " + note + "\n";
  return text;
}

}  // namespace experiment
