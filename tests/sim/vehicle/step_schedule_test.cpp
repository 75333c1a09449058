// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "shoal/planar_lidar_t.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using test::Listener;
using test::TestWorld;

std::string lidar(const std::string& more) {
  return "        - {name: lidar, type: lidar, position_m: [0, 0, 0.3], beams: 3" + more + "}\n";
}

std::vector<std::int64_t> report_times_us(const std::string& keys, double time_s,
                                          const std::string& channel = "r1.lidar") {
  TestWorld test(test::rover_world(lidar(keys)));
  Listener<shoal::planar_lidar_t> scans(test, channel);
  test.run_for(time_s);
  std::vector<std::int64_t> times;
  for (const auto& scan : scans.take_all()) times.push_back(scan.utime - test.world.epoch_us());
  return times;
}

TEST(Schedule, SamplesAtItsRateAndPhase) {
  EXPECT_EQ(report_times_us(", rate_hz: 10, phase_s: 0.05", 0.4),
            (std::vector<std::int64_t>{50000, 150000, 250000, 350000}));
}

TEST(Schedule, ARateThatDoesNotDivideTheStepIsRightOnAverage) {
  // 30 Hz with a step of 1 ms: each sample at the first step at or after its time.
  const auto times = report_times_us(", rate_hz: 30, phase_s: 0.01", 10);
  ASSERT_EQ(times.size(), 300u);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double due_us = 10000 + static_cast<double>(k) * 1e6 / 30;
    EXPECT_GE(static_cast<double>(times[k]), due_us - 1e-3);
    EXPECT_LT(static_cast<double>(times[k]), due_us + 1000);
  }
}

TEST(Schedule, ASensorThatComesLateKeepsItsRateFromItsFirstSample) {
  TestWorld test(test::rover_world(lidar(", rate_hz: 10, phase_s: 0.05")));
  test.run_for(1.02);
  test.world.editor().remove_vehicle("r1");
  const sim::VehicleInstance again = test.loaded.config.vehicles[0];
  test.world.editor().add_vehicle(again);
  Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(0.3);
  std::vector<std::int64_t> times;
  for (const auto& scan : scans.take_all()) times.push_back(scan.utime - test.world.epoch_us());
  EXPECT_EQ(times, (std::vector<std::int64_t>{1050000, 1150000, 1250000}));
}

/// A world that restores a snapshot makes its schedule again; the other one has added to it and removed from it.
TEST(Schedule, VehiclesThatComeAndGoLeaveItAsIfMadeAnew) {
  const std::string devices = lidar(", rate_hz: 10") +
                              "        - {name: often, type: compass, rate_hz: every_step}\n"
                              "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, "
                              "track_m: 0.5}\n";
  const std::string text = test::rover_world(devices, "", "    count: 4\n    placement: {spacing_m: 2}\n");
  TestWorld test(text), other(text);
  test.run_for(0.15);
  sim::WorldEditor& editor = test.world.editor();
  sim::VehicleInstance guest = test.loaded.config.vehicles[0];
  for (const char* name : {"one", "two"}) {
    guest.name = name;
    guest.X_WV.translation() += sim::Vector3d(0, 20, 0);
    editor.add_vehicle(guest);
    test.run_for(0.013);
  }
  editor.remove_vehicle("r12");
  editor.remove_vehicle("one");
  test.run_for(0.05);
  guest.name = "three";
  guest.X_WV.translation() += sim::Vector3d(0, 20, 0);
  editor.add_vehicle(guest);
  test.run_for(0.02);
  other.world.state().restore(test.world.state().snapshot());
  EXPECT_EQ(other.world.vehicles().size(), 5u);
  for (TestWorld* each : {&test, &other}) each->run_for(0.3);
  EXPECT_EQ(test.world.state().run_hash(), other.world.state().run_hash());
  EXPECT_EQ(test.world.counts().samples, other.world.counts().samples);
}

TEST(Schedule, ARateAboveTheStepsSamplesEveryStep) {
  EXPECT_EQ(report_times_us(", rate_hz: 1e6", 0.1).size(), 100u);
}

TEST(Schedule, RateZeroSamplesEveryStep) {
  EXPECT_EQ(report_times_us(", rate_hz: every_step", 0.1).size(), 100u);
}

