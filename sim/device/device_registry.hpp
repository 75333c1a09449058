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

/// ReporterType or ControllerType void: the device has none.
template <typename Model, typename ReporterType, typename ControllerType>
BuiltDevice build_device(const DeviceParams& params, const DeviceContext& context) {
  BuiltDevice built;
  auto model = make_model<Model>(params, context);
  if constexpr (!std::is_void_v<ReporterType>) built.reporter = std::make_unique<ReporterType>(*model);
  if constexpr (!std::is_void_v<ControllerType>) built.controller = std::make_unique<ControllerType>(*model);
  if constexpr (std::is_base_of_v<Actuator, Model>) {
    built.actuator = std::move(model);
  } else {
    if constexpr (!std::is_void_v<ControllerType>) built.actuator = std::make_unique<ActuatorSide<Model>>(*model);
    built.sensor = std::move(model);
  }
  return built;
}

template <typename Model, typename ReporterType, typename ControllerType>
bool add_device(const char* name) {
  DeviceType type;
  type.name = name;
  type.meaning = Model::meaning;
  if constexpr (requires { Model::default_rate_hz; }) type.default_rate_hz = Model::default_rate_hz;
  if constexpr (!std::is_void_v<ReporterType>) type.report_message = ReporterType::report_message;
  if constexpr (!std::is_void_v<ControllerType>) type.command_messages = ControllerType::command_messages;
  type.make_params = [] { return std::make_shared<ParamsOf<typename Model::Params>>(); };
  type.build = build_device<Model, ReporterType, ControllerType>;
  DeviceRegistry::instance().add(std::move(type));
  return true;
}

}  // namespace detail

#define SHOAL_DEVICE(name, Model, ReporterType, ControllerType) \
  [[maybe_unused]] static const bool registered_##Model =       \
      ::sim::detail::add_device<Model, ReporterType, ControllerType>(name)
#define SHOAL_SENSOR(name, Model, ReporterType) SHOAL_DEVICE(name, Model, ReporterType, void)
#define SHOAL_ACTUATOR(name, Model, ControllerType) SHOAL_DEVICE(name, Model, void, ControllerType)
/// For a device that is both: its model is a Sensor that also has act().
#define SHOAL_TRANSCEIVER(name, Model, ReporterType, ControllerType) \
  SHOAL_DEVICE(name, Model, ReporterType, ControllerType)

}  // namespace sim
