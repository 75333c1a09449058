// SPDX-License-Identifier: BSD-3-Clause
#include "sim/actions/random_choice.hpp"

#include <gmock/gmock.h>

#include <set>

#include "sim/random/random.hpp"
#include "sim/script/action.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/config/read_yaml.hpp"
#include "tests/sim/director/event_worlds.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> errors_of(const std::string& yaml, sim::TargetChoice& target) {
  return test::errors_of_reading(yaml, [&](sim::ParamReader& in) {
    for (const char* name : {"ball", "crate", "cart"}) in.declare(sim::movable_kind, name);
    target.read(in, "name");
  });
}

TEST(TargetChoice, IsOneNameOrOneOfSeveral) {
  sim::TargetChoice target;
  EXPECT_THAT(errors_of("{name: ball}", target), IsEmpty());
  EXPECT_THAT(target.names, ElementsAre("ball"));
  EXPECT_THAT(errors_of("{one_of: [ball, cart]}", target), IsEmpty());
  EXPECT_THAT(target.names, ElementsAre("ball", "cart"));
}

TEST(TargetChoice, SaysWhatIsWrong) {
  for (const auto& [yaml, text] : std::map<std::string, std::string>{
           {"{}", "needs either 'name' or 'one_of'"},
           {"{name: ball, one_of: [cart]}", "needs either 'name' or 'one_of', not both"},
           {"{one_of: []}", "'one_of' must name at least one"},
           {"{name: ''}", "'name' must name a vehicle or an object"},
           {"{name: bal}", "'name' names no vehicle or object 'bal'; known vehicles or objects: ball, cart, crate"}}) {
    sim::TargetChoice target;
    EXPECT_THAT(errors_of(yaml, target), testing::Contains(HasSubstr(text))) << yaml;
  }
}

TEST(TargetChoice, DrawsEachOfSeveralAndNothingForOne) {
  sim::TargetChoice target;
  target.names = {"ball", "crate", "cart"};
  sim::Random random(1, "target"), untouched(1, "target");
  std::set<std::string> drawn;
  for (int i = 0; i < 100; ++i) drawn.insert(target.choose(random));  // one is missing with (2/3)^100
  EXPECT_EQ(drawn.size(), 3u);
  sim::Random fresh(1, "target");
  target.names = {"ball"};
  EXPECT_EQ(target.choose(fresh), "ball");
  EXPECT_EQ(fresh.uniform(), untouched.uniform());
}

using namespace event_worlds;

TEST(Events, ChooseAtRandomByTheirOwnNameWhateverElseHappens) {
  const std::string a =
      "  - {name: a, every: 0.1, do: [{move: {name: ball, places: [[1, 0, 5], [2, 0, 5], [3, 0, 5]], random_yaw: "
      "true}}]}\n";
  const auto places = [&](const std::string& others) {
    test::TestWorld test(event_world(a + others));
    std::vector<double> xs;
    for (int i = 0; i < 30; ++i) {
      test.run_for(0.1);
      xs.push_back(test.world.find_object("ball")->base().X_WB().translation().x());
    }
    return xs;
  };
  const auto alone = places("");
  EXPECT_EQ(alone, places("  - {name: b, every: 0.01, do: [{log: b}], probability: 0.5}\n"));
  EXPECT_THAT(alone, testing::Contains(1));
  EXPECT_THAT(alone, testing::Contains(2));
  EXPECT_THAT(alone, testing::Contains(3));
}

}  // namespace
