// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "sim/device/device.hpp"
#include "sim/device/device_config.hpp"
#include "sim/device/fault.hpp"

namespace sim {

struct DeviceContext;

/// Reporter that fills and publishes one message per sample.  Defined in messages/reporter/message_reporter.hpp,
/// because sim/ does not depend on message types.
template <typename Model, typename Message>
class MessageReporter;

/// Returns the name of a quantity for faults: the key of its noise without `_noise`.
std::string quantity_of(const std::string& noise_key);

/// Objects of one device.  A sensor has a reporter, an actuator a controller; some devices have all four.
struct BuiltDevice {
  std::unique_ptr<Sensor> sensor;          ///< measures
  std::unique_ptr<Reporter> reporter;      ///< publishes what the sensor measured
  std::unique_ptr<Actuator> actuator;      ///< acts on the physics
  std::unique_ptr<Controller> controller;  ///< takes the commands of the actuator
  /// Changes parameters at run time; empty: not supported.
  std::function<void(const DeviceParams&)> change;
};

/// Device type, identified by its YAML name.
struct DeviceType {
  std::string name;                     ///< in YAML: `type: NAME`
  std::string meaning;                  ///< one sentence
  double default_rate_hz = 0;           ///< default sample rate; 0: every step
  std::string example;                  ///< keys in YAML on the vehicle of every_device_test; empty: joints are enough
  std::string report_message;           ///< such as `shoal.pose_t`; empty: does not report
  std::string command_messages;         ///< comma separated; empty: takes no commands
  std::vector<SafeState> safe_states;   ///< safe states of an actuator, the default first; empty: not an actuator
  bool changeable = false;              ///< whether keys of the type can change at run time
  std::vector<std::string> fixed_keys;  ///< keys of a changeable type that cannot change
  std::vector<std::string> without_effect;                     ///< keys of its mount that it does not use
  bool always_on = false;                                      ///< works without power and at an emergency stop
  bool casts_rays = false;                                     ///< see Sensor
  bool sweeps = false;                                         ///< see Sensor
  bool measures_alone = false;                                 ///< see Sensor
  bool acts_alone = false;                                     ///< see Actuator
  bool sleeps = false;                                         ///< see Actuator
  std::function<std::shared_ptr<DeviceParams>()> make_params;  ///< parameters with their defaults
  std::function<BuiltDevice(const DeviceParams&, const DeviceContext&)> build;  ///< makes one device

  /// Returns whether the device publishes messages.
  bool reports() const { return !report_message.empty(); }
  /// Returns whether the device receives messages.
  bool takes_commands() const { return !command_messages.empty(); }
  /// Returns whether the device acts on the physics.
  bool is_actuator() const { return !safe_states.empty(); }
  /// Returns the quantities with configurable errors, for faults.
  std::vector<std::string> quantities() const;
};

/// Returns the reason why a fault does not apply to a device type; empty when it does.
std::string fault_misfit(const DeviceType& type, const FaultConfig& fault);

inline constexpr ChoiceWords<SafeState> safe_state_words{
    {"stop", SafeState::stop}, {"coast", SafeState::coast}, {"hold", SafeState::hold}, {"park", SafeState::park}};

/// Registry of all device types, filled before main by the SHOAL_ macros.
class DeviceRegistry {
 public:
  /// Returns the registry of this process.
  static DeviceRegistry& instance();
  /// Registers a type.  A duplicate name is recorded as a problem, and the first type remains registered.  Never
  /// throws, because static initializers call this function and their exceptions would end the program.
  void add(DeviceType type);
  /// Returns the registration problems since the last call.
  std::vector<std::string> take_problems();
  /// Returns the type of this name; null when there is none.
  const DeviceType* find(const std::string& name) const;
  /// Returns all types, sorted by name.
  std::vector<const DeviceType*> all() const;

 private:
  std::vector<std::unique_ptr<DeviceType>> types_;
  std::vector<std::string> problems_;
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
concept Acts = requires(Model& model, const ActContext& context) {
  model.act(context);
};
template <typename Model>
concept Idles = requires(const Model& model) {
  { model.idle() } -> std::convertible_to<bool>;
};

/// Actuator interface of a model that is both sensor and actuator; the sensor interface owns the model.
template <typename Model>
class ActuatorSide final : public Actuator {
 public:
  explicit ActuatorSide(Model& model) : model_(model) {}
  void act(const ActContext& context) override { model_.act(context); }
  void make_safe(SafeState safe) override {
    if constexpr (requires { model_.make_safe(safe); }) model_.make_safe(safe);
  }
  double power_W() const override {
    if constexpr (requires { model_.power_W(); })
      return model_.power_W();
    else
      return 0;
  }
  bool idle() const override {
    if constexpr (Idles<Model>)
      return model_.idle();
    else
      return false;
  }
  void visit_state(StateArchive&) override {}  // the sensor side visits the whole model

