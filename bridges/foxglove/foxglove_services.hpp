// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace bridges::foxglove {

/// Service that makes a request of `sim.control`.
struct Service {
  enum class Argument { none, number, whole_number, text };

  std::uint32_t id = 0;
  std::string_view name;     ///< such as `/shoal/rewind`
  std::string_view type;     ///< such as `shoal_interfaces/srv/Rewind`
  std::string_view command;  ///< of `sim.control`
  Argument argument = Argument::none;
  std::string_view member;  ///< of the request: name of the argument
};

/// Argument of a call.
struct ServiceArgument {
  double value = 0;
  std::string text;
};

/// Returns all services: pause, resume, step, speed, rewind, spawn and do.
std::span<const Service> services();
/// Returns a service by its number; null: there is none.
const Service* find_service(std::uint32_t id);
/// Returns the definition of its request in `ros2msg`.
std::string request_schema(const Service& service);
/// Definition of every response in `ros2msg`.
inline constexpr const char* response_schema = "bool success\nstring message\n";

/// Reads the request of a call, in encoding `cdr` or `json`.  Throws WebError with the reason if it is invalid.
ServiceArgument read_request(const Service& service, std::string_view encoding, std::string_view payload);
/// Returns the response in the same encoding.
std::string response(std::string_view encoding, bool success, std::string_view message);

}  // namespace bridges::foxglove
