// SPDX-License-Identifier: BSD-3-Clause
// What holds in the acoustic channel whatever the places, speeds and sounds.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <memory>

#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/sound_positioning/acoustic_probe.hpp"

namespace {

using sim::SignalLoss;
using sim::Vector3d;
using test::AcousticProbe;
using Probed = AcousticProbe::Received;

double number_between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 100001) / 100000.0;
}
Vector3d place_within(double across_m, double deepest_m) {
  return {number_between(-across_m, across_m), number_between(-across_m, across_m), number_between(-deepest_m, -5)};
}
Vector3d any_velocity(double max_mps) {
  return {number_between(-max_mps, max_mps), number_between(-max_mps, max_mps), number_between(-1, 1)};
}
std::string text(const Vector3d& v) {
  return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) + "]";
}

/// Water whose speed of sound changes with depth, with the absorption of the sea.
std::string small_sea(const std::string& vehicles, const std::string& paths = "straight") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\n"
         "medium: {water: {surface_m: 0, profile: [{depth_m: 0, sound_speed_mps: 1520}, {depth_m: 100, "
         "sound_speed_mps: 1490}, {depth_m: 400, sound_speed_mps: 1500}]}}\n"
         "acoustics: {propagation: " +
         paths + "}\nvehicles:\n" + vehicles;
}

void set_velocity(test::TestWorld& test, const std::string& vehicle, const Vector3d& v_W) {
  for (const auto& [name, body] : test.world.find_vehicle(vehicle)->bodies())
    body->set_velocity_W(v_W, Vector3d::Zero());
}

sim::ReceiverConfig any_speed() {
  sim::ReceiverConfig receiver;
  receiver.doppler_limit_mps = 100;
  return receiver;
}

/// A frame of so many bytes, at 1 kbit/s.
sim::Signal frame(double source_level_dB, int bytes) {
  sim::Signal signal = AcousticProbe::tone(source_level_dB);
  signal.payload.assign(static_cast<std::size_t>(bytes), std::byte{0x5a});
  signal.bits = 8 * bytes;
  signal.bit_rate_bps = 1000;
  signal.duration = sim::Time{8000 * bytes};
  return signal;
}

/// Whether none touches another: boxes that overlap push each other away, and are no longer where the world put them.
bool all_apart(const std::vector<Vector3d>& places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((places[i] - places[j]).norm() < 2) return false;
  return true;
}

/// The bits of all that a probe received.
std::uint64_t fingerprint(const std::vector<Probed>& all) {
  sim::StateHash hash;
  for (const Probed& received : all) {
    hash.add(std::string_view(received.source));
    hash.add(static_cast<std::int64_t>(received.started.count()));
    hash.add(static_cast<std::int64_t>(received.ended.count()));
    for (const double value :
         {received.travel_time_s, received.level_dB, received.snr_dB, received.sinr_dB, received.closing_mps})
      hash.add(value);
    hash.add(static_cast<int>(received.loss));
  }
  return hash.value();
}

RC_GTEST_PROP(AcousticChannel, CarriesSoundBothWaysWithTheSameLoss, ()) {
  const Vector3d p_a = place_within(2000, 300), p_b = place_within(2000, 300);
  RC_PRE(all_apart({p_a, p_b}));
  test::TestWorld test(small_sea(test::float_at("a", text(p_a)) + test::float_at("b", text(p_b))));
  AcousticProbe a(test, "a"), b(test, "b");
  const double level_dB = number_between(170, 200);
  a.send(AcousticProbe::tone(level_dB));
  test.run_for(5);
  b.send(AcousticProbe::tone(level_dB));
  test.run_for(5);
  RC_ASSERT(a.all.size() == 1u && b.all.size() == 1u);
  RC_ASSERT(std::abs(a.all[0].level_dB - b.all[0].level_dB) < 1e-9);
  RC_ASSERT(std::abs(a.all[0].travel_time_s - b.all[0].travel_time_s) < 1e-9);
}

RC_GTEST_PROP(AcousticChannel, CarriesBentSoundBothWaysWithTheSameLoss, ()) {
  const Vector3d p_a = place_within(2000, 300), p_b = place_within(2000, 300);
  RC_PRE(all_apart({p_a, p_b}));
  test::TestWorld test(small_sea(test::float_at("a", text(p_a)) + test::float_at("b", text(p_b)), "rays"));
  AcousticProbe a(test, "a"), b(test, "b");
  a.send(AcousticProbe::tone(190));
  test.run_for(5);
  b.send(AcousticProbe::tone(190));
  test.run_for(5);
  RC_ASSERT(a.all.size() == 1u && b.all.size() == 1u);
  RC_ASSERT(a.all[0].loss == b.all[0].loss);
  if (a.all[0].loss == SignalLoss::shadow) return;
  RC_ASSERT(std::abs(a.all[0].level_dB - b.all[0].level_dB) < 1e-6);
  RC_ASSERT(std::abs(a.all[0].travel_time_s - b.all[0].travel_time_s) < 1e-9);
}

