// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosapi.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "bridges/foxglove/foxglove_services.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "bridges/web/web_error.hpp"
#include "shoal/message_schema.hpp"

namespace bridges::rosbridge {
namespace {

using Json = nlohmann::json;

/// Topics and their types: those of the run, then those that it takes.
using Typed = std::vector<std::pair<std::string, std::string>>;

Typed published(const Graph& graph) {
  Typed all;
  for (const ros2::Topic& topic : graph.topics)
    if (topic.encoding == "cdr") all.emplace_back(topic.name, topic.type);
  return all;
}

Typed subscribed(const Graph& graph) {
  Typed all;
  for (const auto& [name, command] : graph.commands) all.emplace_back(name, command.types.front().name);
  return all;
}

Typed all_topics(const Graph& graph) {
  Typed all = published(graph);
  for (auto& each : subscribed(graph)) all.push_back(std::move(each));
  return all;
}

std::string type_of(const Typed& topics, const std::string& name) {
  const auto found = std::find_if(topics.begin(), topics.end(), [&](const auto& each) { return each.first == name; });
  return found == topics.end() ? "" : found->second;
}

Json names_of(const Typed& topics) {
  Json names = Json::array();
  for (const auto& each : topics) names.push_back(each.first);
  return names;
}

Json topics_json(const Graph& graph, bool with_texts) {
  Json names = Json::array(), types = Json::array(), texts = Json::array();
  for (const auto& [name, type] : all_topics(graph)) {
    names.push_back(name);
    types.push_back(type);
    if (with_texts) texts.push_back(schema_of(graph, type));
  }
  Json values{{"topics", std::move(names)}, {"types", std::move(types)}};
  if (with_texts) values["typedefs_full_text"] = std::move(texts);
  return values;
}

std::vector<std::pair<std::string, std::string>> all_services(const Graph& graph);

/// Returns the argument with this name: of an object, or the first of a list.
std::string argument(const Json& args, const char* name) {
  const Json* value = nullptr;
  if (args.is_object() && args.contains(name)) value = &args[name];
  if (args.is_array() && !args.empty()) value = &args.front();
  if (value == nullptr || !value->is_string())
    throw WebError(std::string("the argument '") + name + "' must be a text");
  return value->get<std::string>();
}

std::string name_argument(const Json& args, const char* name) {
  const std::string text = argument(args, name);
  return text.starts_with('/') ? text : "/" + text;
}

/// Length of an array as rosapi has it: -1 no array, 0 of any size.
int array_length(const RosType::Member& member) {
  if (member.array == RosType::Array::none) return -1;
  return member.array == RosType::Array::sequence ? 0 : static_cast<int>(member.count);
}

Json message_details(const Graph& graph, const Json& args) {
  const std::string name = argument(args, "type");
  const RosType type(name, schema_of(graph, name));
  Json all = Json::array();
  for (const RosType::Definition& each : type.definitions()) {
    Json names = Json::array(), types = Json::array(), lengths = Json::array(), examples = Json::array();
    for (const RosType::Member& member : each.members) {
      names.push_back(member.name);
      types.push_back(member.type);
      lengths.push_back(array_length(member));
      const bool is_array = member.array != RosType::Array::none;
      examples.push_back(is_array ? "[]" : member.kind == RosType::Kind::compound ? "{}" : "0");
    }
    all.push_back({{"type", each.name},
                   {"fieldnames", std::move(names)},
                   {"fieldtypes", std::move(types)},
                   {"fieldarraylen", std::move(lengths)},
                   {"examples", std::move(examples)},
                   {"constnames", Json::array()},
                   {"constvalues", Json::array()}});
  }
  return {{"typedefs", std::move(all)}};
}

Json nodes_if(bool is_one) {
  return is_one ? Json::array({node_name}) : Json::array();
}

Json node_details(const Graph& graph, const Json& args) {
  if (name_argument(args, "node") != node_name) throw WebError(std::string("the only node is ") + node_name);
  Json services = Json::array();
  for (const auto& each : all_services(graph)) services.push_back(each.first);
  return {{"subscribing", names_of(subscribed(graph))},
          {"publishing", names_of(published(graph))},
          {"services", std::move(services)}};
}

Json topics_for_type(const Graph& graph, const Json& args) {
  const std::string type = short_name(argument(args, "type"));
  Json names = Json::array();
  for (const auto& each : all_topics(graph))
    if (short_name(each.second) == type) names.push_back(each.first);
  return {{"topics", std::move(names)}};
}

Json services_json(const Graph& graph, const std::function<bool(const std::string& type)>& selects) {
  Json names = Json::array();
  for (const auto& [name, type] : all_services(graph))
    if (selects(type)) names.push_back(name);
  return {{"services", std::move(names)}};
}

Json service_type(const Graph& graph, const Json& args) {
  const std::string name = name_argument(args, "service");
  for (const auto& each : all_services(graph))
    if (each.first == name) return {{"type", each.second}};
  return {{"type", ""}};
}

Json time_json(std::int64_t utime) {
  constexpr std::int64_t us_per_s = 1'000'000, ns_per_us = 1000;
  const std::int64_t us = std::max<std::int64_t>(0, utime);
  return {{"time", {{"sec", us / us_per_s}, {"nanosec", us % us_per_s * ns_per_us}}}};
}

struct Call {
  std::string_view name, type;  ///< of the service, without /rosapi/
  Json (*answer)(const Graph& graph, const Json& args);
};

constexpr std::array calls{
    Call{"topics", "Topics", [](const Graph& graph, const Json&) { return topics_json(graph, false); }},
    Call{"topics_and_raw_types", "TopicsAndRawTypes",
         [](const Graph& graph, const Json&) { return topics_json(graph, true); }},
    Call{"topic_type", "TopicType",
         [](const Graph& graph, const Json& args) -> Json {
           return {{"type", type_of(all_topics(graph), name_argument(args, "topic"))}};
         }},
    Call{"topics_for_type", "TopicsForType", topics_for_type},
    Call{"publishers", "Publishers",
         [](const Graph& graph, const Json& args) -> Json {
           return {{"publishers", nodes_if(!type_of(published(graph), name_argument(args, "topic")).empty())}};
         }},
    Call{"subscribers", "Subscribers",
         [](const Graph& graph, const Json& args) -> Json {
           return {{"subscribers", nodes_if(!type_of(subscribed(graph), name_argument(args, "topic")).empty())}};
         }},
    Call{"message_details", "MessageDetails", message_details},
    Call{"services", "Services",
         [](const Graph& graph, const Json&) { return services_json(graph, [](const std::string&) { return true; }); }},
    Call{"services_for_type", "ServicesForType",
         [](const Graph& graph, const Json& args) {
           return services_json(graph,
                                [wanted = argument(args, "type")](const std::string& type) { return type == wanted; });
         }},
    Call{"service_type", "ServiceType", service_type},
    Call{"nodes", "Nodes",
         [](const Graph&, const Json&) -> Json {
           return {{"nodes", nodes_if(true)}};
         }},
    Call{"node_details", "NodeDetails", node_details},
    Call{"get_time", "GetTime", [](const Graph& graph, const Json&) { return time_json(graph.utime); }},
    Call{"get_param_names", "GetParamNames",
         [](const Graph&, const Json&) -> Json {
           return {{"names", Json::array()}};
         }},
    Call{"get_ros_version", "GetROSVersion",
         [](const Graph&, const Json&) -> Json {
           return {{"version", 2}, {"distro", ""}};
         }},
};

constexpr std::string_view prefix = "/rosapi/";

std::vector<std::pair<std::string, std::string>> all_services(const Graph& graph) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const Call& each : calls)
    all.emplace_back(std::string(prefix) + std::string(each.name), "rosapi_msgs/srv/" + std::string(each.type));
  if (graph.has_services)
    for (const foxglove::Service& each : foxglove::services()) all.emplace_back(each.name, each.type);
  return all;
}

}  // namespace

std::string schema_of(const Graph& graph, std::string_view type) {
  const std::string name = short_name(type);
  for (const ros2::Topic& topic : graph.topics)
    if (short_name(topic.type) == name) return topic.schema;
  for (const auto& [topic, command] : graph.commands)
    for (const CommandTopic::Type& each : command.types) {
      if (short_name(each.name) != name) continue;
      const shoal::MessageSchema* const schema = shoal::embedded_types().find(each.lcm_type);
      if (schema != nullptr && ros2::short_type_name(schema->name) == name) return ros2::schema_text(*schema);
    }
  try {
    return ros2::standard_schema_text(name);
  } catch (const std::out_of_range&) {
    throw WebError("there is no type '" + std::string(type) + "'");
  }
}

bool is_rosapi(std::string_view service) {
  return service.starts_with(prefix);
}

Json answer_rosapi(const Graph& graph, std::string_view service, const Json& args) {
  const std::string_view name = service.substr(prefix.size());
  const auto* const call =
      std::find_if(calls.begin(), calls.end(), [&](const Call& each) { return each.name == name; });
  if (call == calls.end()) throw WebError("there is no service " + std::string(service));
  return call->answer(graph, args);
}

}  // namespace bridges::rosbridge
