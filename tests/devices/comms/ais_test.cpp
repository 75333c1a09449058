// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>

#include "shoal/ais_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using shoal::ais_t;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180, knot = 1852.0 / 3600;

struct Station {
  double x_m = 0;
  std::string keys = {};
  double height_m = 10;
};

/// Weightless boxes called a to z, s26, s27 ... side by side, with an AIS each, above water at 0.
std::string stations(const std::vector<Station>& all, const std::string& more = "") {
  std::string text = "shoal: 1\nphysics: {step_s: 0.02, gravity_mps2: 0}\nmedium: {water: {}}\nvehicles:\n";
  for (const Station& station : all) {
    const auto number = static_cast<std::size_t>(&station - all.data());
    const std::string id =
        number < 26 ? std::string(1, "abcdefghijklmnopqrstuvwxyz"[number]) : "s" + std::to_string(number);
    text += "  - {name: " + id + ", position_m: [" + std::to_string(station.x_m) + ", " + std::to_string(2 * number) +
            ", " + std::to_string(station.height_m) + "], model: {shoal: 1, vehicle: " + id +
            ", bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: "
            "1}]}], devices: [{name: ais, type: ais, rate_hz: 5, " +
            station.keys + "}]}}\n";
  }
  return text + more;
}

void set_velocity(test::LoadedTestWorld& test, const std::string& vehicle, const sim::Vector3d& v_W) {
  for (const auto& [name, body] : test.world.find_vehicle(vehicle)->bodies())
    body->set_velocity_W(v_W, sim::Vector3d::Zero());
}

/// What a station publishes within a time.
std::vector<ais_t> messages_at(test::LoadedTestWorld& test, const std::string& vehicle, double time_s) {
  test::Listener<ais_t> listener(test, vehicle + ".ais");
  test.run_for(time_s);
  return listener.take_all();
}

std::vector<ais_t> of_type(const std::vector<ais_t>& all, int type, bool own) {
  std::vector<ais_t> some;
  for (const ais_t& message : all)
    if (message.type == type && (message.own != 0) == own) some.push_back(message);
  return some;
}

