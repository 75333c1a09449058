// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace experiment {

/// UTIAS multi-robot data set (MR.CLAM; Leung, Halpern, Barfoot and Liu, Int. J. Robotics Research 30(8), 2011).
/// Times in s since 1970, lengths in m, angles in rad.
struct MrclamData {
  struct Pose {
    double time_s = 0, x_m = 0, y_m = 0, yaw_rad = 0;
  };
  struct Odometry {
    double time_s = 0, forward_mps = 0, turn_radps = 0;
  };
  struct Measurement {
    double time_s = 0;
    int subject = 0;
    double range_m = 0, bearing_rad = 0;
  };
  struct Robot {
    std::vector<Pose> truth;
    std::vector<Odometry> odometry;
    std::vector<Measurement> measurements;  ///< with barcodes of subjects
    int unknown_barcodes = 0;               ///< measurements left out: no subject has the barcode
  };
  struct Landmark {
    int subject = 0;
    double x_m = 0, y_m = 0;
  };
  std::vector<Robot> robots;  ///< robot N, with subject number N, at N - 1
  std::vector<Landmark> landmarks;
};

// Each reads a text of rows of numbers, separated by blanks, with `#` comments.  Times must not decrease.  `file`: name
// for errors.  They throw sim::ConfigError.

/// Reads Barcodes.dat: the subjects by barcode.
std::map<int, int> parse_mrclam_barcodes(std::string_view text, const std::string& file);
/// Reads Landmark_Groundtruth.dat.
std::vector<MrclamData::Landmark> parse_mrclam_landmarks(std::string_view text, const std::string& file);
/// Reads RobotN_Groundtruth.dat.
std::vector<MrclamData::Pose> parse_mrclam_truth(std::string_view text, const std::string& file);
/// Reads RobotN_Odometry.dat.
std::vector<MrclamData::Odometry> parse_mrclam_odometry(std::string_view text, const std::string& file);
/// Reads RobotN_Measurement.dat.
void parse_mrclam_measurements(std::string_view text, const std::string& file, const std::map<int, int>& subjects,
                               MrclamData::Robot& robot);

}  // namespace experiment
