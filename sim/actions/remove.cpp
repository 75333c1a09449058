// SPDX-License-Identifier: BSD-3-Clause
#include "sim/actions/random_choice.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/vehicle/entities.hpp"

namespace sim {

namespace {

class RemoveAction final : public Action {
 public:
  static constexpr const char* meaning = "removes a vehicle or an object";
  static constexpr const char* main_key = "name";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override { target_.read(in, main); }

  void carry_out(const ActionRun& run) const override {
    const std::string& name = target_.choose(run.random);
    const Entities& entities = run.stage.entities();
    if (entities.find_vehicle(name) != nullptr) return run.stage.remove_vehicle(name);
    if (entities.find_object(name) == nullptr)
      throw WorldError("there is no vehicle or object '" + name + "' to remove");
    run.stage.remove_object(name);
  }

 private:
  TargetChoice target_;
};

SHOAL_ACTION("remove", RemoveAction);

}  // namespace

}  // namespace sim
