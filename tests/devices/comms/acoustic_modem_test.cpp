// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/acoustic_modem.hpp"

#include <cmath>

#include "devices/comms/micromodem_rates.hpp"
#include "sim/acoustics/channel.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace {

using Received = shoal::acoustic_received_t;

/// a at the origin, b 300 m to the east, c 300 m to the north of b (none hides another), 20 m deep.
std::string three(const std::string& keys = "", const std::string& more = "") {
  const std::string modem = "{name: modem, type: acoustic_modem" + keys + "}";
  return test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}, {"c", "[300, 300, -20]", modem}},
                         more);
}

std::int64_t lost(const test::TestWorld& test, const std::string& vehicle, sim::SignalLoss why) {
  const auto& counts = test::device_of<devices::AcousticModem>(test, vehicle + "/modem").transducer().counts();
  return counts.lost[static_cast<std::size_t>(why)];
}

TEST(AcousticModem, ArrivesAfterPreambleBitsAndTheWayOfTheSound) {
  test::TestWorld test(three());
  test::Listener<Received> at_b(test, "b.modem"), at_c(test, "c.modem");
  test.run_for(0.05);
  test.send("a.modem.cmd", test::bytes_to("hello"));
  // 0.3 s and 32 bytes at 80 bit/s: 3.5 s; the way to b: 0.2 s.  It ends at 3.75 s.
  test.run_for(3.69);
  EXPECT_EQ(at_b.take_all().size(), 0u);
  test.run_for(0.02);
  const auto b = at_b.take_all();
  ASSERT_EQ(b.size(), 1u);
  EXPECT_EQ(test::text_of(b[0]), "hello");
  EXPECT_EQ(b[0].source, "a");
  EXPECT_EQ(b[0].destination, "");
  EXPECT_EQ(b[0].sent_utime, test.world.epoch_us() + 50000);
  EXPECT_NEAR(static_cast<double>(b[0].utime - b[0].sent_utime), 200000, 1);  // rounded to microseconds
  EXPECT_NEAR(b[0].travel_time_s, 0.2, 1e-6);
  EXPECT_NEAR(b[0].doppler_mps, 0, 1e-9);
  test.run_for(0.3);
  const auto c = at_c.take_all();
  ASSERT_EQ(c.size(), 1u);
  EXPECT_NEAR(c[0].travel_time_s, std::hypot(0.2, 0.2), 1e-6);
  // sqrt(2) times as far: 15 log10 of it by spreading, and 124 m of absorption more.
  EXPECT_GT(b[0].level_db, c[0].level_db + 15 * std::log10(std::sqrt(2.0)));
}

TEST(AcousticModem, PacketsLastAsLongAsTheTableSays) {
  int found = 0;
  for (const auto& form : test::all_closed_forms()) {
    if (form.name != "micromodem_packet_time") continue;
    for (const auto& rate : devices::micromodem_rates()) {
      if (rate.bit_rate_bps != form.at("bps")) continue;
      test::TestWorld test(three(", preset: micromodem_rate" + std::to_string(rate.number)));
      const auto& modem = test::device_of<devices::AcousticModem>(test, "a/modem");
      const auto bytes = static_cast<std::size_t>(form.at("frames") * form.at("frame_bytes"));
      EXPECT_EQ(modem.message_limit_bytes(), bytes);
      // Less the probe, which the table leaves out.
      EXPECT_NEAR(modem.duration_s(bytes) - devices::micromodem_probe_s, form.expected, 1e-6);
      EXPECT_EQ(modem.duration_s(1), modem.duration_s(static_cast<std::size_t>(form.at("frame_bytes"))));
      ++found;
    }
  }
  EXPECT_EQ(found, 6);
}

TEST(AcousticModem, GoesToOneVehicleUnlessAskedOtherwise) {
  const auto reception = [](const std::string& keys, const std::string& vehicle) {
    test::TestWorld test(three(keys));
    test::Listener<Received> received(test, vehicle + ".modem");
    test.send("a.modem.cmd", test::bytes_to("x", "c"));
    test.run_for(5);
    return received.take_all().size();
  };
  EXPECT_EQ(reception("", "b"), 0u);
  EXPECT_EQ(reception("", "c"), 1u);
  EXPECT_EQ(reception(", promiscuous: true", "b"), 1u);
}