RC_GTEST_PROP(AcousticChannel, NeitherOutrunsTheSpeedsOfSoundOnTheWayNorLagsThem, ()) {
  const Vector3d p_a = place_within(1500, 300), p_b = place_within(1500, 300);
  RC_PRE(all_apart({p_a, p_b}));
  test::TestWorld test(small_sea(test::float_at("a", text(p_a)) + test::float_at("b", text(p_b))));
  AcousticProbe a(test, "a", any_speed()), b(test, "b", any_speed());
  set_velocity(test, "a", any_velocity(20));
  set_velocity(test, "b", any_velocity(20));
  test.run_for(0.01 * *rc::gen::inRange(0, 100));
  a.send(AcousticProbe::tone());
  test.run_for(4);
  RC_ASSERT(b.all.size() == 1u);
  const Probed& received = b.all[0];
  double slowest_mps = 1e9, fastest_mps = 0;
  for (int i = 0; i <= 100; ++i) {
    const double share = i / 100.0;
    const double c =
        test.world.medium().sound_speed_mps((1 - share) * received.p_sent_W + share * received.p_started_W);
    slowest_mps = std::min(slowest_mps, c);
    fastest_mps = std::max(fastest_mps, c);
  }
  const double distance_m = (received.p_started_W - received.p_sent_W).norm();
  // The places are those at whole microseconds: 20 um; between two samples of 100 the speed bends by less than 1e-4.
  RC_ASSERT(received.travel_time_s > distance_m / fastest_mps * (1 - 1e-4) - 2e-6);
  RC_ASSERT(received.travel_time_s < distance_m / slowest_mps * (1 + 1e-4) + 2e-6);
  RC_ASSERT(received.started == received.sent + sim::from_seconds(received.travel_time_s));
}

RC_GTEST_PROP(AcousticChannel, ReachesTheNearerFirstAndKeepsTheOrderOfSending, ()) {
  const Vector3d p_a = place_within(1000, 100);
  std::vector<Vector3d> places;
  std::string vehicles = test::float_at("a", text(p_a));
  for (int i = 0; i < 4; ++i) {
    places.push_back(place_within(1000, 100));
    vehicles += test::float_at("b" + std::to_string(i), text(places.back()));
  }
  RC_PRE(all_apart({p_a, places[0], places[1], places[2], places[3]}));
  test::TestWorld test(test::sound_world(vehicles));
  AcousticProbe a(test, "a");
  std::vector<std::unique_ptr<AcousticProbe>> others;
  for (int i = 0; i < 4; ++i) others.push_back(std::make_unique<AcousticProbe>(test, "b" + std::to_string(i)));
  sim::Signal first = AcousticProbe::tone(), second = AcousticProbe::tone();
  first.code = "first";
  second.code = "second";
  a.send(first);
  a.transducer.transmit(second, test.world.now() + first.duration);
  test.run_for(4);
  for (const auto& other : others) RC_ASSERT(other->all.size() == 2u);
  for (std::size_t i = 0; i < 4; ++i) {
    RC_ASSERT(others[i]->all[0].signal.code == "first" && others[i]->all[1].signal.code == "second");
    for (std::size_t j = 0; j < 4; ++j)
      if ((places[i] - p_a).norm() < (places[j] - p_a).norm())
        RC_ASSERT(others[i]->all[0].started <= others[j]->all[0].started);
  }
}

RC_GTEST_PROP(AcousticChannel, APacketAloneOnACleanLinkAlwaysGetsThrough, ()) {
  // 190 dB less some 60 dB over 2.9 km, against some 70 dB of noise: 60 dB.
  const Vector3d p_a = place_within(1000, 300), p_b = place_within(1000, 300);
  RC_PRE(all_apart({p_a, p_b}));
  test::TestWorld test(small_sea(test::float_at("a", text(p_a)) + test::float_at("b", text(p_b))));
  AcousticProbe a(test, "a"), b(test, "b");
  set_velocity(test, "b", any_velocity(1.5));
  const int bytes = *rc::gen::inRange(1, 200);
  a.send(frame(190, bytes));
  test.run_for(2.5 + 0.008 * bytes);
  RC_ASSERT(b.understood() == 1u);
  RC_ASSERT(b.all[0].signal.payload.size() == static_cast<std::size_t>(bytes));
  RC_ASSERT(b.all[0].snr_dB > 40);
}

