// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/foxglove/foxglove_protocol.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "bridges/ros2/cdr.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/utime_t.hpp"

namespace {

using namespace bridges::foxglove;
using bridges::WebClose;
using bridges::WebFrame;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Json = nlohmann::json;

/// Message of an opcode, as a client reads it.
struct Binary {
  int opcode = 0;
  std::uint32_t subscription = 0;
  std::uint64_t time_ns = 0;
  std::string payload;
};

/// A client whose network is as slow as the test.
class Viewer final : public bridges::WebLink {
 public:
  Viewer(Protocol& protocol, int number) : number_(number), session_(protocol.open(*this)) {}

  int number() const override { return number_; }
  void wake() override {}
  void close(WebClose code, std::string) override { closed = code; }

  void send(const Json& message) { session_->receive(message.dump(), true); }
  void send_binary(const std::string& bytes) { session_->receive(bytes, false); }
  void subscribe(std::uint32_t id, const std::string& topic) {
    read();
    send({{"op", "subscribe"}, {"subscriptions", Json::array({{{"id", id}, {"channelId", channels.at(topic)}}})}});
  }
  /// Reads all that waits.
  void read() {
    WebFrame frame;
    while (session_->next(frame)) {
      if (frame.is_text)
        take(Json::parse(*frame.bytes));
      else
        take(*frame.bytes);
    }
  }
  void leave() { session_.reset(); }
  std::vector<int> opcodes() const {
    std::vector<int> all;
    for (const Binary& each : binaries) all.push_back(each.opcode);
    return all;
  }
  std::vector<Json> of(const std::string& op) const {
    std::vector<Json> found;
    for (const Json& each : texts)
      if (each["op"] == op) found.push_back(each);
    return found;
  }

  std::vector<Json> texts;
  std::vector<Binary> binaries;
  std::map<std::string, std::uint32_t> channels;  // by topic
  std::optional<WebClose> closed;

 private:
  void take(const Json& text) {
    texts.push_back(text);
    if (text["op"] != "advertise") return;
    for (const Json& channel : text["channels"]) channels[channel["topic"]] = channel["id"];
  }
  void take(const std::string& bytes) {
    Binary binary;
    binary.opcode = bytes.at(0);
    if (binary.opcode == 1) {
      std::memcpy(&binary.subscription, bytes.data() + 1, 4);
      std::memcpy(&binary.time_ns, bytes.data() + 5, 8);
      binary.payload = bytes.substr(13);
    } else if (binary.opcode == 2) {
      std::memcpy(&binary.time_ns, bytes.data() + 1, 8);
    } else {
      binary.payload = bytes.substr(1);
    }
    binaries.push_back(binary);
  }

  int number_;
  std::unique_ptr<bridges::WebSession> session_;
};

/// The protocol with a thread that works when the test says so.
class FoxgloveProtocolTest : public testing::Test {
 protected:
  void introduce(Control control = Control::none) {
    protocol_.introduce({"test", "session", {}, control, 1'000'000, 3'500'000});
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
  static shoal::sim_scene_t scene() {
    shoal::sim_scene_t message{};
    message.scene = R"({"op":"scene","bodies":[{"id":0,"name":"box","owner":"box","fixed":true,
        "parts":[{"shape":"box","size_m":[1,2,3]}]}]})";
    return message;
  }
  static std::string call_of(std::uint32_t service, const std::string& json) {
    std::string bytes = "\2";
    for (const std::uint32_t number : {service, 42u, 4u}) bytes.append(reinterpret_cast<const char*>(&number), 4);
    return bytes + "json" + json;
  }

  std::vector<std::function<void()>> posted_;
  Protocol protocol_{[this](std::function<void()> work) { posted_.push_back(std::move(work)); }};
};

TEST_F(FoxgloveProtocolTest, IntroducesItselfThenAdvertisesWhatIsThere) {
  Viewer viewer(protocol_, 1);
  viewer.read();
  EXPECT_THAT(viewer.texts, IsEmpty());  // nothing before the run is known
  introduce();
  publish(1, "rover1.gps", shoal::gps_data_t{});
  viewer.read();
  ASSERT_THAT(viewer.texts, SizeIs(2));
  EXPECT_EQ(viewer.texts[0]["op"], "serverInfo");
  EXPECT_EQ(viewer.texts[0]["capabilities"], Json::array({"time"}));
  EXPECT_EQ(viewer.texts[0]["supportedEncodings"], Json::array());
  const Json& channels = viewer.texts[1]["channels"];
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[0]["topic"], "/rover1/gps");
  EXPECT_EQ(channels[0]["schemaName"], "shoal_interfaces/msg/GpsData");
  EXPECT_EQ(channels[1]["topic"], "/rover1/gps/fix");
  EXPECT_EQ(channels[1]["encoding"], "cdr");
  EXPECT_EQ(channels[1]["schemaEncoding"], "ros2msg");
}

