// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "tools/shoal/urdf/xml_element.hpp"

namespace tools {

/// A `<pose>`: relative to the named frame, or to the default of its element when the name is empty.
struct SdfPose {
  sim::Pose X = sim::Pose::Identity();
  std::string relative_to;
};

/// Reads the `<pose>` of an element: roll, pitch and yaw in rad or degrees, or a quaternion; the identity without it.
SdfPose read_sdf_pose(const XmlElement& element);

/// Names in a model: those of nested models begin with `MODEL::`.
struct SdfScope {
  std::string prefix;
  std::string model_frame;  ///< name of the frame of the model

  /// Full name of what a text of the file names; `__model__` is the frame of the model, `world` the world.
  std::string full(const std::string& name) const;
};

/// Frames of a model and of the models nested in it, by their full names: models, links, joints and `<frame>`.
class SdfFrames {
 public:
  struct Frame {
    sim::Pose X = sim::Pose::Identity();  ///< in `relative_to`
    std::string relative_to;              ///< empty: the frame of the vehicle
    std::string attached_to;              ///< what it moves with; empty: it is a link
    std::string placed_by;                ///< model: frame of its own to which X applies; empty: its own origin
    sim::SourcePlace place;
  };

  /// Adds a frame; refuses a name that is taken.
  void add(const std::string& name, const Frame& frame);
  bool has(const std::string& name) const { return frames_.contains(name); }
  /// Pose in the frame of the vehicle.  Throws sim::ConfigError when there is no such frame, and for frames that are
  /// defined by each other.
  sim::Pose X_V(const std::string& name, const sim::SourcePlace& place);
  /// Link that the frame moves with; `world` is itself.  Throws as X_V().
  std::string link_of(const std::string& name, const sim::SourcePlace& place) const;

 private:
  const Frame& find(const std::string& name, const sim::SourcePlace& place) const;
  /// Pose in the frame to which the chain of its frames leads.
  sim::Pose X_in(const std::string& name, const std::string& ancestor, const sim::SourcePlace& place) const;

  std::map<std::string, Frame> frames_;
  std::map<std::string, sim::Pose> known_;
};

}  // namespace tools
