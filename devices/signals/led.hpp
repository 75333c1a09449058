// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/device/device.hpp"
#include "sim/scene/light.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace devices {

/// Lights of a vehicle, shown by the colors of its parts.  Until the first command the parts have their own colors, and
/// nothing is reported.  Lights of one part add up, as the three of a multi-color LED do.  They do not light other
/// parts.
class Led final : public sim::Sensor, public sim::UnhashedUntilUsed {
 public:
  static constexpr const char* meaning = "Lights, shown by the colors of parts.";
  static constexpr const char* without_effect[] = {"position_m", "rpy_deg"};
  static constexpr double default_rate_hz = 25;
  static constexpr const char* example = "lights: [{name: lamp}]";
  struct Light {
    std::string name;
    std::vector<std::string> parts;
    std::string color = "#ffffff";
    void read(sim::ParamReader& in);
  };
  struct Params {
    std::vector<Light> lights;
    std::string off_color = "#202428";
    void read(sim::ParamReader& in);
  };
  /// Part that shows lights.
  struct Shown {
    int part;
    std::string name;               ///< BODY/PART
    std::optional<sim::Color> own;  ///< before the first command
    sim::Color present;
  };

  Led(const Params& params, const sim::DeviceContext& context);
  /// Shows the intensities that were set; without power the lights are off.
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext&) override {}
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;
  bool used() const override { return used_; }

  /// Returns the number of a light; unset: there is none.
  std::optional<std::size_t> find(const std::string& light) const;
  /// Sets the intensity of a light, limited to 0 to 1.
  void set(std::size_t light, double intensity);
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<double>& intensities() const { return intensities_; }
  const std::vector<Shown>& shown() const { return shown_; }

 private:
  using Linear = std::array<float, 3>;
  struct Source {
    Linear color;
    std::vector<std::size_t> shown;
  };
  void show();

  sim::PhysicsWorld& physics_;
  Linear off_color_;
  std::vector<std::string> names_;
  std::vector<Source> sources_;  ///< by light
  std::vector<Shown> shown_;
  std::vector<double> intensities_;
  bool used_ = false;
  bool has_power_ = true, is_stale_ = false;  ///< computed again before their use
};

/// Returns the names of the lights of a vehicle file.
std::vector<std::string> lights_of(const sim::VehicleConfig& vehicle);

/// Receives shoal.led_t.
class LedController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.led_t";
  explicit LedController(Led& led) : led_(led) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  Led& led_;
};

}  // namespace devices
