// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/common_keys.hpp"

#include <gmock/gmock.h>

#include "tests/sim/config/read_yaml.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> version_errors(const std::string& yaml) {
  return test::errors_of_reading(yaml, [](sim::ParamReader& in) {
    int version = 1;
    sim::read_version(in, "shoal", version);
  });
}

TEST(CommonKeys, OnlyTheFirstVersionExists) {
  EXPECT_THAT(version_errors("{shoal: 1}"), IsEmpty());
  EXPECT_THAT(version_errors("{shoal: 2}"),
              ElementsAre("w.yaml:1:9: 'shoal' must be 1, got 2: the file is of a newer Shoal"));
  EXPECT_THAT(version_errors("{}"), ElementsAre(HasSubstr("'shoal'")));
}

TEST(CommonKeys, AVersionThatIsNoneIsNotCalledNewer) {
  for (const char* yaml : {"{shoal: 0}", "{shoal: -1}", "{shoal: two}", "{shoal: 1.5}", "{shoal: [1]}"})
    EXPECT_THAT(version_errors(yaml), ElementsAre(testing::Not(HasSubstr("newer")))) << yaml;
}

std::vector<sim::Vector3d> points_of(const std::string& yaml, std::size_t columns,
                                     std::vector<std::string>* errors = nullptr) {
  std::vector<sim::Vector3d> points;
  const auto found = test::errors_of_reading(
      yaml, [&](sim::ParamReader& in) { sim::read_points(in, "points", points, columns, "places"); });
  if (errors != nullptr)
    *errors = found;
  else
    EXPECT_THAT(found, IsEmpty());
  return points;
}

TEST(CommonKeys, PointsHaveTwoOrThreeNumbers) {
  EXPECT_THAT(points_of("{points: [[1, 2, 3], [4, 5, 6]]}", 3),
              ElementsAre(sim::Vector3d(1, 2, 3), sim::Vector3d(4, 5, 6)));
  EXPECT_THAT(points_of("{points: [[1, 2]]}", 2), ElementsAre(sim::Vector3d(1, 2, 0)));
  EXPECT_THAT(points_of("{}", 2), IsEmpty());
}

TEST(CommonKeys, APointOfAnotherLengthIsNamedByItsPlaceInTheList) {
  std::vector<std::string> errors;
  points_of("{points: [[1, 2, 3], [4, 5]]}", 3, &errors);
  EXPECT_THAT(errors, ElementsAre(HasSubstr("'points[2]' must be 3 numbers, got [4, 5]")));
  points_of("{points: 7}", 3, &errors);
  EXPECT_THAT(errors, ElementsAre(HasSubstr("'points' must be a list of points, got '7'")));
  points_of("{points: [[1, 2e7]]}", 2, &errors);
  EXPECT_THAT(errors, ElementsAre(HasSubstr("'points[1]")));  // farther than 1e7 m
}

}  // namespace