TEST(AcousticModem, SendsAtWholeSecondsWhenItIsSynchronous) {
  test::TestWorld test(three(", synchronous_s: 2"));
  test::Listener<Received> at_b(test, "b.modem");
  test.run_for(0.53);
  test.send("a.modem.cmd", test::bytes_to("one"));
  test.send("a.modem.cmd", test::bytes_to("two"));
  test.run_for(13);
  const auto received = at_b.take_all();
  ASSERT_EQ(received.size(), 2u);
  // 3.5 s long: the second one goes 4 s after the first.
  EXPECT_EQ(received[0].sent_utime % 2'000'000, 0);
  EXPECT_EQ(received[1].sent_utime - received[0].sent_utime, 4'000'000);
  EXPECT_NEAR(received[1].travel_time_s, 0.2, 1e-6);
}

TEST(AcousticModem, OneWayTimesAreByTheTwoClocks) {
  const std::string modem = "{name: modem, type: acoustic_modem, synchronous_s: 1, truth: true}";
  test::TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", modem, "clock: {offset_s: 0.25}"},
                                        {"b", "[300, 0, -20]", modem, "clock: {offset_s: -0.01}"}}));
  test::Listener<Received> at_b(test, "b.modem"), truth(test, "b.modem.truth");
  test.run_for(0.5);
  test.send("a.modem.cmd", test::bytes_to("x"));
  test.run_for(6);
  const Received b = at_b.last(), really = truth.last();
  EXPECT_EQ(b.sent_utime, test.world.epoch_us() + 1'000'000);  // its own whole second
  EXPECT_NEAR(b.travel_time_s, 0.2 - 0.01 - 0.25, 2e-6);
  EXPECT_EQ(really.sent_utime, test.world.epoch_us() + 750'000);
  EXPECT_NEAR(really.travel_time_s, 0.2, 2e-6);
}

TEST(AcousticModem, ReceivesNothingWhileItSends) {
  test::TestWorld test(three());
  test::Listener<Received> at_a(test, "a.modem"), at_b(test, "b.modem"), at_c(test, "c.modem");
  test.send("a.modem.cmd", test::bytes_to("from a"));
  test.send("b.modem.cmd", test::bytes_to("from b"));
  test.run_for(6);
  EXPECT_EQ(at_a.take_all().size() + at_b.take_all().size(), 0u);
  EXPECT_EQ(lost(test, "a", sim::SignalLoss::half_duplex), 1);
  EXPECT_EQ(lost(test, "b", sim::SignalLoss::half_duplex), 1);
}

TEST(AcousticModem, TwoAtOnceAreBothLostAtAThirdButForTheStronger) {
  // a and c are equally far from b: what b takes first is drowned by the other.
  test::TestWorld alike(three());
  test::Listener<Received> none(alike, "b.modem");
  alike.send("a.modem.cmd", test::bytes_to("from a"));
  alike.run_for(0.1);
  alike.send("c.modem.cmd", test::bytes_to("from c"));
  alike.run_for(6);
  EXPECT_EQ(none.take_all().size(), 0u);
  EXPECT_EQ(lost(alike, "b", sim::SignalLoss::busy), 1);
  EXPECT_EQ(lost(alike, "b", sim::SignalLoss::interference), 1);

  // One that tells them apart takes the other for noise.
  test::TestWorld equal(three(", receiver: {protection_dB: -20}"));
  test::Listener<Received> at_b(equal, "b.modem");
  equal.send("a.modem.cmd", test::bytes_to("from a"));
  equal.run_for(0.1);
  equal.send("c.modem.cmd", test::bytes_to("from c"));
  equal.run_for(6);
  EXPECT_EQ(lost(equal, "b", sim::SignalLoss::busy) + lost(equal, "b", sim::SignalLoss::interference), 1);
  // Spread over 50 times its bits a signal as loud as it leaves Eb/N0 at 17 dB: the first comes through.
  const auto received = at_b.take_all();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(test::text_of(received[0]), "from a");
  EXPECT_NEAR(received[0].snr_db, 0, 0.1);

  // Without that spreading both are lost, whatever it tells apart.
  test::TestWorld narrow(three(", bandwidth_Hz: 80, receiver: {protection_dB: -20}"));
  test::Listener<Received> there(narrow, "b.modem");
  narrow.send("a.modem.cmd", test::bytes_to("from a"));
  narrow.run_for(0.1);
  narrow.send("c.modem.cmd", test::bytes_to("from c"));
  narrow.run_for(6);
  EXPECT_EQ(there.take_all().size(), 0u);

  // One that is much nearer takes the receiver over.
  const std::string keys = "{name: modem, type: acoustic_modem}";
  test::TestWorld near(
      test::modem_sea({{"a", "[0, 0, -20]", keys}, {"b", "[300, 0, -20]", keys}, {"c", "[310, 0, -20]", keys}}));
  test::Listener<Received> taken(near, "b.modem");
  near.send("a.modem.cmd", test::bytes_to("from a"));
  near.run_for(1);
  near.send("c.modem.cmd", test::bytes_to("from c"));
  near.run_for(6);
  const auto one = taken.take_all();
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(test::text_of(one[0]), "from c");
  EXPECT_EQ(lost(near, "b", sim::SignalLoss::captured), 1);
}

