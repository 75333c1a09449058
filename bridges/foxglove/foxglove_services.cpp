// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_services.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "bridges/base/json_text.hpp"
#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "bridges/web/client_json.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges::foxglove {
namespace {

using Json = nlohmann::json;
using Argument = Service::Argument;

constexpr std::array all_services{
    Service{1, "/shoal/pause", "shoal_interfaces/srv/Pause", "pause", Argument::none, ""},
    Service{2, "/shoal/resume", "shoal_interfaces/srv/Resume", "resume", Argument::none, ""},
    Service{3, "/shoal/step", "shoal_interfaces/srv/Step", "step", Argument::whole_number, "steps"},
    Service{4, "/shoal/speed", "shoal_interfaces/srv/Speed", "speed", Argument::number, "speed"},
    Service{5, "/shoal/rewind", "shoal_interfaces/srv/Rewind", "rewind", Argument::number, "seconds"},
    Service{6, "/shoal/spawn", "shoal_interfaces/srv/Spawn", "spawn", Argument::text, "request"},
    Service{7, "/shoal/do", "shoal_interfaces/srv/Do", "do", Argument::text, "action"},
};

constexpr std::size_t max_request_bytes = 65'536;

[[noreturn]] void refuse(const Service& service, const std::string& rule) {
  throw WebError("request of " + std::string(service.name) + ": '" + std::string(service.member) + "' must be " + rule);
}

double checked(const Service& service, double value) {
  if (!std::isfinite(value)) refuse(service, "a finite number");
  return value;
}

ServiceArgument read_json(const Service& service, std::string_view payload) {
  if (service.argument == Argument::none) return {};
  const Json request = parse_client_json(payload);
  const auto value = request.find(service.member);
  if (service.argument == Argument::text) {
    if (value == request.end() || !value->is_string() ||
        value->get_ref<const std::string&>().size() > max_request_bytes)
      refuse(service, "a text of at most 65536 bytes");
    return {0, value->get<std::string>()};
  }
  const bool is_right = value != request.end() &&
                        (service.argument == Argument::number ? value->is_number() : value->is_number_integer());
  if (!is_right) refuse(service, service.argument == Argument::number ? "a number" : "an integer");
  return {checked(service, value->get<double>()), ""};
}

/// The only member begins after the header, aligned for every type.
ServiceArgument read_cdr(const Service& service, std::string_view payload) {
  constexpr std::string_view little_endian{"\0\1\0\0", ros2::CdrWriter::header_bytes};
  if (service.argument == Argument::none) return {};
  if (!payload.starts_with(little_endian))
    throw WebError("request of " + std::string(service.name) + ": must begin with 00 01 00 00 (CDR, little-endian)");
  payload.remove_prefix(little_endian.size());
  const auto number = [&]<class T>(T value) {
    if (payload.size() < sizeof value) refuse(service, "complete");
    std::memcpy(&value, payload.data(), sizeof value);
    return value;
  };
  if (service.argument == Argument::number) return {checked(service, number(double{})), ""};
  if (service.argument == Argument::whole_number) return {static_cast<double>(number(std::int64_t{})), ""};

  // Text, with a NUL at its end
  const std::size_t size = number(std::uint32_t{});
  payload.remove_prefix(sizeof(std::uint32_t));
  if (size > payload.size() || size > max_request_bytes || (size > 0 && payload[size - 1] != '\0'))
    refuse(service, "a text of at most 65535 bytes");
  return {0, std::string(payload.substr(0, size > 0 ? size - 1 : 0))};
}

}  // namespace

std::span<const Service> services() {
  return all_services;
}

const Service* find_service(std::uint32_t id) {
  const auto* const found =
      std::find_if(all_services.begin(), all_services.end(), [id](const Service& each) { return each.id == id; });
  return found == all_services.end() ? nullptr : found;
}

std::string request_schema(const Service& service) {
  switch (service.argument) {
    case Argument::none:
      // A ROS 2 message must have a member; the generator of ROS gives empty ones this one.
      return std::string("uint8 ") + ros2::only_member + "\n";
    case Argument::number:
      return "float64 " + std::string(service.member) + "\n";
    case Argument::whole_number:
      return "int64 " + std::string(service.member) + "\n";
    case Argument::text:
      return "string " + std::string(service.member) + "\n";
  }
  return "";
}

ServiceArgument read_request(const Service& service, std::string_view encoding, std::string_view payload) {
  if (encoding == "json") return read_json(service, payload);
  if (encoding == "cdr") return read_cdr(service, payload);
  throw WebError("encoding of a service call must be 'cdr' or 'json'");
}

std::string response(std::string_view encoding, bool success, std::string_view message) {
  if (encoding == "json") return json_text({{"success", success}, {"message", message}});
  std::vector<std::byte> cdr;
  ros2::CdrWriter out(cdr);
  out.put(static_cast<std::uint8_t>(success));
  out.put(message);
  return {reinterpret_cast<const char*>(cdr.data()), cdr.size()};
}

}  // namespace bridges::foxglove
