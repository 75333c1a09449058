// SPDX-License-Identifier: BSD-3-Clause
#include "devices/motion/joint_group.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/joint_frames_t.hpp"
#include "shoal/joint_group_state_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/config/message_text.hpp"

namespace devices {

void JointGroup::Mirror::Swap::read(sim::ParamReader& in) {
  in.require("left");
  in.read("left", left, "start of the names on one side");
  in.require("right");
  in.read("right", right, "start of the names on the other side");
}

void JointGroup::Mirror::read(sim::ParamReader& in) {
  in.read_list("swap", swap, "pair", "joints that are exchanged, by the start of their names");
  in.read("negate", negate, "joints whose positions change sign");
}

void JointGroup::Params::read(sim::ParamReader& in) {
  in.read("joints", joints, "joint servos by name or alias; unset: all of the vehicle");
  in.read("frame_s", frame_s, sim::between(0.001, 1), "duration of a frame");
  in.read("frames_per_packet", frames_per_packet, sim::between(1, 1000), "maximum number of frames in a message");
  in.read("buffer_packets", buffer_packets, sim::between(1, 100), "packets of this size that can wait");
  in.read("stream_end_s", stream_end_s, sim::between(0, 10),
          "time without frames after which the stream has ended, and the last frame no longer counts as held");
  in.read_list("limits", limits, "row", "limits of joints that depend on the position of other joints");
  in.read("mirror", mirror, "how `shoal motion edit` mirrors a motion");
  in.read("controls", controls, "keys and sticks of `shoal motion record`");
}

JointGroup::JointGroup(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      vehicle_(context.vehicle),
      servos_(context, params.joints),
      limits_({}, {}),
      names_(servos_.names()),
      set_points_(servos_.size(), 0.0),
      positions_(servos_.size(), 0.0) {
  try {
    limits_ = table_of(params);
    check_controls(params.controls);
  } catch (const std::runtime_error& error) {
    refuse(context, error.what());
  }
}

JointLimitTable JointGroup::table_of(const Params& params) const {
  JointLimitTable table(params.limits, [this](const std::string& name) { return servos_.find(name); });
  if (!table.unknown_joint().empty())
    throw std::runtime_error("'limits' names '" + sim::shortened(sim::printable(table.unknown_joint())) +
                             "', which is not a servo of the group; known: " + sim::list_text(names_));
  return table;
}

void JointGroup::check_controls(const JointControls& controls) const {
  const auto check = [this](const std::string& joint) {
    if (!servos_.find(joint))
      throw std::runtime_error("'controls' names '" + sim::shortened(sim::printable(joint)) +
                               "', which is not a servo of the group; known: " + sim::list_text(names_));
  };
  for (const JointControls::Key& key : controls.keys) check(key.joint);
  for (const JointControls::Stick& stick : controls.sticks) check(stick.joint);
}

void JointGroup::change(const Params& params) {
  check_controls(params.controls);
  limits_ = table_of(params);
  params_ = params;
  end_stream();
}

std::span<const double> JointGroup::commanded() {
  if (commanded_.empty())
    for (std::size_t i = 0; i < servos_.size(); ++i) commanded_.push_back(servos_.set_point(i));
  return commanded_;
}

void JointGroup::receive(sim::Time now, const Frames& frames) {
  // Check the packet.
  if (frames.values.empty()) throw std::runtime_error("'n_frames' must be at least 1");
  const auto limit = static_cast<std::size_t>(params_.frames_per_packet);
  if (frames.values.size() > limit)
    throw std::runtime_error("'n_frames' must be at most frames_per_packet, " + std::to_string(limit) + ", got " +
                             std::to_string(frames.values.size()));
  std::vector<std::size_t> numbers;
  for (const std::string& joint : frames.joints) {
    const auto number = servos_.find(joint);
    if (!number)
      throw std::runtime_error("'joint_name' names '" + sim::shortened(sim::printable(joint)) +
                               "', which is not a servo of the group; known: " + sim::list_text(names_));
    if (std::find(numbers.begin(), numbers.end(), *number) != numbers.end())
      throw std::runtime_error("'joint_name' names servo '" + names_[*number] + "' twice");
    numbers.push_back(*number);
  }
  for (const std::vector<double>& values : frames.values)
    for (const double value : values)
      if (std::isinf(value)) throw std::runtime_error("'position' must be finite, or NaN for 'as before'");
  // Refuse it when it cannot wait.
  const std::size_t capacity = limit * static_cast<std::size_t>(params_.buffer_packets);
  if (now < claimed_until_ || static_cast<std::size_t>(waiting()) + frames.values.size() > capacity) {
    ++counts_.refused_packets;
    return;
  }
  if (is_late_) ++counts_.late_packets;
  // Store it.
  for (const std::vector<double>& values : frames.values) {
    const std::size_t begin = frames_.size();
    frames_.resize(begin + servos_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < numbers.size(); ++i) frames_[begin + numbers[i]] = values[i];
  }
}

void JointGroup::apply(std::span<const double> positions, sim::Time now) {
  commanded();
  // Joints without a value keep their last command, but limits between joints hold for all of them.
  scratch_.assign(commanded_.begin(), commanded_.end());
  for (std::size_t i = 0; i < scratch_.size(); ++i)
    if (!std::isnan(positions[i])) scratch_[i] = positions[i];
  counts_.clipped += limits_.limit(scratch_);
  for (std::size_t i = 0; i < scratch_.size(); ++i) {
    // A joint without a value is only commanded if a limit moved it, so that others may still command it.
    if (std::isnan(positions[i]) && scratch_[i] == commanded_[i]) continue;
    if (scratch_[i] < servos_.low(i) || scratch_[i] > servos_.high(i)) ++counts_.clipped;
    servos_.command(i, scratch_[i], now);
    commanded_[i] = scratch_[i];
  }
}

void JointGroup::command(std::span<const double> positions, sim::Time now, double step_s) {
  if (frame_start_.count() >= 0) end_stream();
  claimed_until_ = now + sim::from_seconds(step_s) + sim::Time{1};
  apply(positions, now);
}

void JointGroup::end_stream() {
  frames_.clear();
  from_.clear();
  to_.clear();
  frame_start_ = sim::Time{-1};
  is_late_ = false;
}

void JointGroup::start_frame(sim::Time now) {
  const std::size_t size = servos_.size();
  from_.assign(commanded().begin(), commanded().end());
  to_.assign(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(size));
  frames_.erase(frames_.begin(), frames_.begin() + static_cast<std::ptrdiff_t>(size));
  frame_start_ = now;
  is_late_ = false;
  ++counts_.played;
}

void JointGroup::act(const sim::ActContext& context) {
  if (context.effectiveness <= 0 || vehicle_.systems().estopped) {
    end_stream();
    return take_up();
  }
  const sim::Time frame = sim::from_seconds(params_.frame_s);
  if (frame_start_.count() < 0) {
    if (frames_.empty()) return;
    take_up();
    start_frame(context.now);
  } else if (context.now >= frame_start_ + frame) {
    // The next frame follows without a gap, unless it was late.
    if (!frames_.empty()) {
      start_frame(is_late_ ? context.now : frame_start_ + frame);
    } else {
      if (context.now - last_frame_ >= sim::from_seconds(params_.stream_end_s)) return end_stream();
      is_late_ = true;
      frame_start_ += frame;
      ++counts_.held;
      return;
    }
  }
  if (is_late_) return;
  last_frame_ = frame_start_ + frame;
  // Position at the end of this step.
  const double share = std::min(1.0, (sim::to_seconds(context.now - frame_start_) + context.step_s) / params_.frame_s);
  course_.resize(servos_.size());
  for (std::size_t i = 0; i < course_.size(); ++i)
    course_[i] = share == 1 ? to_[i] : from_[i] + share * (to_[i] - from_[i]);
  apply(course_, context.now);
}

void JointGroup::measure(const sim::SenseContext&) {
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    set_points_[i] = servos_.set_point(i);
    positions_[i] = servos_.position(i);
  }
}

void JointGroup::visit_state(sim::StateArchive& archive) {
  archive.not_only_finite(frames_, to_);
  archive(from_, commanded_, frame_start_, last_frame_, claimed_until_, is_late_, counts_);
  archive.not_only_finite(set_points_, positions_);
  if (!archive.restoring()) return;
  const std::size_t size = servos_.size();
  const auto is_whole = [size](const std::vector<double>& values) { return values.empty() || values.size() == size; };
  // A snapshot may be damaged: sizes are checked before any value is used.
  const std::size_t capacity = static_cast<std::size_t>(params_.frames_per_packet * params_.buffer_packets) * size;
  const bool fits = frames_.size() % size == 0 && frames_.size() <= capacity && is_whole(from_) && is_whole(to_) &&
                    is_whole(commanded_) && set_points_.size() == size && positions_.size() == size &&
                    (frame_start_.count() < 0) == to_.empty() && from_.size() == to_.size();
  if (!fits) archive.fail("the snapshot has an invalid value: frames of a group of joints");
}

void JointGroupController::receive(sim::Time now, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::joint_frames_t>(payload, shoal::Finite::any);
  group_.receive(now, {message.joint_name, message.position});
}

bool fill(const JointGroup& group, shoal::joint_group_state_t& message) {
  message.waiting = group.waiting();
  message.played = group.counts().played;
  message.held = group.counts().held;
  message.late_packets = group.counts().late_packets;
  message.refused_packets = group.counts().refused_packets;
  message.clipped = group.counts().clipped;
  message.n_joints = static_cast<std::int32_t>(group.names().size());
  message.joint_name = group.names();
  message.set_point = group.set_points();
  message.position = group.positions();
  return true;
}

SHOAL_TRANSCEIVER("joint_group", JointGroup, shoal::joint_group_state_t, JointGroupController);

}  // namespace devices