TEST(AcousticModem, ListensBeforeItSendsWhenAskedTo) {
  test::TestWorld test(three(", listen_before_sending: true"));
  test::Listener<Received> at_a(test, "a.modem"), at_b(test, "b.modem");
  test.send("a.modem.cmd", test::bytes_to("from a"));
  test.run_for(1);  // b is taking it
  test.send("b.modem.cmd", test::bytes_to("from b"));
  test.run_for(8);
  EXPECT_EQ(at_b.take_all().size(), 1u);
  const auto received = at_a.take_all();
  ASSERT_EQ(received.size(), 1u);
  // It begins when what it takes has ended, at 3.7 s, in the next step.
  EXPECT_NEAR(static_cast<double>(received[0].sent_utime - test.world.epoch_us()) * 1e-6, 3.7, 0.011);
}

TEST(AcousticModem, DeliversAsTheBitErrorsOfTheClosedFormSay) {
  // Where the level is what the row of the closed forms wants Eb/N0 to be, and bit rate = bandwidth: by the source
  // level.
  for (const auto& form : test::all_closed_forms()) {
    if (form.name != "packet_success_bfsk" || form.at("bytes") != 32 || form.at("EbN0_dB") != 10) continue;
    const std::string one = ", bandwidth_Hz: 2560, bit_rate_bps: 2560, preamble_s: 0, receiver: {detection_dB: 0}";
    test::TestWorld trial(three(one));
    test::Listener<Received> loud(trial, "b.modem");
    trial.send("a.modem.cmd", test::bytes_to("x"));
    trial.run_for(1);
    const double surplus_dB = loud.last().snr_db - form.at("EbN0_dB");
    test::TestWorld test(three(one + ", source_level_dB: " + std::to_string(185 - surplus_dB)));
    test::Listener<Received> at_b(test, "b.modem");
    const int packets = 400;
    for (int i = 0; i < packets; ++i) {
      test.send("a.modem.cmd", test::bytes_to("x"));
      test.run_for(0.15);
    }
    test.run_for(1);
    const double share = static_cast<double>(at_b.take_all().size()) / packets;
    const double sigma = std::sqrt(form.expected * (1 - form.expected) / packets);
    EXPECT_NEAR(share, form.expected, 4 * sigma);
    return;
  }
  FAIL() << "no such row";
}

TEST(AcousticModem, DeliveryFallsOverRangeAsTheFadingSays) {
  // One sender, receivers at growing ranges on bearings of their own.  Bits are spread over so much bandwidth that a
  // packet that is noticed comes through: the share is that of fades that leave 6 dB, which is the normal
  // distribution's.
  const std::string modem =
      "{name: modem, type: acoustic_modem, frame_bytes: 1, preamble_s: 0.05, source_level_dB: 135}";
  const double ranges_m[] = {800, 1600, 2200, 2800, 3400, 4000};
  std::vector<test::Moored> vehicles{{"a", "[0, 0, -20]", modem}};
  for (int i = 0; i < 6; ++i)
    vehicles.push_back(
        {"r" + std::to_string(i),
         "[" + std::to_string(ranges_m[i] * std::cos(i)) + ", " + std::to_string(ranges_m[i] * std::sin(i)) + ", -20]",
         modem});
  const double sigma_dB = 6;
  test::TestWorld test(test::modem_sea(vehicles, "acoustics: {fading: {type: log_normal, std_dB: 6}}\n"));
  const int packets = 400;
  for (int i = 0; i < packets; ++i) {
    test.send("a.modem.cmd", test::bytes_to("x"));
    test.run_for(0.15);
  }
  test.run_for(3);
  double last = 2;
  for (int i = 0; i < 6; ++i) {
    const auto& water = test.world.acoustics().propagation();
    const sim::Vector3d there_W = test.world.find_vehicle("r" + std::to_string(i))->X_WV().translation();
    const double snr_dB =
        135 - water.transmission_loss({0, 0, -20}, there_W, 25000).dB() - water.ambient_level(25000, 4000).dB();
    const double expected = 0.5 * std::erfc((6 - snr_dB) / (sigma_dB * std::sqrt(2.0)));
    const auto& counts =
        test::device_of<devices::AcousticModem>(test, "r" + std::to_string(i) + "/modem").transducer().counts();
    const double share = static_cast<double>(counts.understood) / packets;
    EXPECT_NEAR(share, expected, 4 * std::sqrt(expected * (1 - expected) / packets) + 0.01) << ranges_m[i];
    EXPECT_LT(expected, last);
    last = expected;
  }
  EXPECT_LT(last, 0.5);
}

