// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>

#include "sim/world/world_state.hpp"
#include "tests/sim/acoustics/sea_of_hydrophones.hpp"

// Receptions that threads handle together.

namespace {

/// 10 vehicles that move and send in turn, every 7 steps, to 150 vehicles 300 m away, so close together that the sound
/// reaches them within 7 ms: 75 of them at least in one step.  While sound is on its way to them one is removed, and
/// one changes its receiver.  Every other one ignores what it does not detect, so that ends are deferred, too.
struct ManyHearers {
  explicit ManyHearers(const std::string& acoustics, int threads) : test(text(acoustics)) {
    test.world.use_threads(threads);
    for (int i = 0; i < 150; i += 2) test::phone(test, "v" + std::to_string(i)).undetected = false;
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

class DeferredReceptions : public testing::TestWithParam<const char*> {};

TEST_P(DeferredReceptions, AreThoseOfOneThreadWithAny) {
  ManyHearers alone(GetParam(), 1), shared(GetParam(), 3);
  for (int number = 0; number < 140; ++number) {
    alone.step(number);
    shared.step(number);
    ASSERT_EQ(alone.test.world.state().run_hash(), shared.test.world.state().run_hash()) << "step " << number;
  }
  const auto &one = alone.test.world.acoustics(), &three = shared.test.world.acoustics();
  EXPECT_EQ(one.deferred(), three.deferred());
  // The 17 messages that have arrived by now, with two events at each of 75 receivers at least.
  EXPECT_GT(one.deferred(), 17 * 2 * 75);
  EXPECT_GT(one.flights(), 17 * 149);
}

/// A restored world computes again what is kept up to date.
TEST_P(DeferredReceptions, KeepTheHashOfTheChannelUpToDate) {
  ManyHearers hearers(GetParam(), 1), other(GetParam(), 1);
  std::set<std::uint64_t> hashes;
  for (int number = 0; number < 60; ++number) {
    hearers.step(number);
    if (number % 4 != 3) continue;
    other.test.world.state().restore(hearers.test.world.state().snapshot());
    const std::uint64_t hash = hearers.test.world.acoustics().content_hash();
    ASSERT_EQ(hash, other.test.world.acoustics().content_hash()) << "step " << number;
    EXPECT_TRUE(hashes.insert(hash).second) << "step " << number;
  }
}

TEST(RestoredReceptions, ContinueAfterARestoreAsWithoutIt) {
  ManyHearers run("{}", 1), again("{}", 2);
  for (int number = 0; number < 40; ++number) run.step(number);
  again.test.world.state().restore(run.test.world.state().snapshot());
  for (int i = 0; i < 150; i += 2) test::phone(again.test, "v" + std::to_string(i)).undetected = false;
  for (int number = 40; number < 80; ++number) {
    run.step(number);
    again.step(number);
    ASSERT_EQ(run.test.world.state().run_hash(), again.test.world.state().run_hash()) << "step " << number;
  }
}

INSTANTIATE_TEST_SUITE_P(Sound, DeferredReceptions,
                         testing::Values("{}", "{multipath: {water_depth_m: 60}, fading: {type: rayleigh}}",
                                         "{propagation: rays, multipath: {water_depth_m: 60}, echo_lock: {}}",
                                         "{occlusion: false}"));

}  // namespace
