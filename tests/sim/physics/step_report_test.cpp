// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/step_report.hpp"

#include <gtest/gtest.h>

#include <exception>
#include <stdexcept>
#include <vector>

namespace {

sim::ContactReport contact(int first, int second, double depth_m = 0) {
  sim::ContactReport report;
  report.parts[0] = first;
  report.parts[1] = second;
  report.depth_m = depth_m;
  return report;
}

TEST(StepReport, SumsTheWorkOfTheShards) {
  sim::Shard small, large;
  small.contact_count = 3;
  small.max_rows = 12;
  large.contact_count = 5;
  large.max_rows = 200;
  large.quick = large.quick_instead = true;
  sim::StepReport report;
  report.collect(std::vector<const sim::Shard*>{&small, &large}, 30);
  EXPECT_EQ(report.counts().contacts, 8);
  EXPECT_EQ(report.counts().max_island_rows, 200);
  EXPECT_TRUE(report.counts().quick);
  EXPECT_EQ(report.quick_steps(), 1);
  report.collect(std::vector<const sim::Shard*>{&small}, 30);
  EXPECT_EQ(report.counts().max_island_rows, 30) << "of the joints";
  EXPECT_FALSE(report.counts().quick);
  EXPECT_EQ(report.quick_steps(), 1);
}

TEST(StepReport, HasTheContactsInTheOrderOfTheirParts) {
  sim::Shard first, second;
  first.contacts = {contact(0, 9), contact(4, 5, 0.1), contact(4, 5, 0.2)};
  second.contacts = {contact(0, 3), contact(2, 8)};
  sim::StepReport report;
  report.collect(std::vector<const sim::Shard*>{&first, &second}, 0);
  ASSERT_EQ(report.contacts().size(), 5u);
  EXPECT_EQ(report.contacts()[0].parts[1], 3);
  EXPECT_EQ(report.contacts()[1].parts[1], 9);
  EXPECT_EQ(report.contacts()[2].parts[0], 2);
  EXPECT_EQ(report.contacts()[3].depth_m, 0.1) << "of one pair: as they were made";
  EXPECT_EQ(report.contacts()[4].depth_m, 0.2);
}

TEST(StepReport, IsOfABrokenWorldAfterAnErrorOfOde) {
  sim::Shard failed, good;
  failed.solver_failed = true;
  failed.fault = std::make_exception_ptr(std::runtime_error("first"));
  sim::Shard later = {};
  later.fault = std::make_exception_ptr(std::logic_error("second"));
  sim::StepReport report;
  const std::vector<const sim::Shard*> stepped = {&good, &failed, &later};
  report.collect(stepped, 0);
  EXPECT_TRUE(report.broken());
  EXPECT_THROW(sim::StepReport::throw_first_fault(stepped), std::runtime_error);
  report.collect(std::vector<const sim::Shard*>{&good}, 0);
  EXPECT_TRUE(report.broken()) << "for good";
}

}  // namespace