 private:
  Model& model_;
};

/// Reporter of a device registered with `Output`, which is a Reporter, a message type, or void for none.
template <typename Model, typename Output>
using ReporterOf = std::conditional_t<std::is_void_v<Output> || std::is_base_of_v<Reporter, Output>, Output,
                                      MessageReporter<Model, Output>>;

/// Models whose parameters can change at run time: change() sets them, and noises() returns the affected errors as a
/// tuple of references to NoiseOf.
template <typename Model>
concept Changes = requires(Model& model, const typename Model::Params& params) {
  model.change(params);
};
template <typename Model>
concept HasNoises = requires(Model& model) {
  model.noises();
};

template <typename Model>
void change_model(Model& model, const typename Model::Params& params) {
  if constexpr (Changes<Model>) model.change(params);
  if constexpr (HasNoises<Model>)
    std::apply([&params](auto&... noises) { (noises.change(params), ...); }, model.noises());
}

/// Builds the objects of a device.  ReporterType or ControllerType void: the device has none.
template <typename Model, typename ReporterType, typename ControllerType>
BuiltDevice build_device(const DeviceParams& params, const DeviceContext& context) {
  BuiltDevice built;
  auto model = make_model<Model>(params, context);
  if constexpr (!std::is_void_v<ReporterType>) built.reporter = std::make_unique<ReporterType>(*model);
  if constexpr (!std::is_void_v<ControllerType>) built.controller = std::make_unique<ControllerType>(*model);
  if constexpr (Changes<Model> || HasNoises<Model>)
    built.change = [raw = model.get()](const DeviceParams& changed) {
      change_model(*raw, static_cast<const ParamsOf<typename Model::Params>&>(changed).params);
    };
  if constexpr (std::is_base_of_v<Actuator, Model>) {
    built.actuator = std::move(model);
  } else {
    if constexpr (Acts<Model>) built.actuator = std::make_unique<ActuatorSide<Model>>(*model);
    built.sensor = std::move(model);
  }
  return built;
}

template <typename Model, typename Output, typename ControllerType>
bool add_device(const char* name) {
  using ReporterType = ReporterOf<Model, Output>;
  DeviceType type;
  // Name, meaning and example.
  type.name = name;
  type.meaning = Model::meaning;
  if constexpr (requires { Model::example; }) type.example = Model::example;
  if constexpr (requires { Model::default_rate_hz; }) type.default_rate_hz = Model::default_rate_hz;
  // Messages.
  if constexpr (requires { ReporterType::message_name(); })
    type.report_message = ReporterType::message_name();
  else if constexpr (!std::is_void_v<ReporterType>)
    type.report_message = ReporterType::report_message;
  if constexpr (!std::is_void_v<ControllerType>) type.command_messages = ControllerType::command_messages;
  // Safe states.
  if constexpr (requires { Model::safe_states; })
    type.safe_states.assign(std::begin(Model::safe_states), std::end(Model::safe_states));
  else if constexpr (std::is_base_of_v<Actuator, Model>)
    type.safe_states = {SafeState::stop};
  // Changes and scheduling.
  type.changeable = Changes<Model> || HasNoises<Model>;
  if constexpr (requires { Model::fixed_keys; })
    type.fixed_keys.assign(std::begin(Model::fixed_keys), std::end(Model::fixed_keys));
  if constexpr (requires { Model::without_effect; })
    type.without_effect.assign(std::begin(Model::without_effect), std::end(Model::without_effect));
  if constexpr (requires { Model::always_on; }) type.always_on = Model::always_on;
  if constexpr (requires { Model::casts_rays; }) type.casts_rays = Model::casts_rays;
  if constexpr (requires { Model::sweeps; }) type.sweeps = Model::sweeps;
  if constexpr (requires { Model::measures_alone; }) type.measures_alone = Model::measures_alone;
  if constexpr (requires { Model::acts_alone; }) type.acts_alone = Model::acts_alone;
  type.sleeps = !std::is_base_of_v<Actuator, Model> && Idles<Model> && Acts<Model>;
  // Construction.
  type.make_params = [] { return std::make_shared<ParamsOf<typename Model::Params>>(); };
  type.build = build_device<Model, ReporterType, ControllerType>;
  DeviceRegistry::instance().add(std::move(type));
  return true;
}

}  // namespace detail

/// Registers a sensor.  `output`: a message type, filled by fill() (see MessageReporter), or a Reporter for a device
/// that publishes several messages or sets their time stamps itself.
#define SHOAL_SENSOR(name, Model, output) SHOAL_DEVICE(name, Model, output, void)
#define SHOAL_ACTUATOR(name, Model, ControllerType) SHOAL_DEVICE(name, Model, void, ControllerType)
/// Registers a device that is sensor and actuator: its model is a Sensor that may also have act(), make_safe() and
/// power_W().
#define SHOAL_TRANSCEIVER(name, Model, output, ControllerType) SHOAL_DEVICE(name, Model, output, ControllerType)
#define SHOAL_DEVICE(name, Model, output, ControllerType) \
  [[maybe_unused]] static const bool registered_##Model = ::sim::detail::add_device<Model, output, ControllerType>(name)

}  // namespace sim