TEST_F(FoxgloveProtocolTest, SendsOnlyWhatIsSubscribed) {
  introduce();
  Viewer viewer(protocol_, 1), other(protocol_, 2);
  publish(1, "a.clock", shoal::utime_t{5});
  publish(2, "b.clock", shoal::utime_t{6});
  viewer.subscribe(77, "/b/clock");
  publish(3, "a.clock", shoal::utime_t{7});
  publish(4, "b.clock", shoal::utime_t{8});
  viewer.read();
  other.read();
  EXPECT_THAT(other.binaries, IsEmpty());
  ASSERT_THAT(viewer.binaries, SizeIs(1));
  EXPECT_EQ(viewer.binaries[0].subscription, 77u);
  EXPECT_EQ(viewer.binaries[0].time_ns, 4000u);
  std::vector<std::byte> cdr;
  const shoal::MessageSchema& schema = shoal::schema_of<shoal::utime_t>();
  ASSERT_EQ(bridges::ros2::to_cdr(schema, shoal::encode(shoal::utime_t{8}), cdr), std::nullopt);
  EXPECT_EQ(viewer.binaries[0].payload, std::string(reinterpret_cast<const char*>(cdr.data()), cdr.size()));
  viewer.send({{"op", "unsubscribe"}, {"subscriptionIds", Json::array({77})}});
  publish(5, "b.clock", shoal::utime_t{9});
  viewer.read();
  EXPECT_THAT(viewer.binaries, SizeIs(1));
}

TEST_F(FoxgloveProtocolTest, TopicsThatComeLaterAreAdvertisedLater) {
  introduce();
  Viewer viewer(protocol_, 1);
  publish(1, "a.clock", shoal::utime_t{});
  viewer.read();
  publish(2, "late.clock", shoal::utime_t{});
  viewer.read();
  ASSERT_THAT(viewer.of("advertise"), SizeIs(2));
  EXPECT_EQ(viewer.of("advertise")[1]["channels"][0]["topic"], "/late/clock");
  protocol_.message(3, "strange", std::vector<std::byte>(20));  // of no known type
  run();
  viewer.read();
  EXPECT_THAT(viewer.of("advertise"), SizeIs(2));
}

TEST_F(FoxgloveProtocolTest, WithoutAClientNothingButTheFirstMessagesIsCopied) {
  introduce();
  publish(1, "a.clock", shoal::utime_t{});
  for (int i = 0; i < 100; ++i) protocol_.message(i, "a.clock", shoal::encode(shoal::utime_t{i}));
  protocol_.show_time(5);
  protocol_.set_state({});
  protocol_.flush();
  EXPECT_THAT(posted_, IsEmpty());
}

TEST_F(FoxgloveProtocolTest, ALateSubscriberGetsTheScene) {
  introduce();
  publish(1, "sim.scene", scene());
  Viewer viewer(protocol_, 1);
  viewer.subscribe(1, "/scene");
  viewer.read();
  ASSERT_THAT(viewer.binaries, SizeIs(1));
  EXPECT_THAT(viewer.binaries[0].payload, HasSubstr("body"));
}

