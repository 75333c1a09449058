// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class ClearFaultAction final : public Action {
 public:
  static constexpr const char* meaning = "VEHICLE/DEVICE";

  void read(ParamReader& in) override {
    if (!in.describing()) in.read("clear_fault", device_, "");
  }
  void check(const ActionCheck& check) override { check.device(device_); }
  void carry_out(const ActionRun& run) const override { run.stage.clear_faults(device_); }

 private:
  std::string device_;
};

SHOAL_ACTION("clear_fault", ClearFaultAction);

}  // namespace

}  // namespace sim
