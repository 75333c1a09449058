// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_frames.hpp"

#include <vector>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

std::string quoted_frame(const std::string& name) {
  return "'" + sim::shortened(sim::printable(name)) + "'";
}

[[noreturn]] void refuse_loop(const std::string& name, const sim::SourcePlace& place) {
  sim::throw_config_error(place, "", "frame " + quoted_frame(name) + " is defined by itself");
}

}  // namespace

SdfPose read_sdf_pose(const XmlElement& element) {
  SdfPose read;
  const std::optional<XmlElement> pose = element.child("pose");
  if (!pose) return read;
  // SDF 1.5 and 1.6 name the frame in `frame`.
  read.relative_to = pose->text("relative_to", pose->text("frame", ""));
  if (pose->content().empty()) return read;
  const std::string format = pose->text("rotation_format", "euler_rpy");
  if (format == "quat_xyzw") {
    const std::vector<double> n = pose->content_numbers(7);
    read.X = pose_of_quaternion(*pose, "the quaternion of <pose>", {n[0], n[1], n[2]}, {n.begin() + 3, n.end()});
    return read;
  }
  if (format != "euler_rpy")
    pose->refuse("'rotation_format' must be euler_rpy or quat_xyzw, got " + quoted_frame(format));
  const std::vector<double> n = pose->content_numbers(6);
  const std::string degrees = pose->text("degrees", "false");
  const double unit = degrees == "true" || degrees == "1" ? sim::degrees_to_radians(1) : 1;
  read.X = sim::make_pose({n[0], n[1], n[2]}, unit * sim::Vector3d(n[3], n[4], n[5]));
  return read;
}

std::string SdfScope::full(const std::string& name) const {
  if (name == "__model__") return model_frame;
  return name == "world" ? name : prefix + name;
}

void SdfFrames::add(const std::string& name, const Frame& frame) {
  if (name == "world" || !frames_.try_emplace(name, frame).second)
    sim::throw_config_error(frame.place, "", "the name " + quoted_frame(name) + " is taken");
}

const SdfFrames::Frame& SdfFrames::find(const std::string& name, const sim::SourcePlace& place) const {
  const auto found = frames_.find(name);
  if (found == frames_.end())
    sim::throw_config_error(place, "", "there is no link, joint, frame or model " + quoted_frame(name));
  return found->second;
}

sim::Pose SdfFrames::X_in(const std::string& name, const std::string& ancestor, const sim::SourcePlace& place) const {
  sim::Pose X = sim::Pose::Identity();
  std::size_t steps = 0;
  for (std::string at = name; at != ancestor;) {
    const Frame& frame = find(at, place);
    if (frame.relative_to.empty())
      sim::throw_config_error(place, "", quoted_frame(name) + " is not a frame in " + quoted_frame(ancestor));
    if (++steps > frames_.size()) refuse_loop(name, place);
    if (!frame.placed_by.empty())
      sim::throw_config_error(
          place, "",
          "the placement frame " + quoted_frame(name) + " must not be in a nested model with a placement frame");
    X = frame.X * X;
    at = frame.relative_to;
  }
  return X;
}

sim::Pose SdfFrames::X_V(const std::string& name, const sim::SourcePlace& place) {
  // Frames up to one whose pose is known, or to that of the vehicle.
  std::vector<std::string> chain;
  sim::Pose X = sim::Pose::Identity();
  for (std::string at = name; !at.empty(); at = find(at, place).relative_to) {
    const auto known = known_.find(at);
    if (known != known_.end()) {
      X = known->second;
      break;
    }
    if (chain.size() > frames_.size()) refuse_loop(name, place);
    chain.push_back(at);
  }
  for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
    const Frame& frame = find(*at, place);
    X = X * frame.X;
    if (!frame.placed_by.empty()) X = X * X_in(frame.placed_by, *at, frame.place).inverse();
    known_[*at] = X;
  }
  return X;
}

std::string SdfFrames::link_of(const std::string& name, const sim::SourcePlace& place) const {
  std::string at = name;
  for (std::size_t steps = 0; at != "world"; ++steps) {
    const Frame& frame = find(at, place);
    if (frame.attached_to.empty()) return at;
    if (steps > frames_.size()) refuse_loop(name, place);
    at = frame.attached_to;
  }
  return at;
}

}  // namespace tools
