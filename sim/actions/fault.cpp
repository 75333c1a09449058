// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/fault.hpp"

#include "sim/device/device_registry.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class FaultAction final : public Action {
 public:
  static constexpr const char* meaning = "sets a fault of a device";
  static constexpr const char* main_key = "device";
  static constexpr bool main_alone = false;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, device_, "VEHICLE/DEVICE");
    fault_.read(in);
  }

  void check(const ActionCheck& check) override {
    const NamedDevice found = check.device(device_);
    if (found.device == nullptr) return;
    const std::string misfit = fault_misfit(*found.device->device_type, fault_);
    if (!misfit.empty()) check.error("device '" + device_ + "': " + misfit);
  }

  void carry_out(const ActionRun& run) const override { run.stage.set_fault(device_, fault_); }

 private:
  std::string device_;
  FaultConfig fault_;
};

SHOAL_ACTION("fault", FaultAction);

}  // namespace

}  // namespace sim
