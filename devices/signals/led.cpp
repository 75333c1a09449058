// SPDX-License-Identifier: BSD-3-Clause
#include "devices/signals/led.hpp"

#include <algorithm>
#include <stdexcept>

#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/led_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/config/message_text.hpp"
#include "sim/image/image.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

void read_color(sim::ParamReader& in, const char* key, std::string& color, const char* meaning) {
  in.read(key, color, meaning);
  if (!sim::parse_color(color)) in.error(key, "'" + std::string(key) + "' must look like #rrggbb, got '" + color + "'");
}

std::array<float, 3> linear(const std::string& text) {
  const sim::Color color = sim::parse_color(text).value_or(sim::Color{});
  return {sim::linear_from_srgb(color[0]), sim::linear_from_srgb(color[1]), sim::linear_from_srgb(color[2])};
}

/// Sets what a part looks like.  The look is not part of the physics, whose parts are otherwise constant.
void paint(sim::PhysicsWorld& physics, int part, std::optional<sim::Color> color) {
  const_cast<sim::PartInfo&>(physics.parts()[static_cast<std::size_t>(part)]).color = color;
}

}  // namespace

void Led::Light::read(sim::ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the light");
  in.read_references("parts", parts, "part", "parts that show it, as BODY/PART; none: all parts of the device's body");
  read_color(in, "color", color, "color at full intensity, #rrggbb");
}

void Led::Params::read(sim::ParamReader& in) {
  in.require("lights");
  in.read_list("lights", lights, "light", "lights");
  read_color(in, "off_color", off_color, "color of a part whose lights are off, #rrggbb");
  if (in.describing()) return;
  for (std::size_t i = 0; i < lights.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (lights[i].name == lights[j].name) in.error("lights", "'lights' names '" + lights[i].name + "' twice");
}

Led::Led(const Params& params, const sim::DeviceContext& context)
    : physics_(context.host.physics), off_color_(linear(params.off_color)) {
  const auto parts = physics_.parts();
  const std::size_t prefix = context.vehicle.name().size() + 1;  // part names start with the name of the vehicle
  const auto add = [&](Source& source, int part) {
    std::size_t i = 0;
    while (i < shown_.size() && shown_[i].part != part) ++i;
    const sim::PartInfo& info = parts[static_cast<std::size_t>(part)];
    if (i == shown_.size()) shown_.push_back({part, info.name.substr(prefix), info.color, {}});
    if (std::find(source.shown.begin(), source.shown.end(), i) == source.shown.end()) source.shown.push_back(i);
  };
  for (const Light& light : params.lights) {
    Source& source = sources_.emplace_back(Source{linear(light.color), {}});
    names_.push_back(light.name);
    for (const std::string& name : light.parts)
      if (const auto part = physics_.find_part(context.vehicle.group(), name)) add(source, *part);
    for (std::size_t i = 0; light.parts.empty() && i < parts.size(); ++i)
      if (parts[i].group == context.vehicle.group() && parts[i].body == context.body.number())
        add(source, static_cast<int>(i));
    if (source.shown.empty()) refuse(context, "no part shows light '" + light.name + "'");
  }
  intensities_.resize(sources_.size());
}

void Led::show() {
  is_stale_ = false;
  std::vector<Linear> light(shown_.size(), off_color_);
  for (std::size_t i = 0; has_power_ && i < sources_.size(); ++i)
    for (const std::size_t shown : sources_[i].shown)
      for (std::size_t channel = 0; channel < 3; ++channel)
        // Light adds up linearly; sRGB values do not.
        light[shown][channel] += static_cast<float>(intensities_[i]) * sources_[i].color[channel];
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel)
      shown_[i].present[channel] = sim::srgb_from_linear(light[i][channel]);
    paint(physics_, shown_[i].part, used_ ? shown_[i].present : shown_[i].own);
  }
}

void Led::act(const sim::ActContext& context) {
  if (!used_) return;
  const bool has_power = context.effectiveness > 0;
  if (has_power == has_power_ && !is_stale_) return;
  has_power_ = has_power;
  show();
}

std::optional<std::size_t> Led::find(const std::string& light) const {
  const auto found = std::find(names_.begin(), names_.end(), light);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

void Led::set(std::size_t light, double intensity) {
  intensities_[light] = std::clamp(intensity, 0.0, 1.0);
  used_ = is_stale_ = true;
}

void Led::visit_state(sim::StateArchive& archive) {
  archive(used_);
  archive.expect_count(intensities_.size(), "lights");
  for (double& intensity : intensities_) archive(intensity);
  if (!archive.restoring()) return;
  for (const double intensity : intensities_) archive.require(intensity, 0, 1, "the intensity of a light");
  show();
}

std::vector<std::string> lights_of(const sim::VehicleConfig& vehicle) {
  std::vector<std::string> names;
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (const auto* led = dynamic_cast<const sim::detail::ParamsOf<Led::Params>*>(device.params.get()))
      for (const Led::Light& light : led->params.lights) names.push_back(light.name);
  return names;
}

bool fill(const Led& led, shoal::led_t& message) {
  if (!led.used()) return false;
  message.light = led.names();
  message.intensity = led.intensities();
  message.count = static_cast<std::int32_t>(led.names().size());
  for (const Led::Shown& shown : led.shown()) {
    message.part.push_back(shown.name);
    message.color.push_back(shown.present[0] << 16 | shown.present[1] << 8 | shown.present[2]);
  }
  message.parts = static_cast<std::int32_t>(led.shown().size());
  return true;
}

void LedController::receive(sim::Time, std::span<const std::byte> payload) {
  const auto message = shoal::decode<shoal::led_t>(payload, shoal::Finite::required);
  std::vector<std::pair<std::size_t, double>> settings;
  for (std::size_t i = 0; i < message.light.size(); ++i) {
    const auto light = led_.find(message.light[i]);
    if (!light)
      throw std::runtime_error("there is no light '" + sim::shortened(sim::printable(message.light[i])) + "'" +
                               sim::did_you_mean(message.light[i], led_.names()) +
                               "; known: " + sim::list_text(led_.names()));
    const double intensity = message.intensity[i];
    if (!(intensity >= 0 && intensity <= 1))
      throw std::runtime_error("the intensity of light '" + message.light[i] + "' must be >= 0 and <= 1, got " +
                               sim::number_text(intensity));
    settings.emplace_back(*light, intensity);
  }
  for (const auto& [light, intensity] : settings) led_.set(light, intensity);
}

SHOAL_TRANSCEIVER("led", Led, shoal::led_t, LedController);

}  // namespace devices
