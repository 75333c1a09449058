// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "devices/comms/ais_slots.hpp"
#include "sim/base/geodesy.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Content of an AIS message; the members are those of shoal.ais_t.
struct AisReport {
  int type = 1, part = 0;
  int mmsi = 0, status = 0;
  double latitude_deg = std::numeric_limits<double>::quiet_NaN(), longitude_deg = latitude_deg;
  double speed_mps = latitude_deg, course_rad = latitude_deg, heading_rad = latitude_deg, turn_radps = latitude_deg;
  int imo = 0;
  std::string name, call_sign, destination;
  int ship_type = 0;
  int bow_m = 0, stern_m = 0, port_m = 0, starboard_m = 0;
  double draught_m = latitude_deg;
  void visit_state(sim::StateArchive& archive) {
    archive(type, part, mmsi, status, imo, name, call_sign, destination, ship_type, bow_m, stern_m, port_m,
            starboard_m);
    archive.not_only_finite(latitude_deg, longitude_deg, speed_mps, course_rad, heading_rad, turn_radps, draught_m);
  }
};

/// Transponder or receiver of the Automatic Identification System (AIS) with its own satellite receiver, by ITU-R
/// M.1371-5: message types 1 and 5 (class A) or 18 and 24 (class B), at intervals by speed and change of course, in
/// slots of 26.7 ms.  Each message announces the slot of the next one of its kind, which receivers then avoid.  A
/// message is received within the radio horizon and `range_m`, unless the receiver itself transmits or another message
/// in the same slot and channel is less than 10 dB weaker at its antenna (free space).  See docs/models/modems.md.
class Ais final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "AIS transponder or receiver: positions and names of vessels, by VHF radio.";
  static constexpr double default_rate_hz = 5;
  static constexpr const char* fixed_keys[] = {"mmsi"};
  struct Params {
    AisStation station = AisStation::class_a;
    int mmsi = 0;
    double range_m = 75e3;
    double loss_probability = 0;
    bool sends_heading = true;
    int status = 0;
    int imo = 0;
    std::string ship_name, call_sign, destination;
    int ship_type = 0;
    std::vector<double> dimensions_m{0, 0, 0, 0};
    double draught_m = 0;
    sim::NoiseParams horizontal_noise;  ///< of east and north, m
    sim::NoiseParams velocity_noise;    ///< of each component of the velocity over ground, m/s
    sim::NoiseParams heading_noise;     ///< rad
    void read(sim::ParamReader& in);
  };
  /// A message that was transmitted or received.
  struct Message {
    AisReport report;
    std::int64_t slot = 0;  ///< its first, since 1970
    int slots = 1;
    int channel = 0;  ///< 0: AIS 1, 1: AIS 2
    bool own = false;
    sim::Time end{0};
    void visit_state(sim::StateArchive& archive) {
      archive(report, slot, slots, channel, own, end);
      archive.require(slots, 1, 2, "a number of slots");
      archive.require(slot, 0, ais_last_slot, "a slot");
    }
  };

  /// Throws ConfigError when another station of the world has the same MMSI.
  Ais(const Params& params, const sim::DeviceContext& context);
  ~Ais() override;
  void change(const Params& params) { params_ = params; }
  auto noises() { return std::tie(horizontal_noise_, velocity_noise_, heading_noise_); }
  /// Receives what has ended, and transmits what is due within the step.
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext& context) override;
  void disturb(double dt_s, sim::Random& random) override;
  void visit_state(sim::StateArchive& archive) override;
  /// Returns the messages transmitted and received since the last sample.
  const std::vector<Message>& messages() const { return messages_; }

 private:
  class Band;
  static const sim::SharedKind<Band> band_of_world;
  /// A message on the air at this antenna.
  struct Heard {
    Message message;
    std::int64_t next_slot = 0;  ///< that it announces
    double level_dB = 0;         ///< relative to 1 W at 1 m
    bool judged = false;
    void visit_state(sim::StateArchive& archive) {
      archive(message, next_slot, level_dB, judged);
      archive.require(next_slot, 0, ais_last_slot, "a slot");
    }
  };
  /// Fix of its satellite receiver.
  struct Fix {
    bool valid = false;
    sim::Vector3d p_W = sim::Vector3d::Zero();
    Eigen::Vector2d v_W = Eigen::Vector2d::Zero();
    double yaw_rad = 0, turn_radps = 0;
    void visit_state(sim::StateArchive& archive) { archive(valid, p_W, v_W, yaw_rad, turn_radps); }
  };

  bool is_on() const;
  std::int64_t slot_from(sim::Time time) const { return ais_slot_from(epoch_us_ + time.count()); }
  sim::Time begin_of(std::int64_t slot) const { return sim::Time{ais_slot_begin_us(slot) - epoch_us_}; }
  sim::Vector3d p_WS() const { return body_.X_WB() * p_BS_; }
  void start(std::int64_t slot);
  void transmit_position();
  void transmit_static();
  void transmit(AisReport report, std::int64_t slot, int slots, std::int64_t next_slot);
  std::int64_t choose(std::int64_t nominal, std::int64_t interval, int length);
  AisReport position_report() const;
  AisReport static_report() const;
  bool is_turning() const;
  /// Returns the level of a transmission of this station at another one; none when it does not arrive.
  std::optional<double> level_at(const Ais& receiver) const;
  void judge(sim::Time now);
  bool is_disturbed(const Heard& heard) const;

  Params params_;
  const sim::World& world_;
  const sim::Vehicle& vehicle_;
  const sim::DeviceFaults& faults_;
  const sim::Body& body_;
  sim::Vector3d p_BS_;
  Band& band_;
  std::string full_name_;
  std::int64_t epoch_us_;
  int mmsi_;
  sim::NoiseOf<&Params::horizontal_noise> horizontal_noise_;
  sim::NoiseOf<&Params::velocity_noise> velocity_noise_;
  sim::NoiseOf<&Params::heading_noise> heading_noise_;
  Fix fix_;
  Eigen::Vector2d mean_heading_ = Eigen::Vector2d::Zero();  ///< of the last 30 s, as a vector
  std::int64_t position_slot_ = 0;                          ///< of the next position; 0: not started
  std::int64_t static_slot_ = 0;
  int static_part_ = 0, channel_ = 0;
  std::int64_t sent_ = 0;
  AisReservations reserved_;
  std::deque<Heard> heard_;
  std::vector<Message> arrived_, messages_;
};

/// Publishes one shoal.ais_t for each message.
class AisReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.ais_t";
  explicit AisReporter(const Ais& ais) : ais_(ais) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Ais& ais_;
};

}  // namespace devices
