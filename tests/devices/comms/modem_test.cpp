// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/message_modem.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

/// Three boxes on a line, 150 m apart, with a modem each.
std::string modem_world(const std::string& keys, const std::string& third_network = "radio") {
  std::string text =
      "shoal: 1\nphysics: {step_s: 0.001}\nobjects:\n  - {name: ground, fixed: true, parts: [{shape: "
      "plane}]}\nvehicles:\n";
  const char* names[] = {"a", "b", "c"};
  for (int i = 0; i < 3; ++i)
    text += std::string("  - {name: ") + names[i] + ", position_m: [" + std::to_string(150 * i) +
            ", 0, 0], model: {shoal: 1, vehicle: box" + std::to_string(i) +
            ", bodies: [{name: b, position_m: [0, 0, 0.2], parts: [{shape: box, size_m: [0.4, 0.4, 0.4], "
            "mass_kg: 5}]}], devices: [{name: modem, type: modem, network: " +
            (i == 2 ? third_network : "radio") + ", " + keys + "}]}}\n";
  return text;
}

shoal::modem_send_t message(const std::string& text, const std::string& destination = "") {
  shoal::modem_send_t send{};
  send.destination = destination;
  send.size = static_cast<std::int32_t>(text.size());
  send.data.assign(text.begin(), text.end());
  return send;
}

std::string text_of(const shoal::modem_received_t& received) {
  return {received.data.begin(), received.data.end()};
}

TEST(Modem, DeliversAfterAirTimeAndPropagation) {
  // 10 bytes at 800 bit/s: 0.1 s; 150 m at 1500 m/s: 0.1 s.
  test::TestWorld test(modem_world("range_m: 1000, data_rate_bps: 800, propagation_mps: 1500"));
  test::Listener<shoal::modem_received_t> at_b(test, "b.modem");
  test::Listener<shoal::modem_received_t> at_c(test, "c.modem");
  test.run_for(0.05);
  test.send("a.modem.cmd", message("0123456789"));
  test.run_for(0.5);
  const auto b = at_b.take_all();
  const auto c = at_c.take_all();
  ASSERT_EQ(b.size(), 1u);
  ASSERT_EQ(c.size(), 1u);
  EXPECT_EQ(text_of(b[0]), "0123456789");
  EXPECT_EQ(b[0].source, "a");
  EXPECT_EQ(b[0].sent_utime, test.world.epoch_us() + 50000);
  EXPECT_EQ(b[0].utime - b[0].sent_utime, 200000);
  EXPECT_EQ(c[0].utime - c[0].sent_utime, 300000);
}

/// What r1 at 10 m depth sends and a modem at `z_m` receives.
std::size_t reception(const std::string& through, double z_m, const std::string& medium) {
  const std::string modem = "type: modem, range_m: 1000, through: " + through;
  const std::string other = "  - {name: b, position_m: [100, 0, " + std::to_string(z_m) +
                            "], model: {shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: {model: none}, "
                            "parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [{name: s, " +
                            modem + "}]}}\n";
  test::TestWorld test(test::marine_world(modem, "[0, 0, -10]", "[]", other, medium));
  test::Listener<shoal::modem_received_t> received(test, "b.s");
  test.send("r1.s.cmd", message("x"));
  test.run_for(1);
  return received.take_all().size();
}

TEST(Modem, RadioDoesNotPassWaterAndSoundDoesNotPassAir) {
  const char* sea = "{water: {surface_m: 0}}";
  EXPECT_EQ(reception("radio", -10, sea), 0u);
  EXPECT_EQ(reception("radio", 1, sea), 0u);
  EXPECT_EQ(reception("acoustic", -10, sea), 1u);
  EXPECT_EQ(reception("acoustic", 1, sea), 0u);
  EXPECT_EQ(reception("any", 1, sea), 1u);
  EXPECT_EQ(reception("radio", 1, "{water: {surface_m: -20}}"), 1u);
  EXPECT_EQ(reception("radio", 1, "{}"), 1u);
  EXPECT_EQ(reception("any", 1, "{}"), 1u);
}

