// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/sim_services.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "shoal/message_schema.hpp"

namespace {

using namespace bridges::ros2;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Services, with what they ask the simulator and respond.
class SimServicesTest : public testing::Test {
 protected:
  struct Asked {
    std::string command;
    double value;
    std::string text;
  };

  explicit SimServicesTest(bool controls = true)
      : services_({[this](const std::string& command, double value, const std::string& text) {
                     asked_.push_back({command, value, text});
                     return static_cast<std::int32_t>(asked_.size());
                   },
                   [this](std::size_t, std::span<const std::byte> cdr) {
                     response_.assign(cdr.begin(), cdr.end());
                     ++responses_;
                   }},
                  controls) {
    shoal::sim_state_t state{};
    state.utime = 1'500'000;
    state.count = 1;
    state.vehicle = {"rover1"};
    state.position_m = {{1, 2, 3}};
    state.orientation = {{1, 0, 0, 0}};
    state.velocity_mps = {{0.5, 0, 0}};
    state.angular_velocity_radps = {{0, 0, 0.25}};
    services_.know(state);
  }

  /// Calls a service as client 11, call 22.
  template <class Write>
  void call(std::string_view name, const Write& write) {
    std::vector<std::byte> request;
    CdrWriter out(request);
    out.put(std::uint64_t{11});
    out.put(std::int64_t{22});
    write(out);
    call_bytes(name, request);
  }
  void call(std::string_view name) {
    call(name, [](CdrWriter& out) { out.put(std::uint8_t{0}); });
  }
  void call_bytes(std::string_view name, std::span<const std::byte> request) {
    for (std::size_t i = 0; i < SimServices::services().size(); ++i)
      if (SimServices::services()[i].name == "shoal/" + std::string(name)) return services_.call(i, request, now_);
    FAIL() << "no service " << name;
  }
  /// Answers the last request.
  void answer(const std::string& text, bool ok = true) {
    shoal::sim_control_reply_t reply{};
    reply.id = static_cast<std::int32_t>(asked_.size());
    reply.ok = ok ? 1 : 0;
    reply.text = text;
    services_.take_reply(reply, now_);
  }
  /// The response, behind client and call, which must be those of the request.
  CdrReader response() {
    EXPECT_EQ(responses_, 1);
    responses_ = 0;
    CdrReader in(response_);
    EXPECT_EQ(in.get<std::uint64_t>(), 11u);
    EXPECT_EQ(in.get<std::int64_t>(), 22);
    return in;
  }
  void expect_result(std::uint8_t code, const std::string& error = "") {
    CdrReader in = response();
    EXPECT_EQ(in.get<std::uint8_t>(), code);
    EXPECT_THAT(in.text(), HasSubstr(error));
  }

