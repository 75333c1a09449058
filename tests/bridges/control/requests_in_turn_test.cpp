// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "shoal/sim_vehicle_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/bridges/lockstep/lockstep_fixture.hpp"

// Requests of lockstep clients that change the world: their order does not depend on the network.

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A ball beside the box of the world; `x_m` as text.
std::string ball(const std::string& name, const std::string& x_m) {
  return "{name: " + name + ", with_client: true, position_m: [" + x_m +
         ", 0, 0], model: {shoal: 1, bodies: [{name: b, parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}]}}";
}

/// Two clients, `one` and `two`, that are due at every step.
struct Crew : lcm_test::LockstepWorld {
  explicit Crew(const std::string& terms_of_one = "session: 5, timeout_s: 60") {
    EXPECT_TRUE(join("one", "{" + terms_of_one + "}").ok);
    EXPECT_TRUE(join("two", "{session: 6, timeout_s: 60}").ok);
  }
  void spawn(const std::string& client) {
    send_request("spawn", 0, client, client == "one" ? ball("ball_of_one", "5") : ball("ball_of_two", "9"));
  }
  void answer(const std::string& client, std::int64_t sequence = 1) {
    acknowledge(test.world.step_number(), client, client == "one" ? 5 : 6, sequence);
  }
  /// The clients that got a reply, in its order.
  std::vector<std::string> replied() {
    std::vector<std::string> clients;
    for (const auto& reply : replies.take_all()) clients.push_back(reply.client + (reply.ok ? " granted" : " refused"));
    return clients;
  }
  std::vector<std::string> vehicles() const {
    std::vector<std::string> names;
    for (const auto& vehicle : test.world.vehicles()) names.emplace_back(vehicle->name());
    return names;
  }
};

/// The state after both clients have spawned a ball in one step and waited for the reply; `first` asks first.
std::uint64_t state_after_spawns(const std::string& first, const std::string& second) {
  Crew crew;
  int waited = 0;
  crew.synchronize([&] {
    switch (waited++) {
      case 0:
        return crew.spawn(first);
      case 1:
        EXPECT_THAT(crew.replied(), IsEmpty()) << "the other may have a request too";
        return crew.spawn(second);
      case 2:
        EXPECT_THAT(crew.replied(), ElementsAre("one granted", "two granted"));
        crew.answer(second);
        return crew.answer(first);
      default:
        break;
    }
  });
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one", "ball_of_two"));
  crew.test.run_for(0.1);
  return crew.test.world.state().hash();
}

TEST(RequestsInTurn, OfTwoClientsInOneStepGiveOneStateInAnyOrderOfArrival) {
  EXPECT_EQ(state_after_spawns("one", "two"), state_after_spawns("two", "one"));
}

TEST(RequestsInTurn, ThatAreSentWithoutWaitingForTheReplyAreInOrderToo) {
  Crew crew;
  bool are_sent = false;
  crew.synchronize([&] {
    if (std::exchange(are_sent, true)) return;
    for (const char* client : {"two", "one"}) {
      crew.spawn(client);
      crew.answer(client);
    }
  });
  crew.service.handle_requests();  // as a run does before its next step
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one", "ball_of_two"));
}

TEST(RequestsInTurn, DoNotMakeAClientLateThatWaitsForItsReply) {
  Crew crew("session: 5, on_timeout: end, timeout_s: 0.001");
  const auto begin = std::chrono::steady_clock::now();
  bool is_sent = false, is_answered = false;
  crew.synchronize([&] {
    if (!std::exchange(is_sent, true)) return crew.spawn("one");
    if (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(20)) return;
    if (std::exchange(is_answered, true)) return crew.answer("one");
    EXPECT_THAT(crew.service.waits_for(), testing::MatchesRegex("waits [0-9.]+ s for 'two'"));
    crew.answer("two");
  });
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one"));
  EXPECT_EQ(crew.lockstep.summaries().at(0).timeouts, 0);
}

