// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/control/other_simulators.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <future>

#include "bridges/bus/lcm_bus.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_tick_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/control/service_fixture.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using bridges::OtherSimulators;
using std::chrono::milliseconds;
using testing::Optional;

constexpr const char* world =
    "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nvehicles: [{name: a, model: {shoal: 1, bodies: [{name: b, "
    "parts: [{shape: box, mass_kg: 1}]}]}}]\n";

TEST(OtherSimulators, NoOneIsThere) {
  test::TestWorld quiet(world);
  OtherSimulators others({{"here", &quiet.bus}}, false);
  EXPECT_EQ(others.look([](milliseconds) {}), std::nullopt);
}

TEST(OtherSimulators, NoOneIsAskedWithoutABusAndNothingIsWaitedFor) {
  OtherSimulators others({}, false);
  EXPECT_EQ(others.look([](milliseconds) { ADD_FAILURE(); }), std::nullopt);
}

TEST(OtherSimulators, OneThatIsPausedAndPublishesNothingAnswers) {
  lcm_test::ServedWorld first(world);
  first.control.paused = true;
  OtherSimulators others({{"here", &first.test.bus}}, false);
  EXPECT_THAT(others.look([&](milliseconds) { first.service.handle_requests(); }),
              Optional(std::string("another simulator answers on here")));
}

TEST(OtherSimulators, OneThatAnswersNothingIsReceived) {
  test::TestWorld first(world);
  OtherSimulators others({{"here", &first.bus}}, false);
  EXPECT_THAT(others.look([&](milliseconds) { first.send("sim.tick", shoal::sim_tick_t{}); }),
              Optional(std::string("another simulator, or a player of a log, publishes sim.tick on here")));
  OtherSimulators again({{"here", &first.bus}}, false);
  EXPECT_THAT(again.look([&](milliseconds) { first.send("sim.clock", shoal::utime_t{}); }),
              Optional(std::string("another simulator, or a player of a log, publishes sim.clock on here")));
}

TEST(OtherSimulators, AreFoundOnAnyBus) {
  test::TestWorld quiet(world);
  lcm_test::ServedWorld first(world);
  OtherSimulators others({{"here", &quiet.bus}, {"there", &first.test.bus}}, false);
  EXPECT_THAT(others.look([&](milliseconds) { first.service.handle_requests(); }),
              Optional(std::string("another simulator answers on there")));
}

/// A run that starts, and one that continues when no one else is there.
class StartingRun {
 public:
  /// Looks, and answers others then until `both` have looked.
  std::optional<std::string> look(std::atomic<int>& looked, int both) {
    const auto found = others_.look([this](milliseconds time) { bus_.wait_for_message(time); });
    ++looked;
    while (!found && looked < both) {
      while (const auto message = requests_->take()) {
        const auto request = shoal::decode<shoal::sim_control_request_t>(message->payload, shoal::Finite::any);
        if (others_.requester_of(request) != OtherSimulators::Requester::another_run) continue;
        shoal::sim_control_reply_t reply{};
        reply.id = request.id;
        reply.client = request.client;
        bus_.publish("sim.control.reply", shoal::encode(reply), sim::Time(0));
        bus_.end_of_step();
      }
      bus_.wait_for_message(milliseconds(5));
    }
    return found;
  }

 private:
  bridges::LcmBus bus_{lcm_test::own_url(1)};
  std::unique_ptr<sim::Mailbox> requests_ = bus_.open_mailbox("sim.control");
  OtherSimulators others_{{{"here", &bus_}}, false};
};

TEST(OtherSimulators, OfTwoThatStartAtTheSameTimeOneStays) {
  for (int i = 0; i < 10; ++i) {
    StartingRun a, b;
    std::atomic<int> looked = 0;
    auto found_a = std::async(std::launch::async, [&] { return a.look(looked, 2); });
    const auto found_b = b.look(looked, 2);
    EXPECT_NE(found_a.get().has_value(), found_b.has_value());
  }
}