TEST_F(FoxgloveProtocolTest, AfterAJumpTheEarlierTimeComesFirstThenTheScene) {
  introduce();
  Viewer viewer(protocol_, 1);
  publish(1, "sim.scene", scene());
  publish(1, "a.clock", shoal::utime_t{});
  viewer.subscribe(1, "/scene");
  viewer.subscribe(2, "/a/clock");
  viewer.read();
  viewer.binaries.clear();
  publish(9'000'000, "a.clock", shoal::utime_t{});  // not read before the jump
  protocol_.show_time(9'000'000);
  protocol_.jump(2'000'000);
  publish(2'000'000, "a.clock", shoal::utime_t{});
  viewer.read();
  EXPECT_THAT(viewer.opcodes(), ElementsAre(2, 1, 1));
  EXPECT_EQ(viewer.binaries[0].time_ns, 2'000'000'000u);
  EXPECT_EQ(viewer.binaries[1].subscription, 1u);
  EXPECT_EQ(viewer.binaries[2].time_ns, 2'000'000'000u);
}

TEST_F(FoxgloveProtocolTest, AClientThatDoesNotReadLosesTheOldestMessagesAndIsTold) {
  introduce();
  Viewer viewer(protocol_, 1);
  publish(0, "a.clock", shoal::utime_t{});
  viewer.subscribe(1, "/a/clock");
  const auto excess = std::uint64_t{500};
  for (std::uint64_t i = 0; i < Protocol::max_queued_messages + excess; ++i)
    publish(static_cast<std::int64_t>(i), "a.clock", shoal::utime_t{});
  viewer.read();
  EXPECT_THAT(viewer.binaries, SizeIs(Protocol::max_queued_messages));
  EXPECT_EQ(viewer.binaries.front().time_ns, excess * 1000);
  ASSERT_THAT(viewer.of("status"), SizeIs(1));
  EXPECT_EQ(viewer.of("status")[0]["level"], 1);
  EXPECT_THAT(viewer.of("status")[0]["message"].get<std::string>(), HasSubstr("limit reached: 500 messages"));
}

TEST_F(FoxgloveProtocolTest, WhatWaitsForAThreadIsBounded) {
  introduce();
  Viewer viewer(protocol_, 1);
  publish(0, "a.clock", shoal::utime_t{});
  viewer.subscribe(1, "/a/clock");
  for (std::size_t i = 0; i < bridges::ros2::WaitingMessages::max_messages + 10; ++i)
    protocol_.message(1, "a.clock", shoal::encode(shoal::utime_t{}));
  run();
  viewer.read();
  ASSERT_THAT(viewer.of("status"), SizeIs(1));
  const std::size_t lost = 10 + bridges::ros2::WaitingMessages::max_messages - Protocol::max_queued_messages;
  EXPECT_THAT(viewer.of("status")[0]["message"].get<std::string>(), HasSubstr(": " + std::to_string(lost) + " mess"));
}

TEST_F(FoxgloveProtocolTest, SubscriptionsThatMakeNoSenseAreRefused) {
  introduce();
  Viewer viewer(protocol_, 1);
  publish(0, "a.clock", shoal::utime_t{});
  viewer.subscribe(1, "/a/clock");
  viewer.subscribe(1, "/a/clock");
  viewer.subscribe(2, "/a/clock");
  viewer.send({{"op", "subscribe"}, {"subscriptions", Json::array({{{"id", 3}, {"channelId", 1000}}})}});
  viewer.send({{"op", "unsubscribe"}, {"subscriptionIds", Json::array({9})}});
  viewer.send({{"op", "fetchAsset"}});
  viewer.read();
  std::vector<std::string> messages;
  for (const Json& each : viewer.of("status")) messages.push_back(each["message"]);
  EXPECT_THAT(messages,
              ElementsAre(HasSubstr("its id is in use"), HasSubstr("has one already"), HasSubstr("no channel 1000"),
                          HasSubstr("no subscription 9"), HasSubstr("'fetchAsset' is not supported")));
}

TEST_F(FoxgloveProtocolTest, WithoutPermissionNothingIsControlled) {
  introduce(Control::none);
  Viewer viewer(protocol_, 1);
  viewer.read();
  viewer.send_binary(call_of(1, "{}"));
  viewer.send({{"op", "setParameters"}, {"parameters", Json::array({{{"name", "paused"}, {"value", true}}})}});
  viewer.send({{"op", "getParameters"}, {"parameterNames", Json::array()}});
  viewer.send_binary(std::string("\3\0", 2) + std::string("\0\0\x80\x3f", 4) + std::string(13, '\0'));
  viewer.read();
  EXPECT_THAT(viewer.of("serviceCallFailure"), SizeIs(1));
  EXPECT_THAT(viewer.of("status"), SizeIs(3));
  EXPECT_FALSE(protocol_.take_request());
  EXPECT_THAT(viewer.of("advertiseServices"), IsEmpty());
}

TEST_F(FoxgloveProtocolTest, AServiceBecomesARequestAndItsReplyAResponse) {
  introduce(Control::run);
  Viewer viewer(protocol_, 1);
  viewer.read();
  EXPECT_THAT(viewer.of("advertiseServices")[0]["services"], SizeIs(7));
  viewer.send_binary(call_of(3, R"({"steps":10})"));
  const auto request = protocol_.take_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->command, "step");
  EXPECT_EQ(request->value, 10);
  protocol_.reply(*request, false, "not now");
  run();
  viewer.read();
  ASSERT_THAT(viewer.binaries, SizeIs(1));
  EXPECT_EQ(viewer.binaries[0].opcode, 3);
  EXPECT_EQ(viewer.binaries[0].payload.substr(16), R"({"message":"not now","success":false})");
}

TEST_F(FoxgloveProtocolTest, RequestsOfAClientAreBounded) {
  introduce(Control::run);
  Viewer viewer(protocol_, 1);
  for (std::size_t i = 0; i < Protocol::max_waiting_requests + 1; ++i) viewer.send_binary(call_of(1, "{}"));
  viewer.read();
  ASSERT_THAT(viewer.of("serviceCallFailure"), SizeIs(1));
  EXPECT_THAT(viewer.of("serviceCallFailure")[0]["message"].get<std::string>(), HasSubstr("too many requests"));
}

TEST_F(FoxgloveProtocolTest, AClientThatDoesNotReadAnswersIsClosed) {
  introduce();
  Viewer viewer(protocol_, 1);
  for (std::size_t i = 0; i <= Protocol::max_waiting_texts; ++i) viewer.send_binary("");
  EXPECT_EQ(viewer.closed, WebClose::policy);
}

TEST_F(FoxgloveProtocolTest, ParametersAreSetAndTheirChangesSent) {
  introduce(Control::run);
  Viewer viewer(protocol_, 1);
  viewer.send({{"op", "subscribeParameterUpdates"}, {"parameterNames", Json::array({"speed"})}});
  viewer.send({{"op", "setParameters"},
               {"id", "x"},
               {"parameters", {{{"name", "paused"}, {"value", true}}, {{"name", "speed"}, {"value", 4}}}}});
  const auto pause = protocol_.take_request(), speed = protocol_.take_request();
  ASSERT_TRUE(pause && speed);
  EXPECT_EQ(pause->command, "pause");
  EXPECT_EQ(speed->command, "speed");
  EXPECT_EQ(speed->value, 4);
  protocol_.set_state({PlaybackState::Status::paused, 0, 4});
  protocol_.reply(*pause, true, "");
  protocol_.reply(*speed, true, "");
  run();
  viewer.read();
  const std::vector<Json> values = viewer.of("parameterValues");
  ASSERT_THAT(values, SizeIs(2));
  EXPECT_EQ(values[0]["parameters"], Json::parse(R"([{"name":"speed","value":4.0,"type":"float64"}])"));
  EXPECT_EQ(values[1]["id"], "x");
  EXPECT_EQ(values[1]["parameters"].size(), 2u);
  viewer.send({{"op", "setParameters"}, {"parameters", Json::array({{{"name", "depth"}, {"value", 1}}})}});
  viewer.read();
  EXPECT_THAT(viewer.of("status")[0]["message"].get<std::string>(), HasSubstr("unknown parameter 'depth'"));
}

TEST_F(FoxgloveProtocolTest, PlaybackStatesAreSentAfterTheFirstRequestOnly) {
  introduce(Control::playback);
  Viewer viewer(protocol_, 1);
  viewer.read();
  EXPECT_EQ(viewer.texts[0]["capabilities"], Json::array({"time", "playbackControl"}));
  EXPECT_EQ(viewer.texts[0]["dataEndTime"], Json::parse(R"({"sec":3,"nsec":500000000})"));
  protocol_.set_state({PlaybackState::Status::paused, 2'000'000, 1});
  run();
  viewer.read();
  EXPECT_THAT(viewer.binaries, IsEmpty());
  viewer.send_binary(std::string("\3\0", 2) + std::string("\0\0\x80\x3f", 4) + std::string(9, '\0') +
                     std::string("\1\0\0\0a", 5));
  const auto request = protocol_.take_request();
  ASSERT_TRUE(request);
  EXPECT_TRUE(request->playback.plays);
  protocol_.set_state({PlaybackState::Status::playing, 2'000'000, 1});
  protocol_.reply(*request, true, "");
  protocol_.set_state({PlaybackState::Status::playing, 2'000'000, 1});
  run();
  viewer.read();
  ASSERT_THAT(viewer.opcodes(), ElementsAre(5));
  EXPECT_EQ(viewer.binaries[0].payload.back(), 'a');
  protocol_.set_state({PlaybackState::Status::ended, 3'500'000, 1});
  run();
  viewer.read();
  EXPECT_THAT(viewer.opcodes(), ElementsAre(5, 5));
}

TEST_F(FoxgloveProtocolTest, AServerForOtherMachinesDemandsItsTokenInTheAddress) {
  EXPECT_TRUE(protocol_.admits(""));
  protocol_.require_token([](std::string_view token) { return token == "secret"; });
  EXPECT_FALSE(protocol_.admits(""));
  EXPECT_FALSE(protocol_.admits("t=wrong"));
  EXPECT_TRUE(protocol_.admits("t=secret"));
  EXPECT_TRUE(protocol_.admits("a=b&t=secret"));
}

TEST_F(FoxgloveProtocolTest, AClientThatLeavesEndsItsSubscriptions) {
  introduce();
  Viewer viewer(protocol_, 1);
  publish(0, "a.clock", shoal::utime_t{});
  viewer.subscribe(1, "/a/clock");
  EXPECT_EQ(protocol_.clients(), 1);
  viewer.leave();
  EXPECT_EQ(protocol_.clients(), 0);
  protocol_.message(1, "a.clock", shoal::encode(shoal::utime_t{}));
  protocol_.flush();
  EXPECT_THAT(posted_, IsEmpty());
}

}  // namespace
