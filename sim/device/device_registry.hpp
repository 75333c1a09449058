#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "sim/device/device.hpp"
#include "sim/device/device_config.hpp"

namespace sim {

class Joint;

/// What a device may hold on to while it is built.
struct DeviceContext {
  World& world;
  Vehicle& vehicle;
  const DeviceConfig& config;
  Body& body;  ///< that the device is mounted on

  /// Throws std::out_of_range: names were checked when the file was read.
  Joint& joint(const std::string& name) const;
  std::string full_name() const;  ///< such as `rover1/lidar`
};

/// A device as built.  A sensor has a reporter, an actuator a controller; some devices have all four.
struct BuiltDevice {
  std::unique_ptr<Sensor> sensor;
  std::unique_ptr<Reporter> reporter;
  std::unique_ptr<Actuator> actuator;
  std::unique_ptr<Controller> controller;
};

/// A device type by its YAML name.
struct DeviceType {
  std::string name;
  std::string meaning;  ///< one sentence
  double default_rate_hz = 0;
  std::string report_message;    ///< such as `shoal.pose_t`; empty: does not report
  std::string command_messages;  ///< comma separated; empty: takes no commands
  std::function<std::shared_ptr<DeviceParams>()> make_params;
  std::function<BuiltDevice(const DeviceParams&, const DeviceContext&)> build;
};

/// All device types, filled before main by the SHOAL_ macros.
class DeviceRegistry {
 public:
  static DeviceRegistry& instance();
  /// Throws std::logic_error when the name is taken.
  void add(DeviceType type);
  const DeviceType* find(const std::string& name) const;
  /// In the order of their names.
  std::vector<const DeviceType*> all() const;

 private:
  std::vector<std::unique_ptr<DeviceType>> types_;
};

namespace detail {

template <typename Params>
class ParamsOf final : public DeviceParams {
 public:
  void read(ParamReader& in) override { params.read(in); }
  Params params;
};

template <typename Model>
std::unique_ptr<Model> make_model(const DeviceParams& params, const DeviceContext& context) {
  const auto& own = static_cast<const ParamsOf<typename Model::Params>&>(params).params;
  if constexpr (std::is_constructible_v<Model, const typename Model::Params&, const DeviceContext&>)
    return std::make_unique<Model>(own, context);
  else
    return std::make_unique<Model>(own);
}

template <typename Model>
DeviceType type_of(const char* name) {
  DeviceType type;
  type.name = name;
  type.meaning = Model::meaning;
  if constexpr (requires { Model::default_rate_hz; }) type.default_rate_hz = Model::default_rate_hz;
  type.make_params = [] { return std::make_shared<ParamsOf<typename Model::Params>>(); };
  return type;
}

template <typename Model, typename ReporterType>
bool add_sensor(const char* name) {
  DeviceType type = type_of<Model>(name);
  type.report_message = ReporterType::report_message;
  type.build = [](const DeviceParams& params, const DeviceContext& context) {
    BuiltDevice built;
    auto model = make_model<Model>(params, context);
    built.reporter = std::make_unique<ReporterType>(*model);
    built.sensor = std::move(model);
    return built;
  };
  DeviceRegistry::instance().add(std::move(type));
  return true;
}

template <typename Model, typename ControllerType>
bool add_actuator(const char* name) {
  DeviceType type = type_of<Model>(name);
  type.command_messages = ControllerType::command_messages;
  type.build = [](const DeviceParams& params, const DeviceContext& context) {
    BuiltDevice built;
    auto model = make_model<Model>(params, context);
    built.controller = std::make_unique<ControllerType>(*model);
    built.actuator = std::move(model);
    return built;
  };
  DeviceRegistry::instance().add(std::move(type));
  return true;
}

/// Hands a device that is sensor and actuator at once to its two owners.
template <typename Model>
class ActuatorSide final : public Actuator {
 public:
  explicit ActuatorSide(Model& model) : model_(model) {}
  void act(Time now, double step_s) override { model_.act(now, step_s); }
  void hash_state(StateHash&) const override {}  // the sensor side hashes the whole model

 private:
  Model& model_;
};

template <typename Model, typename ReporterType, typename ControllerType>
bool add_transceiver(const char* name) {
  DeviceType type = type_of<Model>(name);
  type.report_message = ReporterType::report_message;
  type.command_messages = ControllerType::command_messages;
  type.build = [](const DeviceParams& params, const DeviceContext& context) {
    BuiltDevice built;
    auto model = make_model<Model>(params, context);
    built.reporter = std::make_unique<ReporterType>(*model);
    built.controller = std::make_unique<ControllerType>(*model);
    built.actuator = std::make_unique<ActuatorSide<Model>>(*model);
    built.sensor = std::move(model);
    return built;
  };
  DeviceRegistry::instance().add(std::move(type));
  return true;
}

}  // namespace detail

#define SHOAL_SENSOR(name, Model, ReporterType) \
  [[maybe_unused]] static const bool registered_##Model = ::sim::detail::add_sensor<Model, ReporterType>(name)
#define SHOAL_ACTUATOR(name, Model, ControllerType) \
  [[maybe_unused]] static const bool registered_##Model = ::sim::detail::add_actuator<Model, ControllerType>(name)
/// For a device that is both: its model is a Sensor that also has act().
#define SHOAL_TRANSCEIVER(name, Model, ReporterType, ControllerType) \
  [[maybe_unused]] static const bool registered_##Model =            \
      ::sim::detail::add_transceiver<Model, ReporterType, ControllerType>(name)

}  // namespace sim
