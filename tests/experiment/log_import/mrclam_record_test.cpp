// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/log_import/mrclam_record.hpp"

#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bridges/log/event_log.hpp"
#include "experiment/log_score/log_score.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/swarm_position_t.hpp"
#include "sim/config/diagnostics.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

constexpr double start_s = 1248272272;

/// Two robots for 10 s: the first goes east at 0.1 m/s and sees the second, which stands, and landmark 6.
class MrclamTest : public testing::Test {
 protected:
  MrclamTest() {
    write("Barcodes.dat", "# Subject # Barcode #\n1 5\n2 14\n6 72\n");
    write("Landmark_Groundtruth.dat", "6 3.0 4.0 0.0001 0.0001\n");
    std::string east, still, odometry;
    for (int i = 0; i <= 100; ++i) {
      east += fmt::format("{:.3f}\t{:.4f}\t2.0\t0.0\n", start_s + 0.1 * i, 1 + 0.01 * i);
      still += fmt::format("{:.3f}\t5.0\t2.0\t1.5\n", start_s + 0.1 * i);
      odometry += fmt::format("{:.3f}\t0.1\t0.0\n", start_s + 0.1 * i);
    }
    write("Robot1_Groundtruth.dat", "# t x y theta\n" + east);
    write("Robot2_Groundtruth.dat", still);
    write("Robot1_Odometry.dat", odometry);
    write("Robot2_Odometry.dat", "");
    write("Robot1_Measurement.dat", fmt::format("{:.3f} 14 4.0 0.1\n{:.3f} 72 2.5 -0.2\n{:.3f} 999 2.5 0\n",
                                                start_s + 1, start_s + 2, start_s + 3));
    write("Robot2_Measurement.dat", "");
  }
  void write(const std::string& file, const std::string& text) { std::ofstream(folder_.file(file)) << text; }
  experiment::MrclamData read() { return experiment::read_mrclam(folder_.file(".")); }
  /// Messages of a channel in the record.
  template <typename Message>
  std::vector<Message> messages_of(const std::string& channel) {
    std::vector<Message> messages;
    bridges::EventLogReader log(folder_.file("run.lcm"));
    while (const auto event = log.next())
      if (event->channel == channel) messages.push_back(shoal::decode<Message>(event->payload, shoal::Finite::any));
    return messages;
  }

  test_support::ScratchFolder folder_;
};

TEST_F(MrclamTest, IsReadWithSubjectsInPlaceOfBarcodes) {
  const experiment::MrclamData data = read();
  ASSERT_EQ(data.robots.size(), 2u);
  EXPECT_EQ(data.robots[0].truth.size(), 101u);
  ASSERT_EQ(data.robots[0].measurements.size(), 2u);
  EXPECT_EQ(data.robots[0].measurements[0].subject, 2);
  EXPECT_EQ(data.robots[0].measurements[1].subject, 6);
  EXPECT_EQ(data.robots[0].unknown_barcodes, 1);
  EXPECT_EQ(data.landmarks.size(), 1u);
}

TEST_F(MrclamTest, BecomesARecordThatScoresEstimates) {
  const experiment::MrclamRecord record = experiment::write_mrclam_record(read(), folder_.file("run.lcm"), false);
  EXPECT_NEAR(record.duration_s, 10, 1e-9);
  EXPECT_EQ(record.measurements, 2u);
  const auto odometry = messages_of<shoal::odometry_t>("robot1.odometry");
  ASSERT_GE(odometry.size(), 99u);
  EXPECT_NEAR(odometry[50].x_m, 0.5, 1e-6);
  EXPECT_EQ(odometry[50].utime, static_cast<std::int64_t>((start_s + 5) * 1e6));
  const auto seen = messages_of<shoal::swarm_position_t>("robot1.swarm_position");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].vehicle[0], "robot2");
  EXPECT_NEAR(seen[0].relative_m[0][1], 4 * std::sin(0.1), 1e-9);
  EXPECT_EQ(seen[1].vehicle[0], "landmark6");
  // An estimate that is 0.3 m north of the true track.
  write("mine.csv", fmt::format("t,x,y\n{:.1f},1.5,2.3\n{:.1f},1.8,2.3\n", start_s + 5, start_s + 8));
  experiment::LogScoreOptions options;
  options.log = folder_.file("run.lcm");
  options.estimate = folder_.file("mine.csv");
  options.metric = "robot1";
  options.quiet = true;
  EXPECT_NEAR(experiment::score_log(options).figures.at("robot1.rms_m"), 0.3, 1e-3);
}

