// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sim/world/world_state.hpp"
#include "tests/sim/acoustics/sea_of_hydrophones.hpp"

// Paths and levels that threads compute before the events of a step are handled.

namespace {

/// 10 vehicles that move and send in turn, every 7 steps, to 150 vehicles 300 m away, so close together that the sound
/// reaches them within 7 ms: 75 of them at least in one step.  While sound is on its way to them one is removed, and
/// one changes its receiver.
struct ManyHearers {
  explicit ManyHearers(const std::string& acoustics, int threads) : test(text(acoustics)) {
    test.world.use_threads(threads);
  }
  static std::string text(const std::string& acoustics) {
    std::string vehicles;
    for (int i = 0; i < 10; ++i)
      vehicles += test::vehicle("s" + std::to_string(i), "[-300, " + std::to_string(3 * i) + ", -20]", "", 1.5, 36 * i);
    for (int i = 0; i < 150; ++i)
      vehicles += test::vehicle("v" + std::to_string(i), "[" + std::to_string(0.7 * (i / 10)) + ", " +
                                                             std::to_string(0.7 * (i % 10)) + ", -20]");
    return test::sea(acoustics, vehicles,
                     "objects: [{name: wall, fixed: true, position_m: [-2, 3, -20], "
                     "parts: [{shape: box, size_m: [0.2, 4, 2]}]}]\n");
  }
  void step(int number) {
    if (number % 7 == 0) {
      sim::Signal signal = test::message();
      signal.duration = std::chrono::milliseconds(300);
      test::phone(test, "s" + std::to_string(number / 7 % 10)).transducer().transmit(signal, test.world.now());
    }
    if (number == 8) test.world.editor().remove_vehicle("v99");
    if (number == 15) {
      sim::ReceiverConfig receiver;
      receiver.directivity.pattern = sim::DirectivityConfig::Pattern::hemisphere;
      test::phone(test, "v55").transducer().change(receiver);
    }
    test.world.step();
  }
  test::TestWorld test;
};

class ChannelAhead : public testing::TestWithParam<const char*> {};

TEST_P(ChannelAhead, ThreadsGiveTheSameReceptionsAsNone) {
  ManyHearers alone(GetParam(), 1), shared(GetParam(), 3);
  for (int number = 0; number < 140; ++number) {
    alone.step(number);
    shared.step(number);
    ASSERT_EQ(alone.test.world.state().run_hash(), shared.test.world.state().run_hash()) << "step " << number;
  }
  EXPECT_EQ(alone.test.world.acoustics().looked_ahead(), 0);
  // The 17 messages that have arrived by now, with two events at each of 75 receivers.
  EXPECT_GT(shared.test.world.acoustics().looked_ahead(), 17 * 2 * 75);
  EXPECT_GT(alone.test.world.acoustics().flights(), 17 * 149);
}

INSTANTIATE_TEST_SUITE_P(Sound, ChannelAhead,
                         testing::Values("{}", "{multipath: {water_depth_m: 60}, fading: {type: rayleigh}}",
                                         "{propagation: rays, multipath: {water_depth_m: 60}, echo_lock: {}}",
                                         "{occlusion: false}"));

}  // namespace