TEST(AcousticModem, DropsTheOldestWhenItsQueueIsFull) {
  test::TestWorld test(three(", preset: high_rate, queue_messages: 2"));
  test::Listener<Received> at_b(test, "b.modem");
  for (const char* text : {"1", "2", "3", "4"}) test.send("a.modem.cmd", test::bytes_to(text));
  test.run_for(2);
  const auto received = at_b.take_all();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(test::text_of(received[0]), "3");
  EXPECT_EQ(test::text_of(received[1]), "4");
  EXPECT_EQ(test.world.shared().of(devices::message_modems).dropped_from_queues(), 2);
}

TEST(AcousticModem, RefusesWhatItCannotSend) {
  test::TestWorld test(three());
  test.send("a.modem.cmd", test::bytes_to(std::string(33, 'x')));
  test.send("a.modem.cmd", test::bytes_to(""));
  test.send("a.modem.cmd", test::bytes_to("x", "nobody"));
  test.send("a.modem.cmd", test::bytes_to("x", "a"));
  test.run_for(0.1);
  EXPECT_EQ(test.world.counts().bad_messages, 4);
  const auto error = [](const std::string& keys) { return test::error_of_world(three(keys)); };
  EXPECT_NE(error(", bandwidth_Hz: 60000").find("'bandwidth_Hz' must be < 2 x frequency_Hz"), std::string::npos);
  EXPECT_NE(error(", max_message_bytes: 33").find("'max_message_bytes' must be <= frames x frame_bytes"),
            std::string::npos);
  EXPECT_NE(error(", preset: none").find("'preset'"), std::string::npos);
  EXPECT_NE(error(", synchronous_s: 1e-7").find("'synchronous_s' must be >= 0.001 and <= 3600, or 'at_once', got 1e-7"),
            std::string::npos);
  EXPECT_NE(error(", serial: {path: ''}").find("'path' must not be empty"), std::string::npos);
}

TEST(AcousticModem, AChangedLengthHoldsForItsSerialPortToo) {
  test::WorldWithPorts test(three(", max_message_bytes: 16, serial: {path: \"/nowhere/{vehicle}\"}"));
  const std::string line(30, 'x');
  test.ends["/nowhere/a"]->to_world = line + "\n" + line;
  test.run_for(0.1);
  sim::Diagnostics diagnostics;
  const auto longer = sim::parse_config_text("{max_message_bytes: 32}", "change", diagnostics);
  ASSERT_TRUE(test.world.editor().change_device("a/modem", longer, diagnostics));
  test.ends["/nowhere/a"]->to_world = "\n" + line + "\n";  // the end of one that was cut, and a whole one
  test.run_for(8);
  EXPECT_EQ(test.ends["/nowhere/b"]->from_world, line + "\n");
  EXPECT_EQ(test.world.counts().bad_messages, 2);
}

TEST(AcousticModem, ReportsWhatItsClockShowedThenHoweverLateItReports) {
  // The clock of b is 10 s ahead and was set right after 5 s; what came then is reported 90 s later.
  const std::string modem = "{name: modem, type: acoustic_modem, preset: high_rate, rate_hz: 0.01, phase_s: 95}";
  test::TestWorld test(
      test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem, "clock: {offset_s: 10}"}}));
  test::Listener<Received> at_b(test, "b.modem");
  test.run_for(1);
  test.send("a.modem.cmd", test::bytes_to("early"));
  test.run_for(4);
  auto& clock = const_cast<sim::VehicleClock&>(test.world.find_vehicle("b")->clock());
  for (; test.world.now() < sim::from_seconds(98); test.run_for(1))
    clock.discipline(test.world.now(), clock.error_s(test.world.now()), {});
  const auto received = at_b.take_all();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_NEAR(received[0].travel_time_s, 10.2, 1e-5);
}

