// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/message_text.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/vehicle/end_of_run.hpp"

namespace sim {

namespace {

class EndAction final : public Action {
 public:
  static constexpr const char* meaning = "ends the run after this step";
  static constexpr const char* main_key = "reason";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, text_, "text for the summary");
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
