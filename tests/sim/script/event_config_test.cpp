// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/event_config.hpp"

#include <gmock/gmock.h>

#include "sim/script/action.hpp"
#include "tests/sim/config/read_yaml.hpp"

namespace {

using Kind = sim::Condition::Kind;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> errors_of(const std::string& keys, sim::EventConfig& event) {
  return test::errors_of_reading("{name: a, " + keys + ", do: [{log: x}]}", [&](sim::ParamReader& in) {
    for (const char* name : {"r1", "r2"}) {
      in.declare("vehicle", name);
      in.declare(sim::movable_kind, name);
    }
    in.declare(sim::movable_kind, "crate");
    in.declare("zone", "goal");
    in.declare("event", "bell");
    event.read(in);
  });
}

sim::Condition condition(const std::string& text) {
  sim::EventConfig event;
  EXPECT_THAT(errors_of("when: " + text, event), IsEmpty()) << text;
  return event.when;
}

TEST(EventConfig, ConditionsAreSentences) {
  EXPECT_EQ(condition("r1 enters goal").kind, Kind::enters);
  EXPECT_EQ(condition("any leaves goal").kind, Kind::leaves);
  EXPECT_EQ(condition("r1 inside goal").object, "goal");
  EXPECT_EQ(condition("r1 touches crate").kind, Kind::touches);
  EXPECT_EQ(condition("crate touches any").subject, "crate");
  EXPECT_EQ(condition("message on bell.rings").subject, "bell.rings");
  EXPECT_EQ(condition("event bell fires").kind, Kind::fires);
  const sim::Condition faster = condition("r1 faster than 2.5");
  EXPECT_EQ(faster.kind, Kind::faster);
  EXPECT_EQ(faster.speed_mps, 2.5);
}

TEST(EventConfig, SaysWhatIsWrongWithACondition) {
  for (const auto& [text, error] : std::vector<std::pair<std::string, std::string>>{
           {"r1 eats goal", "'when' must be one of: "},
           {"r1 enters", "'when' must be one of: "},
           {"r3 enters goal", "'when' names no vehicle 'r3'; known vehicles: r1, r2"},
           {"r1 enters home", "'when' names no zone 'home'; known zones: goal"},
           {"crate enters goal", "'when' names no vehicle 'crate'"},
           {"event any fires", "'when' names no event 'any'"},
           {"r1 faster than light", "'faster than' must be"},
           {"message on " + std::string(64, 'x'), "a channel must have 1 to 63 characters, got 64"}}) {
    sim::EventConfig event;
    EXPECT_THAT(errors_of("when: " + text, event), ElementsAre(HasSubstr(error))) << text;
  }
}

TEST(EventConfig, FiresAtTimesInOrder) {
  sim::EventConfig event;
  EXPECT_THAT(errors_of("at: [3, 1, 2]", event), IsEmpty());
  EXPECT_THAT(event.at_s, ElementsAre(1, 2, 3));
  EXPECT_EQ(event.times, 3);
  EXPECT_TRUE(event.fires_by_itself());
  sim::EventConfig once;
  EXPECT_THAT(errors_of("at: 5", once), IsEmpty());
  EXPECT_THAT(once.at_s, ElementsAre(5));
}

TEST(EventConfig, APeriodBeginsAfterItself) {
  sim::EventConfig event;
  EXPECT_THAT(errors_of("every: 2", event), IsEmpty());
  EXPECT_EQ(event.from_s, 2);
  EXPECT_EQ(event.times, 0);
  sim::EventConfig from_zero;
  EXPECT_THAT(errors_of("every: 2, from_s: 0, until_s: 9", from_zero), IsEmpty());
  EXPECT_EQ(from_zero.from_s, 0);
  EXPECT_EQ(from_zero.until_s, 9);
}

TEST(EventConfig, HasOneReasonAndKeysThatBelongToIt) {
  for (const auto& [keys, error] : std::vector<std::pair<std::string, std::string>>{
           {"at: 1, every: 2", "needs one of 'at', 'every' and 'when', not several"},
           {"at: 1, jitter_s: 2", "'jitter_s' belongs to 'every'"},
           {"every: 1, jitter_s: 2", "'jitter_s' must not be longer than 'every'"},
           {"at: -1", "'at' must be"},
           {"probability: 1.5", "'probability' must be"}}) {
    sim::EventConfig event;
    EXPECT_THAT(errors_of(keys, event), Contains(HasSubstr(error))) << keys;
  }
}

TEST(EventConfig, WithoutAReasonOnlyOthersTriggerIt) {
  sim::EventConfig event;
  EXPECT_THAT(errors_of("delay_s: 1", event), IsEmpty());
  EXPECT_FALSE(event.fires_by_itself());
}

}  // namespace
