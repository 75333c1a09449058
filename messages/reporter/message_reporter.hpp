// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <type_traits>
#include <typeinfo>

#include "shoal/message_codec.hpp"
#include "sim/device/device_registry.hpp"

namespace sim {

/// Reporter of one message per sample.  A device fills its message in a function next to its model:
///
///     void fill(const Pressure& pressure, shoal::pressure_t& message);
///     SHOAL_SENSOR("pressure", Pressure, shoal::pressure_t);
///
/// `message.utime` is set before fill() is called: the time of the sample by the clock of the vehicle.  All other
/// members are zero or empty, unless the model declares `static constexpr bool reuses_message = true`: then they keep
/// their values of the previous call, so that large arrays keep their memory, and fill() must set all of them.
/// A fill() that returns false has nothing to report for this sample.
template <typename Model, typename Message>
class MessageReporter final : public Reporter {
 public:
  /// `model` must outlive the reporter.
  explicit MessageReporter(const Model& model) : model_(model) {}

  /// Fills the message and publishes it.
  void report(Time sampled_at, Publisher& out) const override {
    if constexpr (requires { requires Model::reuses_message; }) {
      static thread_local Message message{};
      publish(sampled_at, message, out);
    } else {
      Message message{};
      publish(sampled_at, message, out);
    }
  }

  /// Returns the name of the message type in schemas, such as `shoal.pressure_t`.
  static std::string message_name() {
    const std::unique_ptr<char, decltype(&std::free)> type(
        abi::__cxa_demangle(typeid(Message).name(), nullptr, nullptr, nullptr), &std::free);
    std::string name = type.get();
    for (std::size_t at; (at = name.find("::")) != std::string::npos;) name.replace(at, 2, ".");
    return name;
  }

 private:
  void publish(Time sampled_at, Message& message, Publisher& out) const {
    message.utime = out.utime(sampled_at);
    if constexpr (std::is_same_v<decltype(fill(model_, message)), bool>) {
      if (!fill(model_, message)) return;
    } else {
      fill(model_, message);
    }
    shoal::encode_into(message, out.buffer());
    out.publish(out.buffer());
  }

  const Model& model_;
};

}  // namespace sim
