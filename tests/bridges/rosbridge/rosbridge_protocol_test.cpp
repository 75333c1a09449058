// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_protocol.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "bridges/rosbridge/rosbridge_command.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/image_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/utime_t.hpp"

namespace {

using namespace bridges::rosbridge;
using bridges::WebClose;
using bridges::WebFrame;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using Json = nlohmann::json;

/// A client whose network is as slow as the test.
class RosClient final : public bridges::WebLink {
 public:
  RosClient(Protocol& protocol, int number) : number_(number), session_(protocol.open(*this)) {}

  int number() const override { return number_; }
  void wake() override {}
  void close(WebClose code, std::string) override { closed = code; }

  void send(const Json& message) { session_->receive(message.dump(), true); }
  void send_text(const std::string& text) { session_->receive(text, true); }
  void subscribe(const std::string& topic, Json more = Json::object()) {
    more.update({{"op", "subscribe"}, {"topic", topic}});
    send(more);
  }
  /// Reads all that waits, and returns the messages of an operation in it.
  std::vector<Json> read(const std::string& op) {
    WebFrame frame;
    std::vector<Json> found;
    while (session_->next(frame)) {
      Json message = Json::parse(*frame.bytes);
      if (message["op"] == op) found.push_back(std::move(message));
    }
    return found;
  }
  /// Calls a service that answers at once.
  Json call(const std::string& service, const Json& args = Json::object()) {
    send({{"op", "call_service"}, {"id", "c"}, {"service", service}, {"args", args}});
    const auto answers = read("service_response");
    EXPECT_THAT(answers, SizeIs(1));
    return answers.empty() ? Json() : answers.front();
  }
  void leave() { session_.reset(); }

  std::optional<WebClose> closed;

 private:
  int number_;
  std::unique_ptr<bridges::WebSession> session_;
};

/// The protocol with a thread that works when the test says so.
class RosbridgeProtocolTest : public testing::Test {
 protected:
  explicit RosbridgeProtocolTest(bool may_control = false)
      : protocol_([this](std::function<void()> work) { posted_.push_back(std::move(work)); }, may_control) {
    protocol_.set_commands(
        command_topics("r1", {"r1.drive.cmd"}, {"shoal.twist_command_t"}, [](std::string_view) { return false; }));
    run();
  }
  void run() {
    protocol_.flush();
    for (const auto& work : std::exchange(posted_, {})) work();
  }
  template <class Message>
  void publish(std::int64_t utime, const std::string& channel, const Message& message) {
    protocol_.message(utime, channel, shoal::encode(message));
    run();
  }
  void publish_fix(double latitude_deg) {
    shoal::gps_data_t gps{};
    gps.utime = 1'500'000;
    gps.latitude = latitude_deg;
    gps.gps_lock = 1;
    publish(1'500'000, "r1.gps", gps);
  }

