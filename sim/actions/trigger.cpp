// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/script/action_registry.hpp"

namespace sim {

namespace {

class TriggerAction final : public Action {
 public:
  static constexpr const char* meaning = "fires another event now";
  static constexpr const char* main_key = "event";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read_reference(main, event_, "event", "the event");
  }
  void carry_out(const ActionRun& run) const override { run.script.trigger(event_, run.depth + 1); }
  void add_triggered(std::set<std::string>& events) const override { events.insert(event_); }

 private:
  std::string event_;
};

SHOAL_ACTION("trigger", TriggerAction);

}  // namespace

}  // namespace sim
