// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosapi.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "bridges/web/web_error.hpp"

// The answers to a client are in rosbridge_protocol_test.cpp.

namespace {

using namespace bridges::rosbridge;
using Json = nlohmann::json;

class RosapiTest : public testing::Test {
 protected:
  std::string error_of(const std::string& service, const Json& args) {
    try {
      answer_rosapi(graph_, service, args);
    } catch (const bridges::WebError& error) {
      return error.what();
    }
    return "";
  }

  std::vector<bridges::ros2::Topic> topics_{
      {0, "/a", "cdr", "std_msgs/msg/Header", "string frame_id\n", "a", "", false},
      {1, "/b/bytes", "lcm", "", "", "b", "", false}};
  std::map<std::string, CommandTopic, std::less<>> commands_{
      {"/r/cmd", {"/r/cmd", {{"shoal_interfaces/msg/HelmCommand", "shoal.helm_command_t", true}}, "r", "r.cmd"}}};
  Graph graph_{topics_, commands_, true, -5};
};

TEST_F(RosapiTest, TopicsThatHaveNoTypeAreNone) {
  EXPECT_EQ(answer_rosapi(graph_, "/rosapi/topics", {})["topics"], Json::array({"/a", "/r/cmd"}));
  EXPECT_EQ(answer_rosapi(graph_, "/rosapi/publishers", {{"topic", "/a"}})["publishers"], Json::array({"/shoal"}));
  EXPECT_EQ(answer_rosapi(graph_, "/rosapi/publishers", {{"topic", "/r/cmd"}})["publishers"], Json::array());
  EXPECT_EQ(answer_rosapi(graph_, "/rosapi/subscribers", {{"topic", "r/cmd"}})["subscribers"], Json::array({"/shoal"}));
}

TEST_F(RosapiTest, ATypeIsThatOfATopicOrACommandOrAStandardOne) {
  EXPECT_EQ(schema_of(graph_, "std_msgs/Header"), "string frame_id\n");
  EXPECT_THAT(schema_of(graph_, "shoal_interfaces/HelmCommand"), testing::HasSubstr("float64 heading_rad"));
  EXPECT_THAT(schema_of(graph_, "geometry_msgs/msg/Twist"), testing::StartsWith("geometry_msgs/Vector3 linear\n"));
  EXPECT_EQ(error_of("/rosapi/message_details", {{"type", "a/B"}}), "there is no type 'a/B'");
}

TEST_F(RosapiTest, ServicesOfTheRunAreListedWithControlOnly) {
  const auto of_run = [](const Graph& graph) {
    return answer_rosapi(graph, "/rosapi/services_for_type", {{"type", "shoal_interfaces/srv/Pause"}})["services"];
  };
  EXPECT_EQ(of_run(graph_), Json::array({"/shoal/pause"}));
  EXPECT_EQ(of_run({topics_, commands_, false, 0}), Json::array());
  EXPECT_EQ(answer_rosapi(graph_, "/rosapi/service_type", {{"service", "/shoal/step"}})["type"],
            "shoal_interfaces/srv/Step");
}

TEST_F(RosapiTest, ATimeBeforeTheFirstMessageIsZero) {
  EXPECT_EQ(answer_rosapi(graph_, "/rosapi/get_time", {})["time"], Json({{"sec", 0}, {"nanosec", 0}}));
  EXPECT_EQ(error_of("/rosapi/node_details", {{"node", "/x"}}), "the only node is /shoal");
}

}  // namespace
