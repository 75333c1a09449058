// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class ClearFaultAction final : public Action {
 public:
  static constexpr const char* meaning = "ends all faults of a device";
  static constexpr const char* main_key = "device";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, device_, "VEHICLE/DEVICE");
  }
  void check(const ActionCheck& check) override { check.device(device_); }
  void carry_out(const ActionRun& run) const override { run.stage.clear_faults(device_); }

 private:
  std::string device_;
};

SHOAL_ACTION("clear_fault", ClearFaultAction);

}  // namespace

}  // namespace sim
