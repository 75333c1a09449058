// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class SetAction final : public Action {
 public:
  static constexpr const char* meaning = "changes keys of a device while it runs";
  static constexpr const char* main_key = "device";
  static constexpr bool main_alone = false;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, device_, "VEHICLE/DEVICE");
    in.require("values");
    in.read_raw("values", values_, "dotted key of the device: value");
  }

  void check(const ActionCheck& check) override {
    const NamedDevice found = check.device(device_);
    if (found.device != nullptr)
      changed_device(*found.device, *found.vehicle, check.world(), values_, check.entry().who, check.diagnostics());
  }

  void carry_out(const ActionRun& run) const override {
    Diagnostics diagnostics;
    run.stage.change_device(device_, values_, diagnostics);
    diagnostics.throw_if_any();
  }

 private:
  std::string device_;
  ConfigNode values_;
};

SHOAL_ACTION("set", SetAction);

}  // namespace

}  // namespace sim