TEST(Modem, SoundTakesTheSpeedOfTheWaterAtItsSender) {
  const std::string modem = "type: modem, range_m: 1000, data_rate_bps: 8000, through: acoustic";
  test::TestWorld test(test::marine_world(
      modem, "[0, 0, -10]", "[]",
      "  - {name: b, position_m: [300, 0, -10], model: {shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: "
      "{model: none}, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [{name: s, " +
          modem + "}]}}\n"));
  test::Listener<shoal::modem_received_t> received(test, "b.s");
  test.send("r1.s.cmd", message("x"));
  test.run_for(1);
  const auto report = received.last();
  const double expected_s = 0.001 + 300 / test.world.medium().sound_speed_mps({0, 0, -10});  // 8 bits, and the way
  EXPECT_NEAR(static_cast<double>(report.utime - report.sent_utime) * 1e-6, expected_s, 2e-6);
}

TEST(Modem, IsNotReceivedBeyondItsRangeOrInAnotherNetwork) {
  test::TestWorld near(modem_world("range_m: 200"));
  test::Listener<shoal::modem_received_t> b(near, "b.modem"), c(near, "c.modem");
  near.send("a.modem.cmd", message("x"));
  near.run_for(1);
  EXPECT_EQ(b.take_all().size(), 1u);
  EXPECT_EQ(c.take_all().size(), 0u);

  test::TestWorld apart(modem_world("range_m: 2000", "other"));
  test::Listener<shoal::modem_received_t> on_other(apart, "c.modem");
  apart.send("a.modem.cmd", message("x"));
  apart.run_for(1);
  EXPECT_EQ(on_other.take_all().size(), 0u);
}

TEST(Modem, AWallHidesWhereALineOfSightIsNeeded) {
  const auto reception = [](const std::string& keys) {
    std::string yaml = modem_world("range_m: 1000" + keys);
    // Between b and c, 5 m high; the boxes themselves hide nothing.
    yaml.insert(yaml.find("vehicles:"),
                "  - {name: wall, fixed: true, position_m: [200, 0, 0], parts: [{shape: box, "
                "size_m: [1, 50, 10]}]}\n");
    test::TestWorld test(yaml);
    test::Listener<shoal::modem_received_t> b(test, "b.modem"), c(test, "c.modem");
    test.send("a.modem.cmd", message("x"));
    test.run_for(0.5);
    return std::pair{b.take_all().size(), c.take_all().size()};
  };
  EXPECT_EQ(reception(""), (std::pair<std::size_t, std::size_t>{1, 1}));
  EXPECT_EQ(reception(", line_of_sight: true"), (std::pair<std::size_t, std::size_t>{1, 0}));
}

TEST(Modem, SendsToOneVehicleWhenADestinationIsGiven) {
  test::TestWorld test(modem_world("range_m: 1000"));
  test::Listener<shoal::modem_received_t> b(test, "b.modem"), c(test, "c.modem");
  test.send("a.modem.cmd", message("x", "c"));
  test.run_for(1);
  EXPECT_EQ(b.take_all().size(), 0u);
  EXPECT_EQ(c.take_all().size(), 1u);
}

TEST(Modem, SendsOneMessageAfterTheOther) {
  test::TestWorld test(modem_world("range_m: 1000, data_rate_bps: 800, propagation_mps: 1e9"));
  test::Listener<shoal::modem_received_t> b(test, "b.modem");
  test.send("a.modem.cmd", message("0123456789"));
  test.send("a.modem.cmd", message("abcdefghij"));
  test.run_for(1);
  const auto received = b.take_all();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(text_of(received[1]), "abcdefghij");
  EXPECT_EQ(received[1].sent_utime - received[0].sent_utime, 100000);
}

TEST(Modem, SendsSeveralShortMessagesInOneStep) {
  // 5 bytes at 1 Mbit/s: 40 us; a step of 1 ms has room for 25.
  test::TestWorld test(modem_world("range_m: 200, data_rate_bps: 1e6, propagation_mps: 1e9, queue_messages: 100"));
  test::Listener<shoal::modem_received_t> b(test, "b.modem");
  for (int i = 0; i < 30; ++i) test.send("a.modem.cmd", message("12345"));
  test.world.step();
  test.world.step();
  const auto received = b.take_all();
  ASSERT_EQ(received.size(), 30u);
  EXPECT_EQ(received[1].sent_utime - received[0].sent_utime, 40);
}

