// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/system/shoal_program.hpp"
#include "viewer/server/log_series.hpp"

// The plots of a log show what `shoal log csv` prints.

namespace {

using namespace system_test;

/// Columns of `shoal log csv`, by name; only those of numbers.
struct Table {
  std::vector<std::int64_t> utime;
  std::map<std::string, std::vector<double>> columns;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

Table csv(const std::string& log, const std::string& channel) {
  const Ended ended = run_shoal({"log", "csv", log, channel});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  std::stringstream lines(ended.output);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = split(line);
  Table table;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = split(line);
    EXPECT_EQ(cells.size(), names.size());
    table.utime.push_back(std::stoll(cells[0]));
    for (std::size_t i = 1; i < cells.size(); ++i)
      if (cells[i].front() != '"') table.columns[names[i]].push_back(std::stod(cells[i]));
  }
  return table;
}

TEST(Series, OfALogAreTheColumnsOfLogCsv) {
  const ScratchFolder folder;
  const std::string log = folder.file("run.lcm");
  const Ended run = run_shoal({"run", source("worlds/coop_land.yaml"), "--bus", "none", "--quiet", "--speed", "max",
                               "--duration", "4", "--record", log});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const viewer::LogIndex index(log);
  bridges::EventLogReader reader(log);
  int compared = 0;
  for (const char* channel : {"rover3.odometry", "rover1.gps", "rover1.lidar", "sim.state", "sim.bodies"}) {
    const Table table = csv(log, channel);
    ASSERT_GT(table.utime.size(), 3u) << channel;
    // Scalars, elements of arrays, and of arrays of arrays; of long arrays every 40th.
    std::size_t number = 0;
    for (const auto& [field, values] : table.columns) {
      if (++number > 40 && number % 40 != 0) continue;
      const viewer::SeriesRequest request{"1", channel, field, index.start_us(), index.end_us(), 4000};
      const viewer::Series series =
          viewer::read_series(reader, index, request, std::chrono::steady_clock::now() + timeout);
      ASSERT_EQ(series.values.size(), values.size()) << channel << ' ' << field;
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(series.t_us[i], table.utime[i] - index.epoch_us()) << channel << ' ' << field;
        EXPECT_TRUE(series.values[i] == values[i] || (std::isnan(series.values[i]) && std::isnan(values[i])))
            << channel << ' ' << field << ": " << series.values[i] << ' ' << values[i];
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 60);
}

}  // namespace
