// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/shoal/sdf/sdf_model.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"
#include "tools/shoal/urdf/imported_vehicle.hpp"
#include "tools/shoal/urdf/shoal_names.hpp"

namespace tools {

/// Adds devices to a vehicle, with names that no other device has.
class SdfDevices {
 public:
  explicit SdfDevices(ImportedVehicle& vehicle);

  /// Adds a device at a pose in a link, and gives it a name that is free.  False, and a note, when the link was left
  /// out or is the world.
  bool add(const XmlElement& element, const std::string& name, const std::string& type, const std::string& link,
           const sim::Pose& X_LS, const YamlEntries& keys);
  ImportedVehicle& vehicle() { return vehicle_; }

 private:
  ImportedVehicle& vehicle_;
  ShoalNames names_;
};

/// Adds the devices of sensors, and a note for each sensor or value that Shoal does not have.
void add_sensors(const SdfModel& model, SdfDevices& devices);

/// Noise of Shoal as YAML, from a `<noise>` of SDF; empty: none.  `unit`: factor of its numbers.
///
/// Gazebo's noise is N(mean, stddev) and a bias that is drawn once with a random sign: the mean is `bias`, the latter
/// has the standard deviation sqrt(bias_mean^2 + bias_stddev^2).  Its dynamic bias is a Gauss-Markov process driven by
/// white noise of the density `dynamic_bias_stddev`, s: it settles at s sqrt(time / 2) (gz-sensors,
/// GaussianNoiseModel).
std::string noise_text(const XmlElement& noise, double unit, std::vector<ImportNote>& notes);

}  // namespace tools
