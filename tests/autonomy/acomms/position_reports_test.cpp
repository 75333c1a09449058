// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/acomms/position_reports.hpp"

#include <gtest/gtest.h>

#include "shoal/message_codec.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::PositionReports;

using test::second;

shoal::position_report_t report_at(std::int64_t utime) {
  shoal::position_report_t report{};
  report.utime = utime;
  report.vehicle = "rover1";
  report.position_m[0] = 10;
  report.position_m[1] = -5;
  report.velocity_mps[0] = 0.5;
  report.velocity_mps[1] = 1;
  report.position_std_m = 0.4;
  return report;
}

/// What the modem of a receiver publishes 20 ms after the report was made.
shoal::modem_received_t over_the_modem(const shoal::position_report_t& report, const std::string& source = "rover1") {
  const shoal::modem_send_t sent = autonomy::broadcast(report);
  shoal::modem_received_t packet{};
  packet.utime = report.utime + 20'000;
  packet.sent_utime = report.utime;
  packet.source = source;
  packet.size = sent.size;
  packet.data = sent.data;
  return packet;
}

TEST(PositionReports, CarryAPositionToTheTimeOfASighting) {
  PositionReports reports;
  reports.receive(over_the_modem(report_at(100 * second)));
  const auto neighbor = reports.take("rover1", 102 * second);
  ASSERT_TRUE(neighbor);
  EXPECT_DOUBLE_EQ(neighbor->p_W.x(), 11);
  EXPECT_DOUBLE_EQ(neighbor->p_W.y(), -3);
  EXPECT_DOUBLE_EQ(neighbor->std_m, std::hypot(0.4, 0.3 * 2));
}

TEST(PositionReports, AreUsedOnce) {
  PositionReports reports;
  reports.receive(over_the_modem(report_at(100 * second)));
  EXPECT_FALSE(reports.take("rover2", 101 * second));
  EXPECT_TRUE(reports.take("rover1", 101 * second));
  EXPECT_FALSE(reports.take("rover1", 101 * second));
}

TEST(PositionReports, WaitForASightingAfterThem) {
  PositionReports reports;
  reports.receive(over_the_modem(report_at(100 * second)));
  EXPECT_FALSE(reports.take("rover1", 100 * second - 1));
  EXPECT_TRUE(reports.take("rover1", 100 * second));
}

TEST(PositionReports, GrowTooOld) {
  PositionReports reports;
  reports.receive(over_the_modem(report_at(100 * second)));
  EXPECT_FALSE(reports.take("rover1", 103 * second + 1));
}

TEST(PositionReports, RefuseWhatCannotBeBelieved) {
  PositionReports reports;
  shoal::modem_received_t cut = over_the_modem(report_at(second));
  cut.data.pop_back();
  --cut.size;
  EXPECT_THROW(reports.receive(cut), shoal::MessageError);
  shoal::modem_received_t noise = over_the_modem(report_at(second));
  for (std::uint8_t& byte : noise.data) byte = 0xff;
  EXPECT_THROW(reports.receive(noise), shoal::MessageError);
  EXPECT_THROW(reports.receive(over_the_modem(report_at(second), "rover2")), shoal::MessageError);
  const auto with = [](auto change) {
    shoal::position_report_t report = report_at(second);
    change(report);
    return over_the_modem(report);
  };
  EXPECT_THROW(reports.receive(with([](auto& r) { r.position_std_m = 0; })), shoal::MessageError);
  EXPECT_THROW(reports.receive(with([](auto& r) { r.velocity_mps[0] = 1000; })), shoal::MessageError);
  EXPECT_THROW(reports.receive(with([](auto& r) { r.position_m[0] = std::nan(""); })), shoal::MessageError);
  shoal::modem_received_t early = over_the_modem(report_at(second));
  early.sent_utime = second - 1;
  EXPECT_THROW(reports.receive(early), shoal::MessageError);
  EXPECT_FALSE(reports.take("rover1", second));
}

}  // namespace