TEST(Schedule, PhasesOfManyVehiclesSpreadOverThePeriod) {
  TestWorld test(test::rover_world(lidar(", rate_hz: 10"), "", "    count: 100\n    placement: {spacing_m: 2}\n"));
  std::map<std::int64_t, int> reports_at;
  std::vector<std::unique_ptr<Listener<shoal::planar_lidar_t>>> listeners;
  for (int i = 1; i <= 100; ++i)
    listeners.push_back(std::make_unique<Listener<shoal::planar_lidar_t>>(test, "r1" + std::to_string(i) + ".lidar"));
  test.run_for(0.1);
  int reports = 0;
  for (const auto& listener : listeners)
    for (const auto& scan : listener->take_all()) {
      ++reports_at[scan.utime];
      ++reports;
    }
  EXPECT_NEAR(reports, 100, 1);
  for (const auto& [time, count] : reports_at) EXPECT_LE(count, 8) << time;  // of 100 in 100 slots; Poisson: 1e-6
}

TEST(Schedule, SensorLatencyDelaysTheReportNotTheSample) {
  TestWorld test(test::rover_world(lidar(", rate_hz: 10, phase_s: 0.05, latency_s: 0.02")));
  Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  test.run_for(0.069);
  EXPECT_TRUE(scans.take_all().empty());
  test.world.step();  // 0.070 s
  const auto late = scans.take_all();
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late[0].utime - test.world.epoch_us(), 50000);
}

TEST(Schedule, JitterSpreadsTheDelayEvenly) {
  TestWorld test(test::rover_world(lidar(", rate_hz: 50, phase_s: 0.02, jitter_s: 0.01")));
  Listener<shoal::planar_lidar_t> scans(test, "r1.lidar");
  double sum_s = 0;
  int count = 0;
  for (int i = 0; i < 20000; ++i) {
    test.world.step();
    for (const auto& scan : scans.take_all()) {
      const double delay_s = static_cast<double>(test.world.epoch_us() + test.world.now().count() - scan.utime) * 1e-6;
      EXPECT_LE(delay_s, 0.0101);
      sum_s += delay_s;
      ++count;
    }
  }
  ASSERT_GT(count, 990);
  // Mean 5 ms, rounded up to steps of 1 ms: 5.5 ms; sigma of the mean 2.9 ms / sqrt(1000).
  EXPECT_NEAR(sum_s / count, 0.0055, 4 * 0.0029 / std::sqrt(1000));
}

TEST(Schedule, DropoutLosesTheShareOfReportsAskedFor) {
  const auto times = report_times_us(", rate_hz: 100, dropout: 0.25", 20);
  // Binomial: 2000 * 0.75 = 1500, sigma 19.4.
  EXPECT_NEAR(static_cast<double>(times.size()), 1500, 4 * 19.4);
}

TEST(Schedule, TruthIsPublishedOnlyWhenAskedFor) {
  EXPECT_TRUE(report_times_us(", rate_hz: 10", 1, "r1.lidar.truth").empty());
  EXPECT_EQ(report_times_us(", rate_hz: 10, truth: true, dropout: 1", 1, "r1.lidar.truth").size(), 10u);
}

TEST(Schedule, ASensorTakesTheRateOfTheWorldThatASnapshotIsRestoredIn) {
  TestWorld before(test::rover_world(lidar(", rate_hz: 20, phase_s: 0")));
  before.run_for(5);
  const sim::Bytes snapshot = before.world.state().snapshot();
  for (const auto& [keys, period_us] : {std::pair{", rate_hz: 5, phase_s: 0", 200000},
                                        {", rate_hz: 50", 20000},
                                        {", rate_hz: every_step", 1000},
                                        {", rate_hz: 20, phase_s: 0", 50000}}) {
    TestWorld after(test::rover_world(lidar(keys)));
    after.world.state().restore(snapshot);
    Listener<shoal::planar_lidar_t> scans(after, "r1.lidar");
    after.run_for(1);
    std::vector<std::int64_t> times;
    for (const auto& scan : scans.take_all()) times.push_back(scan.utime - after.world.epoch_us());
    ASSERT_EQ(times.size(), 1000000u / static_cast<unsigned>(period_us)) << keys;
    EXPECT_LE(times.front(), 5000000 + period_us) << keys;
    EXPECT_EQ(times[1] - times[0], period_us) << keys;
  }
}

}  // namespace
