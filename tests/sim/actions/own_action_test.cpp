// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

std::vector<std::string>& remembered() {
  static std::vector<std::string> lines;
  return lines;
}

/// An action in a file of its own, as a plugin brings one.
class RememberAction final : public sim::Action {
 public:
  static constexpr const char* meaning = "text that the test remembers";

  void read(sim::ParamReader& in) override {
    if (!in.describing()) in.read("remember", text_, "");
    in.read("times", times_, sim::between(1, 3), "so often");
  }
  void check(const sim::ActionCheck&) override { checked_ = true; }
  void carry_out(const sim::ActionRun& run) const override {
    EXPECT_TRUE(checked_);
    for (int i = 0; i < times_; ++i)
      remembered().push_back(run.who + ": " + text_ + " at step " + std::to_string(run.stage.clock().step_number));
  }

 private:
  std::string text_;
  int times_ = 1;
  bool checked_ = false;
};

/// Registered at the first call, as by a plugin when it is loaded.
void register_remember() {
  static const bool registered = sim::detail::add_action<RememberAction>("remember");
  EXPECT_TRUE(registered);
}

std::string world_that_remembers(const std::string& more) {
  register_remember();
  return "shoal: 1\nphysics: {step_s: 0.01}\nevents: [{name: a, at: 0.02, do: [{remember: hello" + more + "}]}]\n";
}

TEST(OwnAction, IsReadCheckedAndCarriedOutFromItsOwnFileAlone) {
  test::TestWorld test(world_that_remembers(", times: 2"));
  remembered().clear();
  for (int i = 0; i < 5; ++i) test.world.step();
  EXPECT_THAT(remembered(), testing::ElementsAre("event 'a': hello at step 2", "event 'a': hello at step 2"));
}

TEST(OwnAction, HasItsKeysCheckedAsAllKeysAre) {
  try {
    test::TestWorld test(world_that_remembers(", times: 4"));
    FAIL() << "no error";
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("event 'a': action 1: 'times' must be >= 1 and <= 3, got 4"));
  }
}

TEST(OwnAction, IsDescribedBesideTheOthers) {
  register_remember();
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  sim::ActionEntry().read(in);
  std::map<std::string, std::string> meanings;
  for (const sim::ParamInfo& info : table) meanings[info.key] = info.meaning;
  EXPECT_EQ(meanings["remember"], "text that the test remembers");
  EXPECT_EQ(meanings["times"], "remember: so often");
  EXPECT_EQ(meanings["weights"], "one_of: how often each is chosen");
}

TEST(Actions, AreAllLinkedThoughNothingCallsThem) {
  for (const char* word : {"actor", "add", "clear_fault", "end", "fault", "gravity_mps2", "log", "move", "one_of",
                           "publish", "remove", "set", "trigger"})
    EXPECT_NE(sim::ActionRegistry::instance().find(word), nullptr) << word;
}

}  // namespace
