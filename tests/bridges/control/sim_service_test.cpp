// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/sim_state_t.hpp"
#include "tests/bridges/control/service_fixture.hpp"

namespace {

/// A world with one box.
struct Service : lcm_test::ServedWorld {
  Service()
      : ServedWorld(
            "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nvehicles: [{name: a, model: {shoal: 1, bodies: "
            "[{name: "
            "b, parts: [{shape: box, mass_kg: 1}]}]}}]\n") {}

  using ServedWorld::request_reply;
  shoal::sim_control_reply_t request_reply(const std::string& command, double value) {
    return ServedWorld::request_reply(command, value, "");
  }
};

TEST(SimService, AnswersEachRequestWithItsNumber) {
  Service s;
  EXPECT_EQ(s.request_reply("alive", 0).id, 1);
  const auto reply = s.request_reply("quit", 0);
  EXPECT_EQ(reply.id, 2);
  EXPECT_EQ(reply.client, "pilot");
  EXPECT_TRUE(reply.ok);
  EXPECT_TRUE(s.control.quit);
}

TEST(SimService, LeavesWhatIsAboutTimeToTheTimeMachine) {
  struct Machine final : bridges::TimeMachine {
    std::optional<std::string> execute(const std::string& command, const std::string&, double value) override {
      if (command != "speed") return std::nullopt;
      if (value < 0) throw std::runtime_error("'speed' must be 0 or more");
      return "as fast as possible";
    }
  } machine;
  Service s;
  EXPECT_FALSE(s.request_reply("speed", 0).ok) << "nobody serves it";
  s.machine = &machine;
  EXPECT_EQ(s.request_reply("speed", 0).text, "as fast as possible");
  EXPECT_THAT(s.request_reply("speed", -1).text, testing::HasSubstr("'speed' must be 0"));
  EXPECT_TRUE(s.request_reply("alive", 0).ok) << "not the machine's";
}

TEST(SimService, SaysWhyItRefuses) {
  Service s;
  EXPECT_THAT(s.request_reply("fly", 0).text,
              testing::HasSubstr("unknown command 'fly'; known commands: alive, bus, describe, do"));
  EXPECT_THAT(s.request_reply("join", 0.015).text, testing::HasSubstr("a multiple of the step"));
  EXPECT_THAT(s.request_reply("leave", 0).text, testing::HasSubstr("no client named 'pilot'"));
  EXPECT_EQ(s.service.bad_messages(), 3);
}

TEST(SimService, ItsOwnQuestionForOtherSimulatorsIsNoRequest) {
  Service s;
  bridges::OtherSimulators others({{"here", &s.test.bus}}, false);
  bridges::SimService service(s.test.bus, s.test.bus, s.test.world, s.control, s.lockstep, {"{}", "test"},
                              {.others = &others});
  s.answering = &service;
  service.handle_requests();
  EXPECT_TRUE(s.replies.take_all().empty());
  EXPECT_TRUE(s.request_reply("alive", 0, "", "shoal-run").ok) << "another run's is answered";
}

TEST(SimService, PublishesTheStateAtItsRate) {
  Service s;
  test::Listener<shoal::sim_state_t> states(s.test, "sim.state");
  s.service.publish_step();
  for (int i = 0; i < 100; ++i) {
    s.test.world.step();
    s.service.publish_step();
  }
  const auto all = states.take_all();
  ASSERT_EQ(all.size(), 11u);  // 10 Hz for 1 s, and the start
  EXPECT_EQ(all.back().step, 100);
  EXPECT_EQ(all.back().vehicle, std::vector<std::string>{"a"});
  EXPECT_EQ(all.back().orientation[0], (std::vector<double>{1, 0, 0, 0}));
}

}  // namespace