RC_GTEST_PROP(AcousticChannel, WhoSendsReceivesNothing, ()) {
  const double range_m = number_between(50, 1000);
  test::TestWorld test(test::sound_world(test::float_at("a", "[0, 0, -20]") +
                                         test::float_at("b", "[" + std::to_string(range_m) + ", 0, -20]")));
  AcousticProbe a(test, "a"), b(test, "b");
  const sim::Signal received = frame(185, 20), sent = frame(185, *rc::gen::inRange(1, 40));
  const sim::Time travel = sim::from_seconds(range_m / 1500);
  // b begins at any time while it would receive, or up to the length of its own before.
  const auto at =
      travel + sim::Time{*rc::gen::inRange<std::int64_t>(-sent.duration.count() + 2, received.duration.count() - 2)};
  RC_PRE(at.count() >= 0);
  a.transducer.transmit(received, sim::Time{0});
  b.transducer.transmit(sent, at);
  test.run_for(3);
  RC_ASSERT(b.all.size() == 1u);
  RC_ASSERT(b.all[0].loss == SignalLoss::half_duplex);
}

/// Ten vehicles that drift and send at random for a while: the state of the world at the end, and what each received.
struct Chatter {
  std::uint64_t state = 0;
  std::array<std::uint64_t, 10> received{};
  std::int64_t understood = 0;
};
Chatter chatter(int seed, int threads, bool with_deaf) {
  std::string vehicles;
  for (int i = 0; i < 10; ++i)
    vehicles += test::float_at("v" + std::to_string(i),
                               text({300.0 * (i % 4) + 7 * i, 250.0 * (i / 4), -20.0 - 9 * ((i * seed) % 11)}));
  if (with_deaf) vehicles += test::float_at("deaf", "[9000, 9000, -50]");
  test::TestWorld test(small_sea(vehicles, seed % 2 == 0 ? "straight" : "rays") +
                       "run: {seed: " + std::to_string(seed) + "}\n");
  test.world.use_threads(threads);
  std::vector<std::unique_ptr<AcousticProbe>> probes;
  for (int i = 0; i < 10; ++i) {
    const std::string name = "v" + std::to_string(i);
    probes.push_back(std::make_unique<AcousticProbe>(test, name));
    set_velocity(test, name, {0.3 * i - 1.5, 0.1 * ((i * seed) % 7), 0});
  }
  std::unique_ptr<AcousticProbe> deaf;
  if (with_deaf) {
    deaf = std::make_unique<AcousticProbe>(test, "deaf");
    deaf->listening = false;
  }
  sim::Random random(static_cast<std::uint64_t>(seed), "chatter");
  for (int step = 0; step < 1000; ++step) {
    random.begin_step(step);
    for (const auto& probe : probes)
      if (random.uniform() < 0.004 && probe->transducer.busy_until() <= test.world.now())
        probe->send(frame(165 + 20 * random.uniform(), 30));
    test.world.step();
  }
  Chatter result;
  result.state = test.world.state().hash();
  for (std::size_t i = 0; i < 10; ++i) {
    result.received[i] = fingerprint(probes[i]->all);
    result.understood += static_cast<std::int64_t>(probes[i]->understood());
  }
  return result;
}

TEST(AcousticChannelProperties, ARunIsTheSameWithOneAndEightThreads) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Chatter one = chatter(seed, 1, false), eight = chatter(seed, 8, false);
    EXPECT_EQ(one.state, eight.state) << seed;
    EXPECT_EQ(one.received, eight.received) << seed;
    EXPECT_GT(one.understood, 20) << seed;  // so that there is something to compare
  }
}

TEST(AcousticChannelProperties, ADeafOneFarAwayChangesNothingForTheOthers) {
  for (int seed = 1; seed <= 5; ++seed)
    EXPECT_EQ(chatter(seed, 1, false).received, chatter(seed, 1, true).received) << seed;
}

std::string pair_at(double range_m) {
  return test::float_at("a", "[0, 0, -20]") + test::float_at("b", "[" + std::to_string(range_m) + ", 0, -20]");
}