TEST(AcousticModem, APacketMayLastLongerThanTheClockRemembers) {
  // 256 s at 1 bit/s; the clock of b, set right before, knows 60 s.
  const std::string modem = "{name: modem, type: acoustic_modem, bit_rate_bps: 1}";
  test::TestWorld test(
      test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem, "clock: {offset_s: 10}"}}));
  test::Listener<Received> at_b(test, "b.modem");
  auto& clock = const_cast<sim::VehicleClock&>(test.world.find_vehicle("b")->clock());
  for (; test.world.now() < sim::from_seconds(270); test.run_for(1)) {
    if (test.world.now() == sim::from_seconds(5)) test.send("a.modem.cmd", test::bytes_to("slow"));
    clock.discipline(test.world.now(), clock.error_s(test.world.now()), {});
  }
  const auto received = at_b.take_all();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_NEAR(received[0].travel_time_s, 0.2, 1e-5);
}

TEST(AcousticModem, FindsTheWholeSecondOfACoarseClock) {
  for (const std::string resolution : {"0.3", "10"}) {
    const std::string modem = "{name: modem, type: acoustic_modem, preset: high_rate, synchronous_s: 1, truth: true}";
    test::TestWorld test(
        test::modem_sea({{"a", "[0, 0, -20]", modem, "clock: {offset_s: 0.25, resolution_s: " + resolution + "}"},
                         {"b", "[300, 0, -20]", modem}}));
    test::Listener<Received> at_b(test, "b.modem.truth");
    test.run_for(0.35);
    test.send("a.modem.cmd", test::bytes_to("x"));
    test.run_for(3);
    const auto received = at_b.take_all();
    ASSERT_EQ(received.size(), 1u);
    EXPECT_EQ(received[0].sent_utime, test.world.epoch_us() + 750000) << resolution;
  }
}

TEST(AcousticModem, NeedsWater) {
  const std::string error =
      test::error_of_world(test::modem_sea({{"a", "[0, 0, 0]", "{name: modem, type: acoustic_modem}"}}, "", "{}"));
  EXPECT_NE(error.find("a device of type 'acoustic_modem' needs water"), std::string::npos) << error;
}

TEST(AcousticModem, OutOfTheWaterItIsSilentAndDeaf) {
  test::TestWorld test(three());
  test::Listener<Received> at_b(test, "b.modem");
  test.world.editor().move_vehicle("a", sim::make_pose({0, 0, 1}, {0, 0, 0}));
  test.send("a.modem.cmd", test::bytes_to("x"));
  test.run_for(5);
  EXPECT_EQ(at_b.take_all().size(), 0u);
  // It leaves the water while it sends: the end of the message is missing.
  test.world.editor().move_vehicle("a", sim::make_pose({0, 0, -20}, {0, 0, 0}));
  test.send("a.modem.cmd", test::bytes_to("x"));
  test.run_for(2);
  test.world.editor().move_vehicle("a", sim::make_pose({0, 0, 1}, {0, 0, 0}));
  test.run_for(5);
  EXPECT_EQ(at_b.take_all().size(), 0u);
  EXPECT_EQ(lost(test, "b", sim::SignalLoss::out_of_water), 1);
}

TEST(AcousticModem, SleepsUntilAMessageComesAndIsTheSameAfterASnapshot) {
  const std::string modem = "{name: modem, type: acoustic_modem, transmit_power_W: 50}";
  const std::string yaml = test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[300, 0, -20]", modem}},
                                           "acoustics: {fading: {type: none}}\n");
  test::TestWorld straight(yaml), restored(yaml);
  test::Listener<shoal::acoustic_received_t> at_b(straight, "b.modem");
  straight.run_for(2);
  EXPECT_EQ(straight.world.counts().samples, 0) << "a sample without messages";
  // Restoring wakes the devices, which must change nothing.
  restored.world.state().restore(straight.world.state().snapshot());
  EXPECT_EQ(restored.world.state().hash(), straight.world.state().hash());
  for (test::TestWorld* test : {&straight, &restored}) {
    test->run_for(1);
    test->send("a.modem.cmd", test::bytes_to("hello"));
    test->run_for(6);
    EXPECT_EQ(test->world.state().hash(), straight.world.state().hash());
    EXPECT_EQ(test->world.state().run_hash(), straight.world.state().run_hash());
  }
  EXPECT_EQ(at_b.take_all().size(), 1u);
}

}  // namespace
