// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/script/actor_config.hpp"

namespace sim {

namespace {

class ActorAction final : public Action {
 public:
  static constexpr const char* meaning = "commands an actor";
  static constexpr const char* main_key = "name";
  static constexpr bool main_alone = false;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read_reference(main, actor_, "actor", "the actor");
    in.require("command");
    in.read_choice("command", command_, actor_command_words, "new state of the actor");
  }
  void carry_out(const ActionRun& run) const override { run.script.command_actor(actor_, command_); }

 private:
  std::string actor_;
  ActorCommand command_ = ActorCommand::start;
};

SHOAL_ACTION("actor", ActorAction);

}  // namespace

}  // namespace sim
