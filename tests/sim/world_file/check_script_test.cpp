// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/check_script.hpp"

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

using testing::HasSubstr;

std::string error_of(const std::string& objects, const std::string& script) {
  return test::error_of_world("shoal: 1\nphysics: {step_s: 0.01}\nobjects: [" + objects + "]\n" + script);
}

const std::string cart = "{name: cart, parts: [{shape: box, mass_kg: 1}]}";
const std::string ride = "{name: ride, object: cart, points: [[0, 0, 1], [1, 0, 1]]}";

TEST(CheckScript, AnActorMovesOneObjectOfItsOwn) {
  EXPECT_EQ(error_of(cart, "actors: [" + ride + "]\n"), "");
  EXPECT_THAT(error_of("{name: cart, count: 2, parts: [{shape: box}]}", "actors: [" + ride + "]\n"),
              HasSubstr("object"));
  EXPECT_THAT(error_of(cart, "actors: [" + ride + ", {name: other, object: cart, points: [[0, 0, 1], [1, 0, 1]]}]\n"),
              HasSubstr("actor 'other': object 'cart' is already moved by another actor"));
}

TEST(CheckScript, AnEventRepeatsNoFasterThanTheSteps) {
  EXPECT_EQ(error_of("", "events: [{name: a, every: 0.01, do: [{log: a}]}]\n"), "");
  EXPECT_THAT(error_of("", "events: [{name: a, every: 0.009, do: [{log: a}]}]\n"),
              HasSubstr("event 'a': 'every' must be at least a step of 0.01 s"));
}

TEST(CheckScript, ActionsWithinActionsAreCheckedToo) {
  EXPECT_THAT(error_of("", "events: [{name: a, at: 0, do: [{one_of: [[{log: x}], [{clear_fault: r1/gps}]]}]}]\n"),
              HasSubstr("there is no device 'r1/gps'; devices are named VEHICLE/DEVICE"));
}

}  // namespace