TEST(OtherSimulators, OneThatAskedAndStartsAllTheSameIsWarnedOf) {
  test::TestWorld test(world);
  bridges::LcmBus bus(lcm_test::own_url(2)), others_bus(lcm_test::own_url(2));
  sim::MessageGate gate(bus);
  sim::RunControl control;
  bridges::LockstepService lockstep(test.world, control, {{bus, gate}});
  OtherSimulators own({}, false);
  bridges::SimService service(bus, bus, test.world, control, lockstep, {"{}", "test"}, {.others = &own});
  OtherSimulators second({{"here", &others_bus}}, false);
  // It is answered, but does not wait for it.
  EXPECT_TRUE(second.look([&](milliseconds time) {
    service.handle_requests();
    others_bus.wait_for_message(time);
  }));
  testing::internal::CaptureStdout();
  service.publish_info();  // its own
  bus.end_of_step();
  EXPECT_TRUE(bus.flush(std::chrono::seconds(60)));
  service.handle_requests();
  others_bus.publish("sim.info", shoal::encode(shoal::sim_info_t{}), sim::Time(0));
  others_bus.end_of_step();
  std::string reported;
  EXPECT_TRUE(lcm_test::await([&] {
    service.handle_requests();
    reported += testing::internal::GetCapturedStdout();
    testing::internal::CaptureStdout();
    return !reported.empty();
  }));
  testing::internal::GetCapturedStdout();
  EXPECT_THAT(reported, testing::HasSubstr("another simulator publishes on the world's bus of this run"));
}

TEST(OtherSimulators, OneThatWasTooBusyToAnswerIsWarnedOfWhenItPublishes) {
  test::TestWorld test(world);
  bridges::LcmBus bus(lcm_test::own_url(3)), others_bus(lcm_test::own_url(3));
  sim::MessageGate gate(bus);
  sim::RunControl control;
  bridges::LockstepService lockstep(test.world, control, {{bus, gate}});
  OtherSimulators own({{"here", &bus}}, false);
  bridges::SimService service(bus, bus, test.world, control, lockstep, {"{}", "test"}, {.others = &own});
  EXPECT_FALSE(own.look([&](milliseconds time) { bus.wait_for_message(time); }));  // the other one is silent
  testing::internal::CaptureStdout();
  others_bus.publish("sim.info", shoal::encode(shoal::sim_info_t{}), sim::Time(0));
  others_bus.end_of_step();
  std::string reported;
  EXPECT_TRUE(lcm_test::await([&] {
    service.handle_requests();
    reported += testing::internal::GetCapturedStdout();
    testing::internal::CaptureStdout();
    return !reported.empty();
  }));
  testing::internal::GetCapturedStdout();
  EXPECT_THAT(reported, testing::HasSubstr("another simulator publishes on the world's bus of this run"));
}

TEST(OtherSimulators, OneThatSharesDoesNotLookAndSaysSo) {
  lcm_test::ServedWorld first(world);
  OtherSimulators own({}, false);
  bridges::SimService service(first.test.bus, first.test.bus, first.test.world, first.control, first.lockstep,
                              {"{}", "test"}, {.others = &own});
  OtherSimulators others({{"here", &first.test.bus}}, true);
  testing::internal::CaptureStderr();
  service.handle_requests();
  EXPECT_EQ(others.look([](milliseconds) { ADD_FAILURE(); }), std::nullopt);
  testing::internal::GetCapturedStderr();
  shoal::sim_control_request_t request{};
  request.id = -1;
  request.client = "shoal-run";
  request.command = "alive";
  EXPECT_EQ(own.requester_of(request), OtherSimulators::Requester::another_run);
  request.text = "{shared: true}";
  EXPECT_EQ(own.requester_of(request), OtherSimulators::Requester::another_run_that_shares);
  request.client = "pilot";
  EXPECT_EQ(own.requester_of(request), OtherSimulators::Requester::none_of_ours);
}

}  // namespace