  std::vector<std::function<void()>> posted_;
  Protocol protocol_;
};

class RosbridgeControlTest : public RosbridgeProtocolTest {
 protected:
  RosbridgeControlTest() : RosbridgeProtocolTest(true) {}
};

TEST_F(RosbridgeProtocolTest, ASubscriptionBeforeTheTopicExistsGetsItsMessages) {
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix", {{"type", "sensor_msgs/NavSatFix"}});
  publish_fix(43);  // shows that there is such a topic
  publish_fix(44);
  const auto messages = client.read("publish");
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_EQ(messages[0]["topic"], "/r1/gps/fix");
  EXPECT_EQ(messages[0]["msg"]["latitude"], 44);
  EXPECT_EQ(messages[0]["msg"]["header"]["stamp"], Json({{"sec", 1}, {"nanosec", 500'000'000}}));
  EXPECT_EQ(messages[0]["msg"]["header"]["frame_id"], "r1/gps");
}

TEST_F(RosbridgeProtocolTest, EachMessageComesOnceHoweverOftenATopicIsSubscribed) {
  publish_fix(1);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix", {{"id", "a"}});
  client.subscribe("/r1/gps/fix", {{"id", "b"}});
  publish_fix(2);
  EXPECT_THAT(client.read("publish"), SizeIs(1));
  client.send({{"op", "unsubscribe"}, {"topic", "/r1/gps/fix"}, {"id", "a"}});
  publish_fix(3);
  EXPECT_THAT(client.read("publish"), SizeIs(1));
  client.send({{"op", "unsubscribe"}, {"topic", "/r1/gps/fix"}, {"id", "b"}});
  publish_fix(4);
  EXPECT_THAT(client.read("publish"), IsEmpty());
}

TEST_F(RosbridgeProtocolTest, TheThreadOfTheServerIsWokenOnceForTheMessagesOfAStep) {
  publish_fix(1);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix");
  shoal::gps_data_t gps{};
  gps.gps_lock = 1;
  for (int i = 0; i < 10; ++i) protocol_.message(i, "r1.gps", shoal::encode(gps));
  EXPECT_THAT(posted_, IsEmpty());
  run();
  EXPECT_THAT(client.read("publish"), SizeIs(10));
}

TEST_F(RosbridgeProtocolTest, ASubscriptionOfAnotherTypeIsRefused) {
  publish_fix(1);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix", {{"type", "sensor_msgs/msg/Imu"}});
  const auto statuses = client.read("status");
  ASSERT_THAT(statuses, SizeIs(1));
  EXPECT_EQ(statuses[0]["level"], "error");
  EXPECT_EQ(statuses[0]["msg"], "subscribe /r1/gps/fix: its type is sensor_msgs/msg/NavSatFix, not sensor_msgs/Imu");
  publish_fix(2);
  EXPECT_THAT(client.read("publish"), IsEmpty());
}

TEST_F(RosbridgeProtocolTest, AClientThatLeftIsNotServed) {
  publish_fix(1);
  RosClient gone(protocol_, 1), stays(protocol_, 2);
  gone.subscribe("/r1/gps/fix");
  stays.subscribe("/r1/gps/fix");
  gone.leave();
  publish_fix(2);
  EXPECT_THAT(stays.read("publish"), SizeIs(1));
  EXPECT_EQ(protocol_.clients(), 1);
}

TEST_F(RosbridgeProtocolTest, WithAThrottleMessagesInBetweenAreLeftOut) {
  publish_fix(0);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix", {{"throttle_rate", 3'600'000}});
  for (int i = 1; i <= 5; ++i) publish_fix(i);
  const auto messages = client.read("publish");
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_EQ(messages[0]["msg"]["latitude"], 1);
}

TEST_F(RosbridgeProtocolTest, WithAThrottleAndAQueueTheNewestFollowWhenTheyAreDue) {
  publish_fix(0);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix", {{"throttle_rate", 20}, {"queue_length", 2}});
  for (int i = 1; i <= 5; ++i) publish_fix(i);
  std::vector<double> latitudes;
  // The first at once; of the other four the queue holds the two newest
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (latitudes.size() < 3 && std::chrono::steady_clock::now() < end) {
    for (const Json& each : client.read("publish")) latitudes.push_back(each["msg"]["latitude"]);
    protocol_.release();
    run();
  }
  EXPECT_THAT(latitudes, testing::ElementsAre(1, 4, 5));
  EXPECT_THAT(client.read("publish"), IsEmpty());
}

TEST_F(RosbridgeProtocolTest, AQueueOfOneHoldsTheNewestMessage) {
  publish_fix(0);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix", {{"queue_length", 1}});
  for (int i = 1; i <= 5; ++i) publish_fix(i);
  const auto messages = client.read("publish");
  ASSERT_THAT(messages, SizeIs(1));
  EXPECT_EQ(messages[0]["msg"]["latitude"], 5);
}

TEST_F(RosbridgeProtocolTest, AClientThatDoesNotReadLosesTheOldestAndIsTold) {
  publish_fix(0);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/gps/fix");
  constexpr std::size_t excess = 7;
  for (std::size_t i = 0; i < Protocol::max_queued_messages + excess; ++i) publish_fix(static_cast<double>(i % 90));
  RosClient other(protocol_, 2);  // reads all of its own
  const auto statuses = client.read("status");
  ASSERT_THAT(statuses, SizeIs(1));
  EXPECT_EQ(statuses[0]["msg"], "7 messages were dropped, because they come faster than this client reads them");
  EXPECT_THAT(other.read("status"), IsEmpty());
}

TEST_F(RosbridgeProtocolTest, BytesAreInBase64AndTheSceneComesToLaterClients) {
  shoal::image_t image{};
  image.width = 2;
  image.height = 1;
  image.row_stride = 2;
  image.pixelformat = 1497715271;  // GRAY
  image.data = {'f', 'o'};
  image.size = 2;
  publish(0, "r1.camera", image);
  RosClient client(protocol_, 1);
  client.subscribe("/r1/camera");
  publish(1, "r1.camera", image);
  const auto images = client.read("publish");
  ASSERT_THAT(images, SizeIs(1));
  EXPECT_EQ(images[0]["msg"]["data"], "Zm8=");
  shoal::sim_scene_t scene{};
  scene.scene = R"({"op":"scene","bodies":[{"id":0,"name":"box","owner":"box","fixed":true,
      "parts":[{"shape":"box","size_m":[1,2,3]}]}]})";
  publish(2, "sim.scene", scene);
  client.subscribe("/scene");
  EXPECT_THAT(client.read("publish"), SizeIs(1));
}