TEST(RequestsInTurn, GetTheSameReplyWhenTheyAreSentAgain) {
  Crew crew;
  test::Listener<shoal::sim_vehicle_t> reports(crew.test, "sim.vehicle");
  shoal::sim_control_request_t request{};
  request.id = 7;
  request.client = "one";
  request.command = "spawn";
  request.text = ball("ball_of_one", "5");
  std::vector<shoal::sim_control_reply_t> replies;
  int waited = 0;
  crew.synchronize([&] {
    for (const auto& reply : crew.replies.take_all()) replies.push_back(reply);
    switch (waited++) {
      case 0:
        crew.test.send("sim.control", request);
        return crew.answer("two");
      case 1:
        return crew.test.send("sim.control", request);  // the reply was lost
      case 2:
        return crew.answer("one");
      default:
        break;
    }
  });
  ASSERT_EQ(replies.size(), 2u);
  EXPECT_TRUE(replies[0].ok && replies[1].ok) << replies[1].text;
  EXPECT_EQ(replies[0].text, replies[1].text);
  EXPECT_EQ(reports.take_all().size(), 2u) << "the report was lost as well";
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one"));
}

TEST(RequestsInTurn, ToLeaveInPlaceOfAnAnswerRemoveTheVehiclesInOrder) {
  Crew crew;
  int waited = 0;
  crew.synchronize([&] {
    switch (waited++) {
      case 0:
        crew.spawn("one");
        return crew.spawn("two");
      case 1:
        crew.replied();
        return crew.send_request("leave", 0, "two", "{session: 6, acknowledged: 0}");
      case 2:
        EXPECT_TRUE(crew.lockstep.has("two"));
        EXPECT_TRUE(crew.lockstep.has_left("two")) << "it leaves at its turn";
        return crew.answer("one");
      default:
        break;
    }
  });
  EXPECT_FALSE(crew.lockstep.has("two"));
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one"));
}

TEST(RequestsInTurn, DoNotKeepAClientThatLeavesWithoutItsReply) {
  Crew crew;
  int waited = 0;
  crew.synchronize([&] {
    switch (waited++) {
      case 0:
        crew.spawn("one");
        return crew.answer("one");
      case 1:
        crew.send_request("leave", 0, "one", "{session: 5, acknowledged: 1}");
        return;
      case 2:
        EXPECT_FALSE(crew.lockstep.has("one")) << "it gave up the request";
        return crew.answer("two");
      default:
        break;
    }
  });
  EXPECT_THAT(crew.vehicles(), ElementsAre("a"));
}

TEST(RequestsInTurn, AVehicleOfAMemberStaysWhileTheWorldWaitsForAnother) {
  Crew crew;
  int waited = 0;
  crew.synchronize([&] {
    switch (waited++) {
      case 0:
        crew.send_request("spawn", 0, "one", "{alive_timeout_s: 0.1, " + ball("ball_of_one", "5").substr(1));
        return crew.answer("two");
      case 1:
        return crew.answer("one");
      default:
        break;
    }
  });
  ASSERT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one"));
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(150)) crew.service.handle_requests();
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one"));
}

TEST(RequestsInTurn, OfABranchThatWasLeftAreRefused) {
  Crew crew;
  int waited = 0;
  crew.synchronize([&] {
    switch (waited++) {
      case 0:
        return crew.spawn("one");
      case 1:
        return crew.lockstep.set_branch(1);
      case 2:
        EXPECT_THAT(crew.replied(), ElementsAre("one refused"));
        return crew.spawn("one");  // it was on its way
      case 3:
        EXPECT_THAT(crew.replied(), ElementsAre("one refused"));
        for (const char* client : {"one", "two"}) crew.answer(client);
        return;
      default:
        for (const char* client : {"one", "two"}) crew.answer(client, 2);
    }
  });
  EXPECT_THAT(crew.vehicles(), ElementsAre("a"));
}

TEST(RequestsInTurn, OfOtherProgramsAreAnsweredAtOnce) {
  Crew crew;
  int waited = 0;
  crew.synchronize([&] {
    switch (waited++) {
      case 0:
        crew.spawn("one");
        return crew.send_request("do", 0, "operator", "{move: {name: a, position_m: [0, 0, 3]}}");
      case 1:
        EXPECT_THAT(crew.replied(), ElementsAre("operator granted"));
        return crew.answer("two");
      default:
        crew.answer("one");
    }
  });
  EXPECT_THAT(crew.vehicles(), ElementsAre("a", "ball_of_one"));
}

}  // namespace
