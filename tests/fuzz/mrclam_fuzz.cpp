// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/mrclam_data.hpp"
#include "sim/config/diagnostics.hpp"
#include "tests/fuzz/fuzz_target.hpp"

// Each file of a MR.CLAM data set.

SHOAL_FUZZ_TARGET(mrclam) {
  const std::string_view text = fuzz::text_of(input);
  fuzz::allow<sim::ConfigError>([&] { experiment::parse_mrclam_barcodes(text, "Barcodes.dat"); });
  fuzz::allow<sim::ConfigError>([&] { experiment::parse_mrclam_landmarks(text, "Landmark_Groundtruth.dat"); });
  fuzz::allow<sim::ConfigError>([&] { experiment::parse_mrclam_odometry(text, "Robot1_Odometry.dat"); });
  fuzz::allow<sim::ConfigError>([&] {
    fuzz::require(!experiment::parse_mrclam_truth(text, "Robot1_Groundtruth.dat").empty(), "a robot has a pose");
  });
  fuzz::allow<sim::ConfigError>([&] {
    experiment::MrclamData::Robot robot;
    experiment::parse_mrclam_measurements(text, "Robot1_Measurement.dat", {{5, 1}, {14, 2}, {72, 6}}, robot);
    double before_s = 0;
    for (const auto& measurement : robot.measurements) {
      fuzz::require(measurement.time_s >= before_s && measurement.subject > 0, "measurements in order, of subjects");
      before_s = measurement.time_s;
    }
  });
}
