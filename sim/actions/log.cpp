// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/script/action_registry.hpp"

namespace sim {

namespace {

class LogAction final : public Action {
 public:
  static constexpr const char* meaning = "text for the log";

  void read(ParamReader& in) override {
    if (!in.describing()) in.read("log", text_, "");
  }
  void carry_out(const ActionRun& run) const override { run.script.log(run.who, text_); }

 private:
  std::string text_;
};

SHOAL_ACTION("log", LogAction);

}  // namespace

}  // namespace sim
