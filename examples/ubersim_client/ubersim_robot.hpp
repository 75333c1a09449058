// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <stdexcept>
#include <string>

namespace ubersim {

/// Largest torque of a wheel's motor in N m; the XML does not name it.
inline constexpr double max_torque_Nm = 50;

/// Error of the XML: one sentence.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Robot of UberSim's self-instantiation XML as a vehicle of Shoal.
struct Robot {
  std::string name;
  std::array<double, 3> position_m;  ///< in the world, at which its wheels stand on the ground
  std::array<double, 3> rpy_deg;
  std::string model;          ///< YAML, the `model` of an entry of `vehicles:`
  double tilt_rad = 0;        ///< positive forward, at which it balances
  double radius_m = 0;        ///< of its wheels
  std::string entry() const;  ///< YAML, an entry of `vehicles:` that is removed with its client
};

/// Reads a robot; its cameras have `width` pixels in a row.  Throws Refused.
Robot read_robot(const std::string& path, int width);

}  // namespace ubersim