TEST_F(RosbridgeProtocolTest, RosapiKnowsTopicsTypesServicesAndTheNode) {
  publish_fix(1);
  RosClient client(protocol_, 1);
  const Json topics = client.call("/rosapi/topics");
  EXPECT_EQ(topics["result"], true);
  EXPECT_EQ(topics["id"], "c");
  EXPECT_THAT(topics["values"]["topics"].get<std::vector<std::string>>(),
              testing::IsSupersetOf({"/r1/gps", "/r1/gps/fix", "/r1/cmd_vel", "/r1/drive/cmd"}));
  EXPECT_EQ(topics["values"]["topics"].size(), topics["values"]["types"].size());
  EXPECT_EQ(client.call("rosapi/topic_type", {{"topic", "/r1/gps/fix"}})["values"]["type"],
            "sensor_msgs/msg/NavSatFix");
  EXPECT_EQ(client.call("/rosapi/topic_type", Json::array({"/r1/cmd_vel"}))["values"]["type"],
            "geometry_msgs/msg/Twist");
  EXPECT_EQ(client.call("/rosapi/topics_for_type", {{"type", "sensor_msgs/NavSatFix"}})["values"]["topics"],
            Json::array({"/r1/gps/fix"}));
  EXPECT_EQ(client.call("/rosapi/nodes")["values"]["nodes"], Json::array({"/shoal"}));
  EXPECT_THAT(client.call("/rosapi/node_details", {{"node", "/shoal"}})["values"]["subscribing"],
              Json::array({"/r1/cmd_vel", "/r1/drive/cmd"}));
  EXPECT_THAT(client.call("/rosapi/services")["values"]["services"].get<std::vector<std::string>>(),
              testing::AllOf(Contains("/rosapi/topics"), Not(Contains("/shoal/pause"))));
  EXPECT_EQ(client.call("/rosapi/get_time")["values"]["time"], Json({{"sec", 1}, {"nanosec", 500'000'000}}));
  const Json details = client.call("/rosapi/message_details", {{"type", "geometry_msgs/Twist"}});
  EXPECT_EQ(details["values"]["typedefs"][0]["fieldnames"], Json::array({"linear", "angular"}));
  EXPECT_EQ(details["values"]["typedefs"][1]["type"], "geometry_msgs/Vector3");
  const Json missing = client.call("/rosapi/topic_type");
  EXPECT_EQ(missing["result"], false);
  EXPECT_EQ(missing["values"], "the argument 'topic' must be a text");
  EXPECT_EQ(client.call("/nothing")["values"], "there is no service /nothing");
  EXPECT_EQ(client.call("/rosapi/nothing")["values"], "there is no service /rosapi/nothing");
}

