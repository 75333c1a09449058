// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "devices/joint/bumper.hpp"
#include "sim/device/device.hpp"

namespace devices {

/// Touch sensor: tells that a part is touched and how firmly, but not where and by whom.  It feels contacts as a bumper
/// does, and what a command says that a person does: no hand is part of the world.
class Touch final : public sim::Sensor, public sim::UnhashedUntilUsed {
 public:
  static constexpr const char* meaning = "Touch of parts of the vehicle, without place and force.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 0;
  static constexpr const char* fixed_keys[] = {"parts"};
  struct Params {
    Bumper::Params contact;  ///< parts and least force
    double full_force_N = 10;
    void read(sim::ParamReader& in);
  };

  Touch(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context) { contact_.act(context); }
  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  void change(const Params& params);
  void visit_state(sim::StateArchive& archive) override;
  bool used() const override { return used_; }

  /// Presses it from now on with a pressure, 0 to 1; 0 ends that.
  void press(double pressure) {
    pressed_ = pressure;
    used_ = true;
  }
  double pressure() const { return pressure_; }
  /// Returns whether the reading has changed since the last sample.
  bool is_update() const { return is_update_; }

 private:
  double full_force_N_;
  Bumper contact_;
  double pressed_ = 0;   ///< by a command
  double pressure_ = 0;  ///< the reading
  bool is_update_ = false, used_ = false;
};

/// Receives shoal.touch_t: a person presses with its `pressure` until another one comes.
class TouchController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.touch_t";
  explicit TouchController(Touch& touch) : touch_(touch) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  Touch& touch_;
};

}  // namespace devices
