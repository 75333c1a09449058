// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace experiment {

/// Text file of a data set, with comments at its start.
struct MrclamFile {
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  /// Throws std::runtime_error with path and reason.
  MrclamFile(std::string path_of_file, const std::string& comment);
  void write(const std::string& text);
  /// Throws std::runtime_error when the file could not be written.
  void close();

  std::string path;
  std::unique_ptr<std::FILE, Closer> file;
};

/// Writer of the poses of a robot, `t x y theta`, in the form of RobotN_Groundtruth.dat.
class MrclamPoses {
 public:
  /// `robot`: its name, for a comment.  Throws std::runtime_error with path and reason.
  MrclamPoses(const std::string& path, const std::string& robot);
  void add(double time_s, double x_m, double y_m, double yaw_rad);
  /// Throws std::runtime_error when the file could not be written.
  void close();

 private:
  MrclamFile file_;
};

/// Writer of a run in the form of the UTIAS multi-robot data sets (MR.CLAM; Leung, Halpern, Barfoot and Liu, Int. J.
/// Robotics Research 30(8), 2011): Barcodes.dat, Landmark_Groundtruth.dat and, for each robot N from 1 on,
/// RobotN_Groundtruth.dat (t x y theta), RobotN_Odometry.dat (t v w) and RobotN_Measurement.dat (t barcode range
/// bearing).  Times in s, lengths in m, angles in rad, separated by tabs.  There are no landmarks.
class MrclamWriter {
 public:
  /// `robots`: their names, for comments.  Creates the folder.  Throws std::runtime_error with path and reason.
  MrclamWriter(const std::string& directory, const std::vector<std::string>& robots);
  // `robot`: index from 0.
  void add_truth(int robot, double time_s, double x_m, double y_m, double yaw_rad);
  void add_odometry(int robot, double time_s, double forward_mps, double turn_radps);
  void add_measurement(int robot, double time_s, int seen, double range_m, double bearing_rad);
  /// Throws std::runtime_error when a file could not be written.
  void close();

  /// Barcode of a robot: those of the data sets for the first five.
  static int barcode_of(int robot);

 private:
  struct Robot {
    MrclamPoses truth;
    MrclamFile odometry, measurement;
  };

  std::vector<Robot> robots_;
};

}  // namespace experiment
