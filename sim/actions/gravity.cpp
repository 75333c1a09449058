// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/message_text.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class GravityAction final : public Action {
 public:
  static constexpr const char* meaning = "sets the gravity of the world";
  static constexpr const char* main_key = "value";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, gravity_mps2_, between(-1000, 1000), "m/s^2 downwards, from now on");
  }

  void check(const ActionCheck& check) override {
    if (!check.world().medium.water) return;
    check.error("'gravity_mps2' cannot change in a world with water: pressure, waves and published weights are for " +
                number_text(check.world().physics.gravity_mps2) + " m/s^2, with which the world starts");
  }

  void carry_out(const ActionRun& run) const override { run.stage.set_gravity(gravity_mps2_); }

 private:
  double gravity_mps2_ = 0;
};

SHOAL_ACTION("gravity_mps2", GravityAction);

}  // namespace

}  // namespace sim