TEST(AcousticChannelProperties, WhatWasSentContinuesWhenItsSenderIsRemoved) {
  test::TestWorld test(test::sound_world(pair_at(1500)));
  AcousticProbe b(test, "b");
  auto a = std::make_unique<AcousticProbe>(test, "a");
  a->send(AcousticProbe::tone());
  test.run_for(0.5);
  a.reset();
  test.world.editor().remove_vehicle("a");
  test.run_for(1);
  ASSERT_EQ(b.all.size(), 1u);
  EXPECT_EQ(b.all[0].loss, SignalLoss::none);
  EXPECT_EQ(b.all[0].started, sim::from_seconds(1));
  EXPECT_EQ(b.all[0].source, "a/probe");
}

TEST(AcousticChannelProperties, ASignalIsCutOffWhenItsSenderIsRemovedWhileSending) {
  test::TestWorld test(test::sound_world(pair_at(300)));
  AcousticProbe b(test, "b");
  auto a = std::make_unique<AcousticProbe>(test, "a");
  a->send(frame(185, 125));  // 1 s
  test.run_for(0.5);
  a.reset();
  test.world.editor().remove_vehicle("a");
  test.run_for(2);
  EXPECT_EQ(b.understood(), 0u);
}

TEST(AcousticChannelProperties, ReceiversMayBeRemovedAtAnyTimeOfAFlight) {
  // Before it comes near, while it is near, while it is received, and after.
  for (const double removed_s : {0.05, 0.97, 1.05, 1.2}) {
    test::TestWorld test(test::sound_world(pair_at(1500) + test::float_at("c", "[0, 1500, -20]")));
    AcousticProbe a(test, "a"), c(test, "c");
    auto b = std::make_unique<AcousticProbe>(test, "b");
    a.send(frame(185, 12));  // 0.096 s, received from 1 s on
    test.run_for(removed_s);
    b.reset();
    test.world.editor().remove_vehicle("b");
    test.run_for(2);
    EXPECT_EQ(c.understood(), 1u) << removed_s;
    // The place of what has gone is used again.
    AcousticProbe again(test, "c");
    a.send(frame(185, 12));
    test.run_for(2);
    EXPECT_EQ(again.understood(), 1u) << removed_s;
  }
}

TEST(AcousticChannelProperties, WhoComesWhileASignalIsUnderWayReceivesTheNextOne) {
  test::TestWorld test(test::sound_world(pair_at(1500)));
  AcousticProbe a(test, "a"), b(test, "b");
  sim::Signal first = AcousticProbe::tone(), second = AcousticProbe::tone();
  first.code = "first";
  second.code = "second";
  a.send(first);
  test.run_for(0.3);
  sim::VehicleInstance instance = test.loaded.config.vehicles.at(1);
  instance.name = "guest";
  instance.X_WV.translation() = Vector3d(0, 900, -20);
  test.world.editor().add_vehicle(instance);
  AcousticProbe guest(test, "guest");
  test.run_for(1);
  EXPECT_EQ(b.understood(), 1u);
  a.send(second);
  test.run_for(1.2);
  EXPECT_EQ(b.understood(), 2u);
  ASSERT_FALSE(guest.all.empty());
  EXPECT_EQ(guest.all.back().signal.code, "second");
  EXPECT_EQ(guest.all.back().started - guest.all.back().sent, sim::from_seconds(0.6));
}

RC_GTEST_PROP(AcousticChannel, SomeOneWhoIsPutElsewhereReceivesNoSoonerThanSoundGetsThere, ()) {
  const double range_m = number_between(100, 1500), moved_s = 0.01 * *rc::gen::inRange(1, 120);
  test::TestWorld test(test::sound_world(pair_at(range_m)));
  AcousticProbe a(test, "a"), b(test, "b");
  a.send(AcousticProbe::tone());
  test.run_for(moved_s);
  sim::Pose X_WV = sim::Pose::Identity();
  X_WV.translation() = place_within(1500, 100);
  RC_PRE(all_apart({X_WV.translation(), a.transducer.p_W(test.world.now())}));
  test.world.editor().move_vehicle("b", X_WV);
  test.run_for(5);
  RC_ASSERT(b.all.size() <= 1u);
  for (const Probed& received : b.all)
    RC_ASSERT(sim::to_seconds(received.started - received.sent) >
              (received.p_started_W - received.p_sent_W).norm() / 1500 - 1e-6);
  // And the next one is received as if nothing had happened.
  b.all.clear();
  a.send(AcousticProbe::tone());
  test.run_for(4);
  RC_ASSERT(b.understood() == 1u);
  RC_ASSERT(std::abs(b.all[0].travel_time_s - (X_WV.translation() - a.transducer.p_W(test.world.now())).norm() / 1500) <
            1e-6);
}

}  // namespace