TEST_F(RosbridgeProtocolTest, WithoutPermissionNothingIsControlled) {
  RosClient client(protocol_, 1);
  const std::string off = "control is off: start Shoal with --rosbridge-control";
  client.send({{"op", "advertise"}, {"topic", "/r1/cmd_vel"}, {"type", "geometry_msgs/Twist"}});
  client.send({{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", Json::object()}});
  const auto statuses = client.read("status");
  ASSERT_THAT(statuses, SizeIs(2));
  for (const Json& each : statuses) EXPECT_EQ(each["msg"], off);
  const Json paused = client.call("/shoal/pause");
  EXPECT_EQ(paused["result"], false);
  EXPECT_EQ(paused["values"], off);
  EXPECT_FALSE(protocol_.take_request());
}

TEST_F(RosbridgeControlTest, ATwistBecomesACommandOfItsVehicle) {
  RosClient client(protocol_, 1);
  client.send({{"op", "advertise"}, {"topic", "/r1/cmd_vel"}, {"type", "geometry_msgs/Twist"}});
  client.send({{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", {{"linear", {{"x", 2}}}}}});
  EXPECT_THAT(client.read("status"), IsEmpty());
  const auto request = protocol_.take_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->kind, Request::Kind::command);
  EXPECT_EQ(request->vehicle, "r1");
  EXPECT_EQ(request->channel, "r1.drive.cmd");
  EXPECT_EQ(shoal::decode<shoal::twist_command_t>(request->payload, shoal::Finite::required).forward_mps, 2);
}

TEST_F(RosbridgeControlTest, WhatNothingTakesIsRefused) {
  RosClient client(protocol_, 1);
  client.send({{"op", "publish"}, {"topic", "/r2/cmd_vel"}, {"id", "p"}, {"msg", Json::object()}});
  client.send({{"op", "advertise"}, {"topic", "/r1/cmd_vel"}, {"type", "std_msgs/String"}});
  client.send({{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", {{"speed", 1}}}});
  const auto statuses = client.read("status");
  ASSERT_THAT(statuses, SizeIs(3));
  EXPECT_THAT(statuses[0]["msg"].get<std::string>(), HasSubstr("/r2/cmd_vel: nothing takes messages there"));
  EXPECT_EQ(statuses[0]["id"], "p");
  EXPECT_THAT(statuses[1]["msg"].get<std::string>(), HasSubstr("its type must be geometry_msgs/msg/Twist"));
  EXPECT_THAT(statuses[2]["msg"].get<std::string>(), HasSubstr("has no member \"speed\""));
  EXPECT_FALSE(protocol_.take_request());
}

TEST_F(RosbridgeControlTest, AServiceOfTheRunIsAnsweredWhenItWasCarriedOut) {
  RosClient client(protocol_, 1);
  client.send({{"op", "call_service"}, {"id", "s"}, {"service", "/shoal/step"}, {"args", {{"steps", 5}}}});
  EXPECT_THAT(client.read("service_response"), IsEmpty());
  const auto request = protocol_.take_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->command, "step");
  EXPECT_EQ(request->value, 5);
  protocol_.reply(*request, false, "no");
  run();
  const auto answers = client.read("service_response");
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_EQ(answers[0]["values"], Json({{"success", false}, {"message", "no"}}));
  EXPECT_EQ(answers[0]["id"], "s");
}

TEST_F(RosbridgeControlTest, RequestsThatWaitAreBounded) {
  RosClient client(protocol_, 1);
  for (std::size_t i = 0; i < Protocol::max_waiting_requests + 1; ++i)
    client.send({{"op", "publish"}, {"topic", "/r1/cmd_vel"}, {"msg", Json::object()}});
  const auto statuses = client.read("status");
  ASSERT_THAT(statuses, SizeIs(1));
  EXPECT_EQ(statuses[0]["msg"], "publish /r1/cmd_vel: too many messages of this client are waiting");
}

TEST_F(RosbridgeProtocolTest, InvalidMessagesAreAnsweredAndChangeNothing) {
  RosClient client(protocol_, 1);
  for (const char* text : {"", "{", "[]", "{}", R"({"op":"fragment"})", R"({"op":"subscribe","topic":7})"})
    client.send_text(text);
  EXPECT_THAT(client.read("status"), SizeIs(6));
  EXPECT_FALSE(client.closed);
  client.send({{"op", "set_level"}, {"level", "none"}});
  client.send_text("{");
  EXPECT_THAT(client.read("status"), IsEmpty());
}

TEST_F(RosbridgeProtocolTest, AClientThatDoesNotReadItsAnswersIsClosed) {
  RosClient client(protocol_, 1);
  for (std::size_t i = 0; i <= Protocol::max_waiting_texts; ++i) client.send_text("{");
  EXPECT_EQ(client.closed, WebClose::policy);
}

TEST_F(RosbridgeProtocolTest, SubscriptionsOfAClientAreBounded) {
  RosClient client(protocol_, 1);
  for (std::size_t i = 0; i < Protocol::max_subscriptions + 1; ++i) client.subscribe("/t" + std::to_string(i));
  const auto statuses = client.read("status");
  ASSERT_THAT(statuses, SizeIs(1));
  EXPECT_EQ(statuses[0]["msg"], "subscribe: a client has at most 4096 subscriptions");
}

TEST_F(RosbridgeProtocolTest, ATokenIsDemandedWhereItIsNeeded) {
  EXPECT_TRUE(protocol_.admits(""));
  protocol_.require_token([](std::string_view token) { return token == "secret"; });
  EXPECT_FALSE(protocol_.admits(""));
  EXPECT_FALSE(protocol_.admits("t=other"));
  EXPECT_TRUE(protocol_.admits("a=b&t=secret"));
}

}  // namespace
