// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/script/action_registry.hpp"

namespace sim {

namespace {

class LogAction final : public Action {
 public:
  static constexpr const char* meaning = "writes a line to the log";
  static constexpr const char* main_key = "text";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, text_, "the line");
  }
  void carry_out(const ActionRun& run) const override { run.script.log(run.who, text_); }

 private:
  std::string text_;
};

SHOAL_ACTION("log", LogAction);

}  // namespace

}  // namespace sim
