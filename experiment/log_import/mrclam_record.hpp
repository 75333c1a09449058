// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/trajectory/mrclam_data.hpp"

namespace experiment {

/// Reads the files of a data set: Barcodes.dat, Landmark_Groundtruth.dat, and for N from 1 on, as long as there is a
/// RobotN_Groundtruth.dat, RobotN_Odometry.dat and RobotN_Measurement.dat.  Throws sim::ConfigError,
/// also when the truth of a robot ends before that of another begins, and std::runtime_error when a file cannot be
/// read.
MrclamData read_mrclam(const std::string& directory);

/// Returns the world of a data set: its robots as kinematic bodies, `robot1` and so on, landmarks as objects,
/// `landmark6`, and the metric of a position_error for each robot, with its name.  It begins in the second in which the
/// truth of the last robot does.  A robot whose truth ends before the others' stays where it was, and its metric has
/// `until_s`.
std::string mrclam_world(const MrclamData& data);

/// Contents of a record.
struct MrclamRecord {
  double duration_s = 0;
  std::size_t odometries = 0, measurements = 0;
};

/// Writes a data set as the record of a run in which its robots move along their true tracks.  `robotN.odometry` has
/// shoal.odometry_t, `robotN.swarm_position` shoal.swarm_position_t with robots and landmarks by name.  Throws
/// BusError when the file cannot be written or exists, and `overwrite` is not set.
MrclamRecord write_mrclam_record(const MrclamData& data, const std::string& log, bool overwrite);

}  // namespace experiment
