// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <thread>

#include "shoal/client.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/sim_vehicle_t.hpp"
#include "tests/bridges/lockstep/fake_simulator.hpp"

// Clients that add a vehicle to a run, and leave it.

namespace {

using lcm_test::FakeSimulator;
using lcm_test::own_url;
using namespace std::chrono_literals;

shoal::sim_vehicle_t report_for(const std::string& client) {
  shoal::sim_vehicle_t report{};
  report.vehicle = "auv1";
  report.present = 1;
  report.client = client;
  report.count = 2;
  report.device = {"helm", "depth"};
  report.device_type = {"helm", "pressure"};
  report.report_channel = {"", "auv1.depth"};
  report.report_type = {"", "shoal.pressure_t"};
  report.rate_hz = {0, 5};
  report.command_channel = {"auv1.cmd", ""};
  report.command_types = {"shoal.helm_command_t", ""};
  return report;
}

/// The next request that is not the join, sent again.
shoal::sim_control_request_t await_other_than_join(FakeSimulator& simulator) {
  auto request = simulator.await_request();
  while (request.command == "join") request = simulator.await_request();
  return request;
}

void grant_spawn(FakeSimulator& simulator, const shoal::sim_control_request_t& request) {
  simulator.send("sim.vehicle", report_for(request.client));
  simulator.reply(request, true, "auv1: helm (takes shoal.helm_command_t on auv1.cmd)");
}

TEST(ClientSpawn, GivesTheChannelsWhileTheWorldWaits) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    const auto request = await_other_than_join(simulator);
    EXPECT_EQ(request.command, "spawn");
    EXPECT_EQ(request.text, "{name: auv1, file: auv.yaml}");
    simulator.send("sim.vehicle", report_for("another client"));
    grant_spawn(simulator, request);
    EXPECT_EQ(simulator.await_ack().sequence, 1);
    simulator.tick(2, {"pilot"}, true);
  });
  client.join(0.1, 60s);
  ASSERT_TRUE(client.next_tick());
  const auto channels = client.spawn("{name: auv1, file: auv.yaml}", 60s);
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels.at("helm").commands, "auv1.cmd");
  EXPECT_EQ(channels.at("helm").command_types, "shoal.helm_command_t");
  EXPECT_EQ(channels.at("depth").type, "pressure");
  EXPECT_EQ(channels.at("depth").reports, "auv1.depth");
  EXPECT_EQ(channels.at("depth").report_type, "shoal.pressure_t");
  EXPECT_EQ(channels.at("depth").rate_hz, 5);
  EXPECT_FALSE(client.next_tick());
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
  thread.join();
}

TEST(ClientSpawn, BeforeTheFirstTickWaitsForIt) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    grant_spawn(simulator, await_other_than_join(simulator));
    EXPECT_EQ(simulator.await_ack().sequence, 1);
    simulator.tick(2, {"pilot"}, true);
  });
  client.join(0.1, 60s);
  EXPECT_EQ(client.spawn("{name: auv1}", 60s).size(), 2u);
  EXPECT_EQ(client.next_tick(), 1010);
  EXPECT_FALSE(client.next_tick());
  thread.join();
}

TEST(ClientSpawn, AsksAgainWhenReplyOrReportIsLost) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    const auto first = await_other_than_join(simulator);  // its reply is lost
    const auto second = await_other_than_join(simulator);
    EXPECT_EQ(second.id, first.id);
    EXPECT_EQ(second.text, first.text);
    simulator.reply(second, true, "auv1: helm");  // its report is lost
    while (simulator.await_ack().sequence != 1) {
    }
    simulator.tick(2, {"pilot"}, true);
  });
  client.join(0.1, 60s);
  ASSERT_TRUE(client.next_tick());
  EXPECT_THROW(client.spawn("{name: auv1}", 1s), shoal::ClientError) << "no report comes";
  EXPECT_FALSE(client.next_tick());
  thread.join();
}

TEST(ClientSpawn, SaysWhyItIsRefused) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  EXPECT_THROW(client.spawn("{name: auv1}"), std::logic_error) << "join() comes first";
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    simulator.reply(await_other_than_join(simulator), false, "spawn:1:2: unknown key 'nme'");
    EXPECT_EQ(simulator.await_ack().sequence, 1);
    simulator.tick(2, {"pilot"}, true);
  });
  client.join(0.1, 60s);
  ASSERT_TRUE(client.next_tick());
  try {
    client.spawn("{nme: auv1}", 60s);
    ADD_FAILURE();
  } catch (const shoal::ClientError& error) {
    EXPECT_STREQ(error.what(), "the simulator rejects 'pilot': spawn:1:2: unknown key 'nme'");
  }
  EXPECT_FALSE(client.next_tick());
  thread.join();
}

TEST(ClientSpawn, EndsWithTheRun) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    await_other_than_join(simulator);
    simulator.tick(2, {"pilot"}, true);
    while (simulator.await_ack().sequence != 2) {
    }
  });
  client.join(0.1, 60s);
  ASSERT_TRUE(client.next_tick());
  try {
    client.spawn("{name: auv1}", 60s);
    ADD_FAILURE();
  } catch (const shoal::ClientError& error) {
    EXPECT_STREQ(error.what(), "the run of 'pilot' was over before its 'spawn' was answered");
  }
  EXPECT_FALSE(client.next_tick());
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
  thread.join();
}

TEST(ClientSpawn, LeavesAtTheTickAfterItsLastAnswer) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    const auto ack = simulator.await_ack();
    EXPECT_EQ(ack.sequence, 1);
    EXPECT_EQ(ack.count, 1) << "what it published for its last tick is listed";
    simulator.tick(2, {"pilot"});
    const auto request = await_other_than_join(simulator);
    EXPECT_EQ(request.command, "leave");
    EXPECT_THAT(request.text, testing::HasSubstr("acknowledged: 1"));
    simulator.reply(request, true, "");
  });
  client.join(0.1, 60s);
  ASSERT_TRUE(client.next_tick());
  client.publish("auv1.cmd", shoal::helm_command_t{});
  client.leave(60s);
  EXPECT_EQ(client.end(), shoal::Client::End::left);
  EXPECT_FALSE(client.next_tick());
  client.leave();  // nothing is left to leave
  thread.join();
}

TEST(ClientSpawn, AnswersTheLastTickInsteadOfLeaving) {
  FakeSimulator simulator;
  shoal::Client client("pilot", own_url(1));
  std::thread thread([&] {
    simulator.reply(simulator.await_request(), true, "");
    simulator.tick(1, {"pilot"});
    EXPECT_EQ(simulator.await_ack().sequence, 1);
    simulator.tick(2, {"pilot"}, true);
    const auto ack = simulator.await_ack();
    EXPECT_EQ(ack.sequence, 2);
    EXPECT_EQ(ack.count, 0);
  });
  client.join(0.1, 60s);
  ASSERT_TRUE(client.next_tick());
  client.publish("auv1.cmd", shoal::helm_command_t{});
  client.leave(60s);
  EXPECT_EQ(client.end(), shoal::Client::End::last_tick);
  thread.join();
}

}  // namespace
