// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/metric_registry.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/devices/world_fixture.hpp"

namespace {

const sim::MetricRegistry& registry() {
  return sim::MetricRegistry::instance();
}

/// A type of metric, made for these tests.
struct OwnParams : sim::MetricParams {
  void read(sim::ParamReader& in) override {
    read_vehicle(in);
    read_channel(in);
    read_from_s(in);
  }
};

TEST(MetricRegistry, KeepsItsTypesInOrder) {
  sim::MetricRegistry own;
  for (const char* word : {"b", "c", "a"}) {
    sim::MetricKind kind;
    kind.word = word;
    kind.figures = {{std::string(word) + "_m", "m", "a figure"}};
    kind.make_params = [] { return std::make_shared<OwnParams>(); };
    own.add(kind);
  }
  EXPECT_THAT(own.words(), testing::ElementsAre("a", "b", "c"));
  EXPECT_EQ(own.find("d"), nullptr);
  ASSERT_NE(own.find("b"), nullptr);
  EXPECT_EQ(own.find("b")->find("b_m")->unit, "m");
  EXPECT_EQ(own.find("b")->find("a_m"), nullptr);
  EXPECT_EQ(own.of_figures({"c_m"}), own.find("c"));
  EXPECT_EQ(own.of_figures({"c_m", "a_m"}), nullptr);
  std::vector<std::string> keys;
  for (const sim::ParamInfo& key : own.find("a")->keys()) keys.push_back(key.key);
  EXPECT_THAT(keys, testing::ElementsAre("vehicle", "channel", "from_s"));
}

TEST(MetricRegistry, OnlyItsFiguresTellATypeInASummary) {
  for (const sim::MetricKind* kind : registry().all()) {
    std::set<std::string> names;
    for (const sim::FigureKind& figure : kind->figures) names.insert(figure.name);
    EXPECT_EQ(registry().of_figures(names), kind) << kind->word;
  }
}

TEST(MetricRegistry, CommonKeysSayWhatIsWrong) {
  const auto error = [](const std::string& keys) {
    return test::error_of_world(
        test::box_world("", "{step_s: 0.01}", "metrics: [{name: e, type: position_error, " + keys + "}]\n"));
  };
  EXPECT_EQ(error("vehicle: r1, channel: r1.estimate"), "");
  EXPECT_THAT(error("vehicle: '', channel: x"), testing::HasSubstr("'vehicle' must not be empty"));
  EXPECT_THAT(error("vehicle: r1, channel: ''"), testing::HasSubstr("'channel' must have 1 to 63 characters, got 0"));
  EXPECT_THAT(error("vehicle: r1, channel: " + std::string(64, 'x')),
              testing::HasSubstr("'channel' must have 1 to 63 characters, got 64"));
  EXPECT_THAT(error("vehicle: r1, channel: x, from_s: -1"), testing::HasSubstr("'from_s' must be >= 0"));
}

}  // namespace
