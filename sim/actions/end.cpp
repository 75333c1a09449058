// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/message_text.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/vehicle/end_of_run.hpp"

namespace sim {

namespace {

/// Ends the run after this step.
class EndAction final : public Action {
 public:
  static constexpr const char* meaning = "the run ends after this step; text for the summary";

  void read(ParamReader& in) override {
    if (!in.describing()) in.read("end", text_, "");
    in.read("passed", passed_, "whether the run passed");
  }
  void carry_out(const ActionRun& run) const override { run.stage.end({printable(text_), passed_}); }

 private:
  std::string text_;
  bool passed_ = true;
};

SHOAL_ACTION("end", EndAction);

}  // namespace

}  // namespace sim
