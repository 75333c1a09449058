// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/script/action_registry.hpp"

namespace sim {

namespace {

/// Lets another event fire.
class TriggerAction final : public Action {
 public:
  static constexpr const char* meaning = "event that fires now";

  void read(ParamReader& in) override {
    if (!in.describing()) in.read_reference("trigger", event_, "event", "");
  }
  void carry_out(const ActionRun& run) const override { run.script.trigger(event_, run.depth + 1); }

 private:
  std::string event_;
};

SHOAL_ACTION("trigger", TriggerAction);

}  // namespace

}  // namespace sim
