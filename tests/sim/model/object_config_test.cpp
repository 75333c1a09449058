// SPDX-License-Identifier: BSD-3-Clause
#include "sim/model/object_config.hpp"

#include <gmock/gmock.h>

#include "tests/sim/config/read_yaml.hpp"

namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> errors_of(const std::string& yaml, sim::ObjectConfig& object) {
  return test::errors_of_reading(yaml, [&](sim::ParamReader& in) {
    in.declare("material", "default");
    in.declare("category", "solid");
    object.read(in);
  });
}

TEST(ObjectConfig, PartsAloneAreTheBodyOfTheObject) {
  sim::ObjectConfig object;
  EXPECT_THAT(errors_of("{name: crate, position_m: [1, 2, 3], parts: [{shape: box, mass_kg: 1}]}", object), IsEmpty());
  ASSERT_EQ(object.bodies.size(), 1u);
  EXPECT_EQ(object.bodies.front().name, "body");
  EXPECT_EQ(object.bodies.front().parts.size(), 1u);
}

TEST(ObjectConfig, HasEitherPartsOrBodies) {
  const std::string parts = "parts: [{shape: box, mass_kg: 1}]", bodies = "bodies: [{name: b, " + parts + "}]";
  for (const auto& [keys, text] : std::vector<std::pair<std::string, std::string>>{
           {"", "needs either 'parts' or 'bodies'"},
           {parts + ", " + bodies, "needs either 'parts' or 'bodies', not both"},
           {"parts: []", "'parts' must have at least one part"},
           {parts + ", self_collision: true", "'self_collision' goes with 'bodies'"},
           {bodies + ", fixed: true", "'fixed' needs 'parts'"}}) {
    sim::ObjectConfig object;
    EXPECT_THAT(errors_of("{name: crate, " + keys + "}", object), Contains(HasSubstr(text))) << keys;
  }
}

TEST(ObjectConfig, KeywordsAreNoNames) {
  for (const char* name : {"any", "world", "sim"}) {
    sim::ObjectConfig object;
    EXPECT_THAT(errors_of(std::string("{name: ") + name + ", parts: [{shape: box, mass_kg: 1}]}", object),
                Contains(HasSubstr("cannot be a name: it is a keyword")))
        << name;
  }
}

TEST(ObjectConfig, WhatIsHeldCannotBeLed) {
  sim::ObjectConfig object;
  object.bodies.resize(1);
  EXPECT_EQ(object.error_of_leading(), "");
  object.fixed = true;
  EXPECT_EQ(object.error_of_leading(), "is fixed and cannot be moved");
  object.fixed = false;
  object.joints.resize(1);
  object.joints.front().bodies = {"body", "world"};
  EXPECT_EQ(object.error_of_leading(), "has a joint to 'world' and cannot be moved");
}

}  // namespace