TEST(Ais, AShipIsReceivedWithItsPositionCourseAndName) {
  test::TestWorld test(
      stations({{0,
                 "ship_name: NORDIC, call_sign: LA1, ship_type: 70, dimensions_m: [90, 10, 7, 8], mmsi: "
                 "257000001"},
                {1000, "station: receiver"}},
               "origin: {latitude_deg: 60, longitude_deg: 5}\n"));
  set_velocity(test, "a", {3, 4, 0});
  const auto all = messages_at(test, "b", 30);
  const auto positions = of_type(all, 1, false);
  ASSERT_GE(positions.size(), 2u);
  const ais_t& position = positions.front();
  EXPECT_EQ(position.mmsi, 257'000'001);
  EXPECT_NEAR(position.speed_mps, 5, 0.05 * knot + 1e-9);
  EXPECT_NEAR(position.course_rad, std::atan2(3, 4), 0.06 * degree);  // to the north-east; tenths of a degree
  EXPECT_NEAR(position.heading_rad, 90 * degree, 1e-9);               // it looks east
  EXPECT_NEAR(position.latitude, 60, 0.002);
  EXPECT_NEAR(position.longitude, 5, 0.003);
  // 1/10000 of a minute.
  EXPECT_NEAR(std::remainder(position.latitude * 600'000, 1), 0, 1e-4);
  const auto names = of_type(all, 5, false);
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(names[0].name, "NORDIC");
  EXPECT_EQ(names[0].call_sign, "LA1");
  EXPECT_EQ(names[0].ship_type, 70);
  EXPECT_EQ(names[0].bow_m, 90);
  EXPECT_EQ(names[0].starboard_m, 8);
}

TEST(Ais, AReceiverTransmitsNothing) {
  test::TestWorld test(stations({{0, "station: receiver"}, {1000, "station: receiver"}}));
  EXPECT_TRUE(messages_at(test, "a", 60).empty());
}

TEST(Ais, IntervalsFollowTheSpeedAndChannelsAlternate) {
  // 10 knots: 10 s, with a tenth to each side.  16 knots: 6 s.
  for (const auto& [knots, interval_s] : {std::pair{10.0, 10.0}, std::pair{16.0, 6.0}}) {
    test::TestWorld test(stations({{0}}));
    set_velocity(test, "a", {knots * knot, 0, 0});
    const auto own = of_type(messages_at(test, "a", 300), 1, true);
    // A second of the run is without a fix of the speed at most.
    EXPECT_NEAR(static_cast<double>(own.size()), 300 / interval_s, 0.1 * 300 / interval_s + 2);
    for (std::size_t i = 2; i < own.size(); ++i)
      EXPECT_NEAR(static_cast<double>(own[i].utime - own[i - 1].utime) * 1e-6, interval_s, 0.11 * interval_s);
  }
  test::TestWorld test(stations({{0}}));
  std::map<int, int> channels;
  for (const ais_t& message : messages_at(test, "a", 300)) ++channels[message.radio_channel];
  EXPECT_NEAR(channels[0], channels[1], 1);
}

TEST(Ais, ClassBSendsItsNameInTwoParts) {
  test::TestWorld test(stations({{0, "station: class_b, call_sign: XY"}, {1000, "station: receiver"}}));
  const auto all = messages_at(test, "b", 60);
  EXPECT_FALSE(of_type(all, 18, false).empty());
  const auto parts = of_type(all, 24, false);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "a");  // that of the vehicle
  EXPECT_EQ(parts[1].part, 1);
  EXPECT_EQ(parts[1].call_sign, "XY");
}

TEST(Ais, IsReceivedWithinTheRadioHorizonAndTheRange) {
  // sqrt(2 4/3 6371 km 10 m) = 13.03 km from each antenna at 10 m.
  for (const auto& [distance_m, range_m, heard] :
       {std::tuple{26'000.0, 75e3, true}, std::tuple{26'200.0, 75e3, false}, std::tuple{5000.0, 4e3, false}}) {
    test::TestWorld test(stations({{0}, {distance_m, "station: receiver, range_m: " + std::to_string(range_m)}}));
    EXPECT_EQ(!messages_at(test, "b", 30).empty(), heard) << distance_m;
  }
  // Under water there is none.
  test::TestWorld test(stations({{0, "", -2}, {100, "station: receiver"}}));
  EXPECT_TRUE(messages_at(test, "b", 30).empty());
}

TEST(Ais, ZonesAndFaultsSilenceIt) {
  const std::string zone =
      "zones: [{name: no_radio, shape: box, position_m: [0, 0, 0], size_m: [10, 10, 100], radio_denied: true}]\n";
  test::TestWorld denied(stations({{0}, {1000, "station: receiver"}}, zone));
  EXPECT_TRUE(messages_at(denied, "b", 30).empty());
  test::TestWorld silent(stations({{0}, {1000, "station: receiver"}},
                                  "events: [{name: off, at: 0, do: [{fault: {device: a/ais, kind: silent}}]}]\n"));
  silent.run_for(1);
  EXPECT_TRUE(messages_at(silent, "b", 30).empty());
}

TEST(Ais, WithoutAFixThePositionIsNotAvailable) {
  test::TestWorld test(stations({{0}},
                                "zones: [{name: jammed, shape: box, position_m: [0, 0, 0], size_m: [10, 10, 100], "
                                "gps_denied: true}]\n"));
  const auto own = of_type(messages_at(test, "a", 30), 1, true);
  ASSERT_FALSE(own.empty());
  EXPECT_TRUE(std::isnan(own[0].latitude));
  EXPECT_TRUE(std::isnan(own[0].speed_mps));
  EXPECT_FALSE(std::isnan(own[0].heading_rad));
}

/// A receiver amid stations that receive each other.
std::string crowd(int count) {
  std::vector<Station> all{{0, "station: receiver"}};
  for (int i = 0; i < count; ++i) all.push_back({1000.0 + 10 * i, "range_m: 75e3"});
  return stations(all);
}

TEST(Ais, StationsThatHearEachOtherAvoidTheSlotsThatAreAnnounced) {
  test::TestWorld test(crowd(30));
  for (const auto& vehicle : test.world.vehicles()) set_velocity(test, vehicle->name(), {0, 24 * knot, 0});
  test.run_for(30);  // all have announced a slot
  const auto all = messages_at(test, "a", 60);
  // 30 stations, 30 positions a minute each.  Chance alone would lose 900 / 4500 = 20 %: 720 would be left.
  EXPECT_GT(of_type(all, 1, false).size(), 840u);
}

TEST(Ais, OfTwoInOneSlotTheStrongerIsReceivedIfItIsTenDecibelStronger) {
  // A receiver between stations that are beyond each other's horizon, 18.4 km for antennas at 5 m, and so collide.
  const auto share = [](double near_m, double far_m) {
    std::vector<Station> all{{0, "station: receiver", 5}};
    for (int i = 0; i < 15; ++i) all.push_back({-near_m, "", 5});
    for (int i = 0; i < 15; ++i) all.push_back({far_m, "", 5});
    test::TestWorld test(stations(all));
    for (const auto& vehicle : test.world.vehicles())
      if (vehicle->name() != "a") set_velocity(test, vehicle->name(), {0, 24 * knot, 0});
    test.run_for(20);
    std::map<bool, int> received;
    for (const ais_t& message : of_type(messages_at(test, "a", 40), 1, false))
      ++received[message.mmsi < 200'000'000 + 16];
    return received;
  };
  // 15 stations a side, 20 positions each in 40 s: 300, of which another is in the slot and channel of
  // 300 / (1500 * 2) = 10 %: 270 are left, with a standard deviation of 5.
  auto equal = share(15e3, 15e3);
  EXPECT_LT(equal[true], 288);
  EXPECT_LT(equal[false], 288);
  auto captured = share(4e3, 16e3);  // 12 dB
  EXPECT_GT(captured[true], 288);
  EXPECT_LT(captured[false], 288);
}

TEST(Ais, LosesTheShareOfMessagesAskedFor) {
  test::TestWorld test(stations({{0}, {1000, "station: receiver, loss_probability: 0.5"}}));
  set_velocity(test, "a", {0, -24 * knot, 0});
  const auto received = of_type(messages_at(test, "b", 400), 1, false);
  // 200 messages: 100 with a standard deviation of 7.
  EXPECT_NEAR(static_cast<double>(received.size()), 100, 28);
}

TEST(Ais, NoiseOfItsPositionHasTheSpreadAskedFor) {
  test::TestWorld test(stations({{0, "horizontal_noise: {gaussian_std: 5}"}}, "origin: {latitude_deg: 0}\n"));
  std::vector<double> north_m;
  for (const ais_t& message : of_type(messages_at(test, "a", 2000), 1, true))
    if (!std::isnan(message.latitude)) north_m.push_back(message.latitude * 110'574);  // m per degree at the equator
  const auto [mean, std, count] = test::statistics(north_m);
  EXPECT_NEAR(mean, 0, 4 * 5 / std::sqrt(count));
  EXPECT_NEAR(std, 5, 4 * 5 / std::sqrt(2 * count));
}

TEST(Ais, ContinuesAlikeFromASnapshot) {
  test::TestWorld test(crowd(5));
  test.run_for(33.3);
  const auto snapshot = test.world.state().snapshot();
  const auto expected = messages_at(test, "a", 30).size();
  const auto hash = test.world.state().run_hash();
  test.world.state().restore(snapshot);
  EXPECT_EQ(messages_at(test, "a", 30).size(), expected);
  EXPECT_EQ(test.world.state().run_hash(), hash);
}

TEST(Ais, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(stations({{0, "mmsi: -1"}})), HasSubstr("'mmsi' must be >= 0 and <= 999999999"));
  EXPECT_THAT(test::error_of_world(stations({{0, "dimensions_m: [1, 2]"}})),
              HasSubstr("'dimensions_m' must be four numbers"));
  EXPECT_THAT(test::error_of_world(stations({{0, "mmsi: 7"}, {9, "mmsi: 7"}})),
              HasSubstr("'mmsi' must be unique: 'a/ais' has 7, too"));
}

}  // namespace
