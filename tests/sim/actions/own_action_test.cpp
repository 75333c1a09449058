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

/// An action in its own file, as a plugin brings one.
class RememberAction final : public sim::Action {
 public:
  static constexpr const char* meaning = "keeps a text for the test";
  static constexpr const char* main_key = "text";
  static constexpr bool main_alone = true;

  void read(sim::ParamReader& in, const char* main) override {
    in.require(main);
    in.read(main, text_, "the text");
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

std::string world_that_remembers(const std::string& value) {
  register_remember();
  return "shoal: 1\nphysics: {step_s: 0.01}\nevents: [{name: a, at: 0.02, do: [{remember: " + value + "}]}]\n";
}

/// The error of the world, without the place.
std::string error_of(const std::string& value) {
  try {
    test::TestWorld test(world_that_remembers(value));
  } catch (const sim::ConfigError& error) {
    return error.lines().front().substr(error.lines().front().find("event 'a'"));
  }
  return "no error";
}

TEST(OwnAction, IsReadCheckedAndCarriedOutFromItsOwnFileAlone) {
  test::TestWorld test(world_that_remembers("{text: hello, times: 2}"));
  remembered().clear();
  for (int i = 0; i < 5; ++i) test.world.step();
  EXPECT_THAT(remembered(), testing::ElementsAre("event 'a': hello at step 2", "event 'a': hello at step 2"));
}

TEST(OwnAction, HasItsKeysInAnyOrderAndItsMainValueAloneAsWell) {
  for (const char* value : {"{times: 1, text: hello}", "hello"}) {
    test::TestWorld test(world_that_remembers(value));
    remembered().clear();
    for (int i = 0; i < 5; ++i) test.world.step();
    EXPECT_THAT(remembered(), testing::ElementsAre("event 'a': hello at step 2")) << value;
  }
}

TEST(OwnAction, HasItsKeysCheckedAsAllKeysAre) {
  EXPECT_EQ(error_of("{text: hello, times: 4}"), "event 'a': action 1: remember: 'times' must be >= 1 and <= 3, got 4");
  EXPECT_EQ(error_of("{times: 2}"), "event 'a': action 1: remember: missing key 'text'");
  EXPECT_EQ(error_of("[hello]"), "event 'a': action 1: 'remember' must be text, got [hello]");
}

TEST(OwnAction, IsDescribedBesideTheOthers) {
  register_remember();
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  std::vector<sim::ActionEntry> none;
  sim::read_actions(in, "do", none, "");
  ASSERT_EQ(table.size(), 1u);
  EXPECT_TRUE(table[0].one_key);
  std::map<std::string, sim::ParamInfo> words;
  for (const sim::ParamInfo& info : table[0].children) words[info.key] = info;
  EXPECT_EQ(words["remember"].meaning, "keeps a text for the test");
  EXPECT_EQ(words["remember"].type, "text or map");
  ASSERT_EQ(words["remember"].children.size(), 2u);
  EXPECT_EQ(words["remember"].children[0].key, "text");
  EXPECT_TRUE(words["remember"].children[0].required);
  EXPECT_EQ(words["remember"].children[1].meaning, "so often");
  EXPECT_EQ(words["publish"].type, "map");
  EXPECT_EQ(words["one_of"].type, "list of lists or map");
}

TEST(Actions, AreAllLinkedThoughNothingCallsThem) {
  for (const char* word : {"actor", "add", "clear_fault", "end", "fault", "gravity_mps2", "log", "move", "one_of",
                           "publish", "remove", "set", "trigger"})
    EXPECT_NE(sim::ActionRegistry::instance().find(word), nullptr) << word;
}

}  // namespace