  std::vector<Asked> asked_;
  std::vector<std::byte> response_;
  int responses_ = 0;
  SimServices::Clock::time_point now_{};
  SimServices services_;
};

void put_pose(CdrWriter& out, std::string_view frame) {
  out.put(std::int32_t{0});
  out.put(std::uint32_t{0});
  out.put(frame);
  // Yaw of 90 degrees: x, y, z, w of the quaternion.
  for (const double value : {4.0, 5.0, 6.0, 0.0, 0.0, 0.70710678118654757, 0.70710678118654757}) out.put(value);
}

TEST_F(SimServicesTest, TheStateOfTheSimulationIsThatOfTheRun) {
  for (const bool paused : {false, true}) {
    call("get_simulation_state");
    EXPECT_EQ(asked_.back().command, "where");
    answer(paused ? "step 100, 1 s, branch 0, paused" : "step 100, 1 s, branch 0");
    CdrReader in = response();
    EXPECT_EQ(in.get<std::uint8_t>(), paused ? 2 : 1);
    EXPECT_EQ(in.get<std::uint8_t>(), SimServices::ok);
  }
}

TEST_F(SimServicesTest, ARunIsPausedOnceAndResumed) {
  const auto set = [&](std::uint8_t state) {
    call("set_simulation_state", [state](CdrWriter& out) { out.put(state); });
  };
  set(2);
  answer("step 1, 0.01 s, branch 0");
  EXPECT_EQ(asked_.back().command, "pause");
  answer("");
  expect_result(SimServices::ok);
  set(2);
  answer("step 1, 0.01 s, branch 0, paused");
  expect_result(SimServices::already_there, "in this state already");
  set(1);
  answer("step 1, 0.01 s, branch 0, paused");
  EXPECT_EQ(asked_.back().command, "resume");
  answer("the run cannot continue", false);
  expect_result(SimServices::failed, "the run cannot continue");
  set(9);
  expect_result(SimServices::incorrect_transition);
}

TEST_F(SimServicesTest, AStepIsAnsweredWhenItHasBeenMade) {
  const auto step = [&] { call("step_simulation", [](CdrWriter& out) { out.put(std::uint64_t{5}); }); };
  step();
  answer("step 100, 1 s, branch 0");
  expect_result(SimServices::incorrect_state, "must be paused");
  step();
  answer("step 100, 1 s, branch 0, paused");
  EXPECT_EQ(asked_.back().command, "step");
  EXPECT_EQ(asked_.back().value, 5);
  answer("takes 5 steps");
  answer("step 104, 1.04 s, branch 0, paused");
  EXPECT_EQ(responses_, 0);
  answer("step 105, 1.05 s, branch 0, paused");
  expect_result(SimServices::ok);
}

TEST_F(SimServicesTest, AResetRewindsTheWholeRun) {
  const auto reset = [&](std::uint8_t scope) { call("reset_simulation", [scope](CdrWriter& out) { out.put(scope); }); };
  reset(0);
  answer("step 100, 1 s, branch 0");
  EXPECT_EQ(asked_.back().command, "rewind");
  EXPECT_EQ(asked_.back().text, "run");
  answer("step 0, 0 s, branch 1");
  expect_result(SimServices::ok);
  reset(1);
  expect_result(SimServices::unsupported);
}

TEST_F(SimServicesTest, EntitiesAreTheVehiclesWithTheirTrueStates) {
  call("get_entities", [](CdrWriter& out) {
    for (int i = 0; i < 3; ++i) out.put(std::uint32_t{0});  // no filter, categories and tags
    out.put(std::uint16_t{0});
    out.put_count(0);
  });
  CdrReader entities = response();
  EXPECT_EQ(entities.get<std::uint8_t>(), SimServices::ok);
  EXPECT_EQ(entities.text(), "");
  EXPECT_EQ(entities.count(1), 1u);
  EXPECT_EQ(entities.text(), "rover1");

  call("get_entity_state", [](CdrWriter& out) { out.put(std::string_view("rover1")); });
  CdrReader state = response();
  EXPECT_EQ(state.get<std::uint8_t>(), SimServices::ok);
  state.text();
  EXPECT_THAT((state.array<std::uint32_t, 2>()), ElementsAre(1, 500'000'000));
  EXPECT_EQ(state.text(), "world");
  EXPECT_THAT((state.array<double, 7>()), ElementsAre(1, 2, 3, 0, 0, 0, 1));
  EXPECT_THAT((state.array<double, 6>()), ElementsAre(0.5, 0, 0, 0, 0, 0.25));

  call("get_entity_state", [](CdrWriter& out) { out.put(std::string_view("x")); });
  expect_result(SimServices::not_found, "there is no vehicle 'x'");
}

TEST_F(SimServicesTest, FiltersAreRefusedAndNotIgnored) {
  call("get_entities", [](CdrWriter& out) {
    out.put(std::string_view("(a*)*b"));
    for (int i = 0; i < 5; ++i) out.put(std::uint32_t{0});
  });
  expect_result(SimServices::unsupported, "filters");
}

TEST_F(SimServicesTest, AVehicleIsSpawnedMovedAndRemovedByRequestsOfShoal) {
  call("spawn_entity", [](CdrWriter& out) {
    out.put(std::string_view("rover1"));
    out.put(true);
    for (const char* text : {"pioneer.yaml", "", ""}) out.put(std::string_view(text));
    put_pose(out, "world");
  });
  EXPECT_EQ(asked_.back().command, "spawn");
  const std::string& text = asked_.back().text;
  EXPECT_THAT(text, StartsWith(R"({"file":"pioneer.yaml","name":"rover1_2","position_m":[4.0,5.0,6.0],"rpy_deg":[)"));
  EXPECT_NEAR(std::stod(text.substr(text.rfind(',') + 1)), 90, 1e-9);
  answer("");
  CdrReader spawned = response();
  EXPECT_EQ(spawned.get<std::uint8_t>(), SimServices::ok);
  spawned.text();
  EXPECT_EQ(spawned.text(), "rover1_2");

  call("set_entity_state", [](CdrWriter& out) {
    out.put(std::string_view("rover1"));
    put_pose(out, "");
    for (int i = 0; i < 12; ++i) out.put(0.0);
    for (const bool sets : {true, false, false}) out.put(sets);
  });
  EXPECT_EQ(asked_.back().command, "do");
  EXPECT_THAT(asked_.back().text, HasSubstr(R"({"move":{"name":"rover1","position_m":[4.0,5.0,6.0])"));
  answer("");
  expect_result(SimServices::ok);

  call("delete_entity", [](CdrWriter& out) { out.put(std::string_view("rover1")); });
  EXPECT_EQ(asked_.back().command, "remove");
  EXPECT_EQ(asked_.back().text, "rover1");
  answer("");
  expect_result(SimServices::ok);
}

TEST_F(SimServicesTest, APoseInAnotherFrameIsRefused) {
  call("spawn_entity", [](CdrWriter& out) {
    out.put(std::string_view("new"));
    out.put(false);
    for (const char* text : {"pioneer.yaml", "", ""}) out.put(std::string_view(text));
    put_pose(out, "rover1");
  });
  expect_result(SimServices::bad_pose, "'world'");
  EXPECT_TRUE(asked_.empty());
}

TEST_F(SimServicesTest, ACallWithoutAnAnswerFailsAndTooManyAreRefused) {
  call("get_simulation_state");
  services_.expire(now_ + SimServices::patience - std::chrono::milliseconds(1));
  EXPECT_EQ(responses_, 0);
  services_.expire(now_ + SimServices::patience);
  CdrReader in = response();
  in.get<std::uint8_t>();
  EXPECT_EQ(in.get<std::uint8_t>(), SimServices::failed);
  EXPECT_EQ(in.text(), "the simulator does not answer");
  answer("step 1, 0 s, branch 0");  // too late
  EXPECT_EQ(responses_, 0);
  for (std::size_t i = 0; i < SimServices::max_calls; ++i) call("get_simulation_state");
  EXPECT_EQ(responses_, 0);
  call("get_simulation_state");
  EXPECT_EQ(responses_, 1);
}

TEST_F(SimServicesTest, RequestsThatEndTooEarlyAreErrors) {
  const std::vector<std::byte> header{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  for (const SimServices::Service& service : SimServices::services())
    EXPECT_THROW(call_bytes(std::string_view(service.name).substr(6), header), shoal::MessageError);
}

class ReadOnlySimServicesTest : public SimServicesTest {
 protected:
  ReadOnlySimServicesTest() : SimServicesTest(false) {}
};

TEST_F(ReadOnlySimServicesTest, WithoutPermissionNothingIsAsked) {
  for (const SimServices::Service& service : SimServices::services()) {
    if (!service.changes) continue;
    call(std::string_view(service.name).substr(6));
    expect_result(SimServices::failed, "--control");
  }
  EXPECT_TRUE(asked_.empty());
  call("get_simulator_features");
  CdrReader in = response();
  EXPECT_EQ(in.count(2), 2u);
}

}  // namespace
