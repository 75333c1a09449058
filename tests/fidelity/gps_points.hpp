// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sim/base/geodesy.hpp"
#include "tests/project_paths.hpp"

namespace test {

/// A row of tests/fidelity/reference/gps_points.csv: a place in the local coordinates of an origin, and on the Earth.
struct GpsPoint {
  std::string origin_name;
  sim::GeodeticPosition origin;
  sim::Vector3d p_W = sim::Vector3d::Zero();
  sim::GeodeticPosition position;
};

inline std::vector<GpsPoint> gps_points() {
  std::ifstream in(test_support::source_path("tests/fidelity/reference/gps_points.csv"));
  std::vector<GpsPoint> points;
  std::string line;
  std::getline(in, line);  // the header
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    GpsPoint point;
    std::getline(fields, point.origin_name, ',');
    double number[9];
    for (double& each : number) {
      std::string text;
      std::getline(fields, text, ',');
      each = std::stod(text);
    }
    point.origin = {number[0], number[1], number[2]};
    point.p_W = {number[3], number[4], number[5]};
    point.position = {number[6], number[7], number[8]};
    points.push_back(point);
  }
  return points;
}

}  // namespace test
