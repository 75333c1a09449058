// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/record_view.hpp"

#include <spdlog/fmt/fmt.h>

#include "sim/world_file/vehicle_loader.hpp"

namespace motion {

void RecordView::serve(bool is_paused) {
  page_.control().paused = is_paused;
  page_.serve(viewer::RunView::answering(
      [this](const std::string& command, double, const std::string& text) { return execute(command, text); }));
}

std::string RecordView::execute(const std::string& command, const std::string& text) {
  if (command == "spawn")
    throw sim::ConfigError(
        {"a motion has the vehicles of its world: only objects can be added, {add: ...}, no vehicles spawned"});
  if (command != "do") throw sim::ConfigError({"a recording is controlled by its keys"});
  const sim::ConfigNode action = sim::parse_untrusted(text, "do");
  sim::Diagnostics diagnostics;
  sim::check_untrusted(action, "", diagnostics);
  diagnostics.throw_if_any();
  recorder_.change(action);
  return fmt::format("recorded at {:.3f} s", recorder_.now_s());
}

}  // namespace motion
