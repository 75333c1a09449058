#include "bridges/lcm/other_simulators.hpp"

#include <gmock/gmock.h>

#include "shoal/sim_tick_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/lcm/service_fixture.hpp"

namespace {

using bridges::OtherSimulators;
using std::chrono::milliseconds;
using testing::Optional;

constexpr const char* world =
    "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nvehicles: [{name: a, model: {shoal: 1, bodies: [{name: b, "
    "parts: [{shape: box, mass_kg: 1}]}]}}]\n";

TEST(OtherSimulators, NobodyIsThere) {
  test::TestWorld quiet(world);
  OtherSimulators others({{"here", &quiet.bus}}, false);
  EXPECT_EQ(others.look([](milliseconds) {}), std::nullopt);
}

TEST(OtherSimulators, NobodyIsAskedWithoutABusAndNothingIsWaitedFor) {
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

TEST(OtherSimulators, OneThatAnswersNothingIsHeard) {
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

TEST(OtherSimulators, OfTwoThatStartAtTheSameTimeOneStays) {
  test::TestWorld both(world);
  for (int i = 0; i < 20; ++i) {
    OtherSimulators a({{"here", &both.bus}}, false);
    OtherSimulators b({{"here", &both.bus}}, false);  // its question came after a's, which b did not hear
    std::optional<std::string> found_b;
    bool looked_b = false;
    const auto found_a = a.look([&](milliseconds) {
      if (!looked_b) found_b = b.look([](milliseconds) {});
      looked_b = true;
    });
    EXPECT_NE(found_a.has_value(), found_b.has_value());
  }
}

TEST(OtherSimulators, OneThatSharesDoesNotLookAndSaysSo) {
  lcm_test::ServedWorld first(world);
  OtherSimulators own({}, false);
  first.service.use_others(own);
  OtherSimulators others({{"here", &first.test.bus}}, true);
  testing::internal::CaptureStderr();
  first.service.handle_requests();
  EXPECT_EQ(others.look([](milliseconds) { ADD_FAILURE(); }), std::nullopt);
  testing::internal::GetCapturedStderr();
  shoal::sim_control_request_t request{};
  request.id = -1;
  request.client = "shoal-run";
  request.command = "alive";
  EXPECT_EQ(own.who_asks(request), OtherSimulators::Asker::another_run);
  request.text = "{shared: true}";
  EXPECT_EQ(own.who_asks(request), OtherSimulators::Asker::another_run_that_shares);
  request.client = "pilot";
  EXPECT_EQ(own.who_asks(request), OtherSimulators::Asker::nobody);
}

}  // namespace
