// SPDX-License-Identifier: BSD-3-Clause
#include "sim/actions/random_choice.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/vehicle/entities.hpp"

namespace sim {

namespace {

class MoveAction final : public Action {
 public:
  static constexpr const char* meaning = "puts a vehicle or an object somewhere, at rest";
  static constexpr const char* main_key = "name";
  static constexpr bool main_alone = false;

  void read(ParamReader& in, const char* main) override {
    target_.read(in, main);
    where_.read(in);
    if (in.describing()) return;
    if (!in.has("position_m") && !in.has("places") && !in.has("area_m") && !in.has("rpy_deg") && !where_.random_yaw)
      in.error("'move' needs a place: position_m, places, area_m, rpy_deg or random_yaw");
  }

  void carry_out(const ActionRun& run) const override {
    const std::string& name = target_.choose(run.random);
    const Entities& entities = run.stage.entities();
    if (const Vehicle* vehicle = entities.find_vehicle(name))
      return run.stage.move_vehicle(name, where_.choose(vehicle->X_WV(), run.random));
    const WorldObject* object = entities.find_object(name);
    if (object == nullptr) throw WorldError("there is no vehicle or object '" + name + "' to move");
    run.stage.move_object(name, where_.choose(object->X_WV(), run.random));
  }

 private:
  TargetChoice target_;
  PlaceChoice where_;
};

SHOAL_ACTION("move", MoveAction);

}  // namespace

}  // namespace sim