TEST(Modem, LosesTheShareOfMessagesAskedFor) {
  test::TestWorld test(modem_world("range_m: 200, data_rate_bps: 1e6, loss_probability: 0.3"));
  test::Listener<shoal::modem_received_t> b(test, "b.modem");
  for (int i = 0; i < 2000; ++i) {
    test.send("a.modem.cmd", message("x"));
    test.world.step();
  }
  test.run_for(0.1);
  // Binomial: 2000 * 0.7 = 1400, sigma = sqrt(2000 * 0.3 * 0.7) = 20.5.
  EXPECT_NEAR(static_cast<double>(b.take_all().size()), 1400, 4 * 20.5);
}

TEST(Modem, DropsTheOldestWhenItsQueueIsFull) {
  test::TestWorld test(modem_world("range_m: 1000, data_rate_bps: 80, queue_messages: 2"));
  test::Listener<shoal::modem_received_t> b(test, "b.modem");
  for (const char* text : {"1", "2", "3", "4"}) test.send("a.modem.cmd", message(text));
  test.run_for(2);
  const auto received = b.take_all();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(text_of(received[0]), "3");
  EXPECT_EQ(text_of(received[1]), "4");
  EXPECT_EQ(test.world.shared().of(devices::message_modems).dropped_from_queues(), 2);
  test.world.editor().remove_vehicle("a");
  EXPECT_EQ(test.world.shared().of(devices::message_modems).dropped_from_queues(), 2) << "of those gone, too";
}

TEST(Modem, RefusesWhatItCannotSend) {
  test::TestWorld test(modem_world("range_m: 1000, max_message_bytes: 4"));
  test.send("a.modem.cmd", message("12345"));
  test.send("a.modem.cmd", message(""));
  test.send("a.modem.cmd", message("x", "nobody"));
  test.run_for(0.1);
  EXPECT_EQ(test.world.counts().bad_messages, 3);
}

TEST(Modem, PublishesLinesThroughItsSerialPort) {
  test::WorldWithPorts test(modem_world("range_m: 1000, serial: {path: \"/nowhere/{vehicle}\"}"));
  test.ends["/nowhere/a"]->to_world = "hello\nworld\npart of a li";
  test.run_for(0.5);
  EXPECT_EQ(test.ends["/nowhere/b"]->from_world, "hello\nworld\n");
  EXPECT_EQ(test.ends["/nowhere/c"]->from_world, "hello\nworld\n");
  test.ends["/nowhere/a"]->to_world = "ne\n";
  test.run_for(0.5);
  EXPECT_EQ(test.ends["/nowhere/b"]->from_world, "hello\nworld\npart of a line\n");
}

TEST(Modem, ALineThatIsTooLongIsABadMessage) {
  test::WorldWithPorts test(modem_world("range_m: 1000, max_message_bytes: 4, serial: {path: \"/nowhere/{vehicle}\"}"));
  test.ends["/nowhere/a"]->to_world = "12345\n1234\n";
  test.run_for(0.5);
  EXPECT_EQ(test.ends["/nowhere/b"]->from_world, "1234\n");
  EXPECT_EQ(test.world.counts().bad_messages, 1);
}

TEST(Modem, CountsWhatNoOneFetchesFromItsSerialPort) {
  test::WorldWithPorts test(modem_world("range_m: 1000, serial: {path: \"/nowhere/{vehicle}\"}"));
  EXPECT_EQ(devices::serial_dropped_bytes(test.world), 0u);
  test.ends["/nowhere/b"]->room_bytes = 8;
  test.ends["/nowhere/c"]->room_bytes = 10;
  test.ends["/nowhere/a"]->to_world = "hello\nworld\n";
  test.run_for(0.5);
  EXPECT_EQ(devices::serial_dropped_bytes(test.world), 6u);  // 4 of 12 at b, 2 at c
  EXPECT_EQ(test.world.counts().bad_messages, 2);            // told once by each
  test.ends["/nowhere/a"]->to_world = "hello\nworld\n";
  test.run_for(0.5);
  EXPECT_EQ(devices::serial_dropped_bytes(test.world), 30u);
  EXPECT_EQ(test.world.counts().bad_messages, 2);
}

}  // namespace