TEST_F(MrclamTest, ARobotIsScoredUntilItsTruthEnds) {
  std::string still;
  for (int i = 0; i <= 60; ++i) still += fmt::format("{:.3f} 5.0 2.0 1.5\n", start_s + 0.1 * i);
  write("Robot2_Groundtruth.dat", still);
  const experiment::MrclamData data = read();
  const std::string world = experiment::mrclam_world(data);
  EXPECT_THAT(world, HasSubstr("channel: robot2.estimate, until_s: 6.00}"));
  EXPECT_THAT(world, HasSubstr("channel: robot1.estimate}"));
  experiment::write_mrclam_record(data, folder_.file("run.lcm"), false);
  // 0.4 m wrong while there is a truth; at 8 s its place is unknown.
  write("mine.csv", fmt::format("t,x,y\n{:.1f},5.4,2\n{:.1f},1,2\n", start_s + 5, start_s + 8));
  experiment::LogScoreOptions options;
  options.log = folder_.file("run.lcm");
  options.estimate = folder_.file("mine.csv");
  options.metric = "robot2";
  options.quiet = true;
  const experiment::LogScore score = experiment::score_log(options);
  EXPECT_NEAR(score.figures.at("robot2.rms_m"), 0.4, 1e-6);
  EXPECT_EQ(score.figures.at("robot2.samples"), 1);
  EXPECT_NEAR(score.figures.at("robot2.max_gap_s"), 5, 0.1);  // from 0 to 5 s; from there to the end of the truth 1 s
}

TEST_F(MrclamTest, BeginsWhenThePlacesOfAllRobotsAreKnown) {
  std::string still;
  for (int i = 32; i <= 100; ++i) still += fmt::format("{:.3f} 5.0 2.0 1.5\n", start_s + 0.1 * i);
  write("Robot2_Groundtruth.dat", still);
  const experiment::MrclamRecord record = experiment::write_mrclam_record(read(), folder_.file("run.lcm"), false);
  EXPECT_NEAR(record.duration_s, 7, 1e-9);
  // Robot 1 is at x = 1.3 m then, and its dead reckoning begins.
  EXPECT_THAT(experiment::mrclam_world(read()), HasSubstr("name: robot1, position_m: [1.300000, 2.000000, 0]"));
  const auto odometry = messages_of<shoal::odometry_t>("robot1.odometry");
  ASSERT_FALSE(odometry.empty());
  EXPECT_EQ(odometry.front().utime, static_cast<std::int64_t>((start_s + 3) * 1e6));
  EXPECT_NEAR(odometry.front().x_m, 0, 1e-9);
  EXPECT_NEAR(odometry.back().x_m, 0.7, 0.011);  // the last message is up to a step before the end
}

TEST_F(MrclamTest, RefusesWhatItCannotUse) {
  const auto error = [&](const std::string& file, const std::string& text) -> std::string {
    std::ifstream old(folder_.file(file));
    const std::string before((std::istreambuf_iterator<char>(old)), {});
    write(file, text);
    std::string what = "none";
    try {
      read();
    } catch (const std::exception& problem) {
      what = problem.what();
    }
    write(file, before);
    return what;
  };
  EXPECT_THAT(error("Barcodes.dat", "1 5\n2 5\n"), HasSubstr("Barcodes.dat:2:3: each barcode must be of one subject"));
  EXPECT_THAT(error("Robot1_Groundtruth.dat", "# no pose\n"), HasSubstr("Groundtruth.dat:1:1: must have a pose"));
  EXPECT_THAT(error("Robot1_Groundtruth.dat", "1 2 3\n"), HasSubstr(":1:1: must have 4 columns, got 3"));
  EXPECT_THAT(error("Robot1_Odometry.dat", "5 0 0\n4 0 0\n"), HasSubstr("Odometry.dat:2:1: times must not decrease"));
  EXPECT_THAT(error("Robot1_Measurement.dat", "5 5 -1 0\n"), HasSubstr(":1:5: a range must be a number from 0"));
  EXPECT_THAT(error("Robot2_Groundtruth.dat", "1248272270 5 2 0\n1248272271.5 5 2 0\n"),
              HasSubstr("Robot2_Groundtruth.dat: must have poses after 1248272272 s, when the last robot begins"));
  std::filesystem::remove(folder_.file("Robot2_Odometry.dat"));
  EXPECT_THAT(error("Barcodes.dat", "1 5\n"), HasSubstr("Robot2_Odometry.dat"));
}

TEST_F(MrclamTest, NoRobotIsLeftOutForAMissingFile) {
  write("Robot4_Odometry.dat", "");
  write("Robot4_Odometry.dat.bak", "");
  write("Robot5_notes.dat", "");
  try {
    read();
    FAIL();
  } catch (const std::exception& problem) {
    EXPECT_THAT(problem.what(), HasSubstr("Robot3_Groundtruth.dat: cannot be read: No such file"));
  }
}

}  // namespace
