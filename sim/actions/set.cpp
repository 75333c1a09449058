// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

/// Gives a device other values while it runs.
class SetAction final : public Action {
 public:
  static constexpr const char* meaning = "VEHICLE/DEVICE, with `values: {key: value}` for keys of the device";

  void read(ParamReader& in) override {
    if (!in.describing()) in.read("set", device_, "");
    in.require("values");
    in.read_raw("values", values_, "dotted key: value");
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
