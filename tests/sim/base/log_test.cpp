// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/log.hpp"

#include <gtest/gtest.h>

#include "tests/sim/medium/log_capture.hpp"

namespace {

/// Captures "LEVEL TEXT" of what is logged.
class Log : public testing::Test {
 protected:
  Log() { spdlog::default_logger()->set_pattern("%l %v"); }
  ~Log() override { sim::set_log_level("info"); }

  test_support::LogCapture log_;
};

TEST_F(Log, ShowsMessagesFromItsLevelOn) {
  const auto log_all = [] {
    sim::log_debug("{} of debug", 1);
    sim::log_info("{} of info", 2);
    sim::log_warn("{} of warn", 3);
    sim::log_error("{} of error", 4);
  };
  sim::set_log_level("off");
  log_all();
  EXPECT_EQ(log_.text(), "");
  sim::set_log_level("warn");
  log_all();
  const std::string warnings = "warning 3 of warn\nerror 4 of error\n";
  EXPECT_EQ(log_.text(), warnings);
  EXPECT_TRUE(sim::log_shows(sim::LogLevel::error));
  EXPECT_FALSE(sim::log_shows(sim::LogLevel::info));
  sim::set_log_level("debug");
  log_all();
  EXPECT_EQ(log_.text(), warnings + "debug 1 of debug\ninfo 2 of info\n" + warnings);
}

TEST_F(Log, DoesNotTakeBracesInValuesForPlacesOfValues) {
  sim::log_warn("{}", "name '{x}' {}");
  EXPECT_EQ(log_.text(), "warning name '{x}' {}\n");
}

}  // namespace
