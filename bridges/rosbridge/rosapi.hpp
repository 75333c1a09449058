// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/ros2/topic_table.hpp"
#include "bridges/rosbridge/ros_json.hpp"

namespace bridges::rosbridge {

/// Topic on which a run takes commands.
struct CommandTopic {
  struct Type {
    std::string name;        ///< such as `shoal_interfaces/msg/HelmCommand`
    std::string lcm_type;    ///< of the command that is made of it
    bool unchanged = false;  ///< a missing number means "as before", not 0
  };
  std::string topic;        ///< such as `/rover1/drive/cmd`
  std::vector<Type> types;  ///< the first one is listed
  std::string vehicle;      ///< that is commanded
  std::string channel;      ///< of the command
};

/// What clients may ask for.
struct Graph {
  const std::vector<ros2::Topic>& topics;
  const std::map<std::string, CommandTopic, std::less<>>& commands;
  bool has_services = false;  ///< those of the run
  std::int64_t utime = 0;     ///< of the newest message
};

/// Name of the only node.
inline constexpr const char* node_name = "/shoal";

/// Returns the schema text of a type of ROS 2: one of a topic, or of a command.  Throws WebError if there is none.
std::string schema_of(const Graph& graph, std::string_view type);
/// Returns whether a name is that of a service of rosapi.
bool is_rosapi(std::string_view service);
/// Answers a call of rosapi.  Throws WebError with the reason if it cannot be answered.
nlohmann::json answer_rosapi(const Graph& graph, std::string_view service, const nlohmann::json& args);

}  // namespace bridges::rosbridge
