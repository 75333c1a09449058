// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "devices/motion/joint_controls.hpp"
#include "devices/motion/joint_limits.hpp"
#include "devices/motion/servo_bank.hpp"
#include "sim/device/device_registry.hpp"

namespace devices {

/// Group of joint servos that are commanded together, frame by frame.
///
/// Packets of frames are played one after the other.  Within a frame the set points move linearly to its values.  When
/// the next packet is late, the last frame is held and counted.  At an emergency stop and without power all frames are
/// dropped.
class JointGroup final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Joint servos that are commanded together, by frames at a fixed rate.";
  static constexpr double default_rate_hz = 10;
  static constexpr const char* fixed_keys[] = {"joints"};
  /// How a motion is mirrored, for tools that edit motions.
  struct Mirror {
    /// Joints whose names start with one are exchanged with those whose names start with the other.
    struct Swap {
      std::string left, right;
      void read(sim::ParamReader& in);
    };
    std::vector<Swap> swap;
    std::vector<std::string> negate;
    void read(sim::ParamReader& in);
  };
  struct Params {
    std::vector<std::string> joints;
    double frame_s = 0.008;
    int frames_per_packet = 4;
    int buffer_packets = 2;
    double stream_end_s = 0.1;
    std::vector<JointLimitRow> limits;
    Mirror mirror;
    JointControls controls;
    void read(sim::ParamReader& in);
  };
  /// Counts since the start.
  struct Counts {
    std::int64_t played = 0, held = 0, late_packets = 0, refused_packets = 0, clipped = 0;
    void visit_state(sim::StateArchive& archive) { archive(played, held, late_packets, refused_packets, clipped); }
  };

  JointGroup(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  /// Applies changed keys; frames that wait are dropped.  Throws std::runtime_error when a limit names a joint that is
  /// not in the group.
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;

  /// Frames of some joints: values by frame, then by joint; NaN: as before.  Throws std::runtime_error when a joint is
  /// not in the group, or there are too many frames.
  struct Frames {
    std::vector<std::string> joints;
    std::vector<std::vector<double>> values;
  };
  void receive(sim::Time now, const Frames& frames);

  /// Commands the positions at the end of this step, rad or m, one for each joint; NaN: none.  Frames that wait are
  /// dropped, and packets are refused in this step.
  void command(std::span<const double> positions, sim::Time now, double step_s);

  /// Starts from the present set points of the servos, which others may have commanded meanwhile.
  void take_up() { commanded_.clear(); }
  ServoBank& servos() { return servos_; }
  /// Returns the last commanded positions, rad or m; before the first command those of the joints.
  std::span<const double> commanded();
  double frame_s() const { return params_.frame_s; }
  const JointControls& controls() const { return params_.controls; }
  const JointLimitTable& limits() const { return limits_; }
  const Counts& counts() const { return counts_; }
  int waiting() const { return static_cast<int>(frames_.size() / servos_.size()); }
  /// Reading of the last sample, rad or m.
  const std::vector<double>& set_points() const { return set_points_; }
  const std::vector<double>& positions() const { return positions_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  JointLimitTable table_of(const Params& params) const;
  void check_controls(const JointControls& controls) const;
  void apply(std::span<const double> positions, sim::Time now);
  void start_frame(sim::Time now);
  void end_stream();

  Params params_;
  const sim::Vehicle& vehicle_;
  ServoBank servos_;
  JointLimitTable limits_;
  std::vector<std::string> names_;
  std::vector<double> frames_;     ///< frames that wait, one after the other
  std::vector<double> from_, to_;  ///< of the present frame
  std::vector<double> commanded_;  ///< empty: nothing yet
  sim::Time frame_start_{-1};      ///< of the present frame; -1: no stream
  sim::Time last_frame_{-1};       ///< end of the last frame that was not held
  sim::Time claimed_until_{-1};    ///< commands of another device until then
  bool is_late_ = false;           ///< the last frame is held
  Counts counts_;
  std::vector<double> set_points_, positions_;
  std::vector<double> scratch_, course_;  ///< of the present step
};

/// Receives shoal.joint_frames_t.
class JointGroupController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.joint_frames_t";
  explicit JointGroupController(JointGroup& group) : group_(group) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  JointGroup& group_;
};

}  // namespace devices
