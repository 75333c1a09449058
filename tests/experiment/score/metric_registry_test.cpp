// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "experiment/score/metric.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/experiment/score/metric_worlds.hpp"

namespace {

using namespace metric_worlds;

TEST(Figures, OfAMetricAreThoseThatItsTypeNames) {
  MetricWorld world(
      "  - {name: a, type: position_error, vehicle: r1, channel: est}\n"
      "  - {name: b, type: position_error, vehicle: r1, channel: est2}\n"
      "  - {name: c, type: consistency, vehicle: r1, channel: est}\n"
      "  - {name: d, type: distance, vehicle: r1}\n"
      "  - {name: e, type: delivery, vehicle: r1}\n"
      "  - {name: f, type: bytes_per_metre, metric: a, against: b}\n"
      "  - {name: g, type: mission_time, when: any faster than 1}\n"
      "  - {name: h, type: collisions}\n"
      "  - {name: i, type: messages, channel: hello}\n"
      "  - {name: j, type: tilt, vehicle: r1}\n");
  std::vector<std::string> named, given;
  for (const sim::MetricConfig& metric : world.test.world.config().metrics)
    for (const std::string& figure : metric.figures()) named.push_back(figure);
  for (const auto& [figure, value] : world.scoring.figures()) given.push_back(figure);
  std::sort(named.begin(), named.end());
  EXPECT_EQ(named, given);
}

}  // namespace
