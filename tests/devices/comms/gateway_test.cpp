// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/gateway.hpp"

#include "shoal/gateway_state_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace {

const std::string radio = "{name: radio, type: modem, range_m: 10000, position_m: [0, 0, 1]}";
const std::string acoustic = "{name: acoustic, type: acoustic_modem, preset: high_rate, frame_bytes: 40}";

/// A ship with a radio, a buoy with radio and acoustic modem, and an AUV with an acoustic modem.
std::string ship_buoy_auv(const std::string& keys = "", const std::string& buoy2 = "") {
  const std::string gateway = ", {name: gate, type: gateway, between: [radio, acoustic]" + keys + "}";
  std::vector<test::Moored> all{{"ship", "[500, 0, -0.5]", radio},
                                {"buoy", "[0, 0, -0.5]", radio + ", " + acoustic + gateway},
                                {"auv", "[0, 0, -150]", acoustic}};
  if (!buoy2.empty()) all.push_back({"buoy2", "[100, 0, -0.5]", radio + ", " + acoustic + gateway});
  return test::modem_sea(all);
}

TEST(Gateway, PassesRadioToSoundAndBack) {
  test::TestWorld test(ship_buoy_auv(", delay_s: 0.2"));
  test::Listener<shoal::acoustic_received_t> at_auv(test, "auv.acoustic");
  test::Listener<shoal::modem_received_t> at_ship(test, "ship.radio"), at_buoy(test, "buoy.radio");
  test::Listener<shoal::gateway_state_t> state(test, "buoy.gate");
  test.send("ship.radio.cmd", test::bytes_to("dive", "buoy"));
  test.run_for(1.5);
  const auto down = at_auv.take_all();
  ASSERT_EQ(down.size(), 1u);
  EXPECT_EQ(test::text_of(down[0]), "dive");
  EXPECT_EQ(down[0].source, "buoy");  // who sent it into the water
  // 4 bytes at 9600 bit/s and 0.2 s in the gateway, to the step.
  EXPECT_NEAR(static_cast<double>(down[0].sent_utime - test.world.epoch_us()) * 1e-6, 0.2033, 0.021);
  EXPECT_NEAR(down[0].travel_time_s, 149.5 / 1500, 1e-6);

  test.send("auv.acoustic.cmd", test::bytes_to("here I am"));
  test.run_for(2);
  const auto up = at_ship.take_all();
  ASSERT_EQ(up.size(), 1u);
  EXPECT_EQ(test::text_of(up[0]), "here I am");
  EXPECT_EQ(up[0].source, "buoy");
  EXPECT_EQ(at_auv.take_all().size(), 0u);  // it does not go back
  const auto last = state.last();
  EXPECT_EQ(last.passed[0], 1);
  EXPECT_EQ(last.passed[1], 1);
}

TEST(Gateway, TwoOfThemDoNotPlayPingPong) {
  const auto sent = [](const std::string& keys) {
    test::TestWorld test(ship_buoy_auv(keys, "two"));
    test.send("ship.radio.cmd", test::bytes_to("dive", "buoy"));  // buoy, buoy2 by sound, buoy by radio, ...
    test.run_for(20);
    return test::device_of<devices::Gateway>(test, "buoy/gate").counts()[0].passed +
           test::device_of<devices::Gateway>(test, "buoy2/gate").counts()[1].passed;
  };
  EXPECT_EQ(sent(""), 2);
  EXPECT_EQ(sent(", name_source: true"), 2);  // although each of them puts a name before it
  EXPECT_GT(sent(", repeat_s: 0"), 5);        // forever
}

TEST(Gateway, RefusesWhatIsTooLongForTheOtherSideAndWhatHasNotItsPrefix) {
  test::TestWorld test(ship_buoy_auv(", only_prefix: \"@\", name_source: true, destinations: [\"\", auv]"));
  test::Listener<shoal::acoustic_received_t> at_auv(test, "auv.acoustic");
  test::Listener<shoal::gateway_state_t> state(test, "buoy.gate");
  test.send("ship.radio.cmd", test::bytes_to("dive"));
  test.send("ship.radio.cmd", test::bytes_to("@dive"));
  test.send("ship.radio.cmd", test::bytes_to("@" + std::string(39, 'x')));  // with "ship:" 45 bytes
  test.run_for(3);
  const auto down = at_auv.take_all();
  ASSERT_EQ(down.size(), 1u);
  EXPECT_EQ(test::text_of(down[0]), "ship:@dive");
  EXPECT_EQ(down[0].destination, "auv");
  const auto last = state.last();
  EXPECT_EQ(last.passed[0], 1);
  EXPECT_EQ(last.refused[0], 1);
  EXPECT_EQ(last.too_long[0], 1);
  EXPECT_EQ(test.world.counts().bad_messages, 0);
}

TEST(Gateway, WhatItRefusedMayBeSaidAgain) {
  test::TestWorld test(ship_buoy_auv(", delay_s: 1, queue_messages: 1"));
  const auto& gate = test::device_of<devices::Gateway>(test, "buoy/gate");
  test.send("ship.radio.cmd", test::bytes_to("one"));
  test.send("ship.radio.cmd", test::bytes_to("two"));
  test.run_for(2);
  EXPECT_EQ(gate.counts()[0].passed, 1);
  EXPECT_EQ(gate.counts()[0].refused, 1);  // its queue was full
  test.send("ship.radio.cmd", test::bytes_to("two"));
  test.run_for(2);
  EXPECT_EQ(gate.counts()[0].passed, 2);
  test.send("ship.radio.cmd", test::bytes_to("two"));
  test.run_for(2);
  EXPECT_EQ(gate.counts()[0].passed, 2);
  EXPECT_EQ(gate.counts()[0].repeated, 1);
}

TEST(Gateway, TheHashKnowsWhatHasPassed) {
  const auto hash_after = [](const std::string& text) {
    test::TestWorld test(ship_buoy_auv());
    test.send("ship.radio.cmd", test::bytes_to(text));
    test.run_for(5);  // it has passed, and the sound is gone
    devices::Gateway gate = test::device_of<devices::Gateway>(test, "buoy/gate");
    sim::StateArchive archive = sim::StateArchive::hasher();
    archive(gate);
    return archive.hash();
  };
  EXPECT_NE(hash_after("one"), hash_after("two"));
  EXPECT_EQ(hash_after("one"), hash_after("one"));
}

TEST(Gateway, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& between) {
    return test::error_of_world(
        test::modem_sea({{"buoy", "[0, 0, -0.5]", radio + ", {name: gate, type: gateway, between: " + between + "}"}}));
  };
  const auto error_of = [](const std::string& names) {
    return test::error_of_world(ship_buoy_auv(", destinations: " + names));
  };
  EXPECT_EQ(error_of("[ship, auv]"), "");
  EXPECT_NE(error_of("[ship, aux]").find("'destinations' names a vehicle that is not in the world: 'aux'"),
            std::string::npos);
  EXPECT_NE(error_of("[buoy, auv]").find("'destinations' names its own vehicle"), std::string::npos);
  EXPECT_NE(error("[radio]").find("'between' must name two different devices"), std::string::npos);
  EXPECT_NE(error("[radio, radio]").find("'between' must name two different devices"), std::string::npos);
  EXPECT_NE(error("[radio, gate]").find("'between' names no modem or acoustic_modem 'gate'"), std::string::npos);
  EXPECT_NE(error("[radio, none]").find("'between' names no modem or acoustic_modem 'none'"), std::string::npos);
}

}  // namespace
