// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>

#include "devices/navigation/gps.hpp"
#include "shoal/clock_status_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

/// Two floating boxes with a clock each, r1 at the origin and r2 1500 m east of it, in water with its surface at z = 5.
/// `clock1`, `clock2`: maps of YAML.
std::string two_boats(const std::string& clock1, const std::string& clock2, const std::string& devices,
                      const std::string& more = "") {
  std::string text =
      "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nmedium: {water: {surface_m: 5}}\n" + more + "vehicles:\n";
  const std::pair<const char*, std::string> boats[] = {{"r1", clock1}, {"r2", clock2}};
  for (const auto& [name, clock] : boats)
    text += std::string("  - name: ") + name + "\n    position_m: [" + (std::string(name) == "r1" ? "0" : "1500") +
            ", 0, 0]\n    model:\n      shoal: 1\n      vehicle: box\n      clock: " + clock +
            "\n      bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, size_m: [1, 1, 1], "
            "mass_kg: 1}]}]\n      devices:\n" +
            devices;
  return text;
}

const std::string clock_device = "        - {name: clock, type: clock, truth: true, rate_hz: 1, phase_s: 0}\n";
const std::string gps_device =
    "        - {name: gps, type: gps, position_m: [0, 0, 6], rate_hz: 1, phase_s: 0.5, truth: true, disciplines_clock: "
    "true, pps_std_s: 0, min_height_m: 0}\n";

const sim::VehicleClock& clock_of(const test::LoadedTestWorld& test, const std::string& vehicle) {
  return test.world.find_vehicle(vehicle)->clock();
}

TEST(Clock, ReportsItsErrorOnTheTruthChannelOnly) {
  test::TestWorld test(two_boats("{offset_s: 0.25, drift_ppm: 10}", "{}", clock_device));
  test::Listener<shoal::clock_status_t> reports(test, "r1.clock"), truths(test, "r1.clock.truth");
  test.run_for(100.5);
  const auto report = reports.last();
  const auto truth = truths.last();
  EXPECT_TRUE(std::isnan(report.error_s));
  EXPECT_TRUE(std::isnan(report.rate_error));
  EXPECT_FALSE(report.disciplined);
  EXPECT_EQ(report.since_fix_s, -1);
  EXPECT_NEAR(truth.error_s, 0.25 + 10e-6 * 100, 1e-12);
  EXPECT_NEAR(truth.rate_error, 10e-6, 1e-13);
  EXPECT_EQ(truth.utime, test.world.epoch_us() + 100'000'000);
  EXPECT_EQ(report.utime, test.world.epoch_us() + 100'251'000);
}

TEST(Clock, IsSteeredByTheFixesAndCoastsWithoutThem) {
  test::TestWorld test(two_boats("{offset_s: -4, drift_ppm: 3}", "{}", clock_device + gps_device));
  test::Listener<shoal::clock_status_t> reports(test, "r1.clock"), truths(test, "r1.clock.truth");
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps");
  test.run_for(600);
  EXPECT_TRUE(reports.last().disciplined);
  EXPECT_NEAR(truths.last().error_s, 0, 1e-9);
  ASSERT_EQ(test.change("r1/gps", "{min_height_m: 100}"), "");
  test.run_for(1000);
  EXPECT_FALSE(reports.last().disciplined);
  EXPECT_NEAR(truths.last().error_s, 0, 1e-7);  // without its drift of 3 ppm, which would have made 3 ms
  EXPECT_EQ(fixes.last().gps_lock, 0);
}

TEST(Clock, SatellitesReportTheTrueTimeWithAFix) {
  test::TestWorld test(
      two_boats("{offset_s: 7}", "{offset_s: 7}",
                "        - {name: gps, type: gps, position_m: [0, 0, 6], rate_hz: 1, phase_s: 0.5}\n"));
  test::Listener<shoal::gps_data_t> fixes(test, "r1.gps"), none(test, "r2.gps");
  ASSERT_EQ(test.change("r2/gps", "{min_height_m: 100}"), "");
  test.run_for(10);
  for (const auto& fix : fixes.take_all()) EXPECT_NEAR(static_cast<double>(fix.utime) * 1e-6 - fix.gps_time, 7, 1e-6);
  const auto lost = none.last();
  EXPECT_NEAR(static_cast<double>(lost.utime) * 1e-6 - lost.gps_time, 0, 1e-6);
}

TEST(Clock, OneWayTravelTimeIsDistanceOverSoundSpeedAndTheDifferenceOfTheClocks) {
  const std::string modem =
      "        - {name: modem, type: modem, through: acoustic, range_m: 5000, propagation_mps: 1500, data_rate_bps: "
      "800, "
      "truth: true}\n";
  test::TestWorld test(two_boats("{offset_s: 0.2}", "{offset_s: -0.3, drift_ppm: 100}", modem));
  test::Listener<shoal::modem_received_t> reception(test, "r2.modem"), truths(test, "r2.modem.truth");
  test.run_for(10);
  shoal::modem_send_t message{};
  message.size = 10;
  message.data.assign(10, 1);
  test.send("r1.modem.cmd", message);
  test.run_for(5);
  const auto received = reception.last();
  const auto truth = truths.last();
  // 1500 m at 1500 m/s, and 80 bits at 800 bit/s.
  EXPECT_EQ(truth.sent_utime, test.world.epoch_us() + 10'000'000);
  EXPECT_EQ(truth.utime - truth.sent_utime, 1'100'000);
  EXPECT_EQ(received.sent_utime, truth.sent_utime + 200'000);
  // The clock of the receiver has gained 100 us in each of 11.1 s.
  EXPECT_EQ(received.utime - received.sent_utime, 1'100'000 - 500'000 + 1110);
}

TEST(Clock, AStuckSensorContinuesByIt) {
  test::TestWorld test(
      two_boats("{offset_s: 2}", "{}", "        - {name: imu, type: imu, rate_hz: 100, phase_s: 0}\n"));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(1);
  test.world.editor().set_fault("r1/imu", {.kind = sim::FaultKind::stuck});
  test.run_for(1);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 200u);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i].utime, test.world.epoch_us() + 2'000'000 + 10'000 * static_cast<std::int64_t>(i + 1));
}

/// Everything that is published on the channels of the vehicles' devices, in order.
std::map<std::string, std::vector<sim::Bytes>> all_reports(test::LoadedTestWorld& test, double time_s) {
  std::map<std::string, std::unique_ptr<sim::Mailbox>> mailboxes;
  for (const auto& device : test.world.devices())
    if (device->config().device_type->reports())
      for (const std::string& channel : {device->report_channel(), device->report_channel() + ".truth"})
        mailboxes.emplace(channel, test.bus.open_mailbox(channel, 100000));
  test.run_for(time_s);
  std::map<std::string, std::vector<sim::Bytes>> all;
  for (const auto& [channel, mailbox] : mailboxes)
    while (const auto message = mailbox->take()) all[channel].push_back(message->payload);
  return all;
}

/// A world of worlds/ whose vehicles have a clock that is off by `offset_s`.
class WorldOfOffset : public test::LoadedTestWorld {
 public:
  WorldOfOffset(const std::string& file, double offset_s) : LoadedTestWorld(with_clocks(file, offset_s)) {}

 private:
  static sim::LoadedWorld with_clocks(const std::string& file, double offset_s) {
    sim::LoadedWorld loaded = sim::load_world(test_support::source_path("worlds/") + file, with_messages({}));
    for (sim::VehicleInstance& vehicle : loaded.config.vehicles) {
      auto config = std::make_shared<sim::VehicleConfig>(*vehicle.config);
      config->clock = {};
      config->clock.offset_s = offset_s;
      for (sim::DeviceConfig& device : config->devices) stop_discipline(device);  // which would take the offset out
      vehicle.config = config;
    }
    return loaded;
  }
  static void stop_discipline(sim::DeviceConfig& device) {
    using GpsParams = sim::detail::ParamsOf<devices::Gps::Params>;
    if (device.type != "gps") return;
    auto params = std::make_shared<GpsParams>(static_cast<const GpsParams&>(*device.params));
    params->params.disciplines_clock = false;
    device.params = params;
  }
};

TEST(Clock, EveryDeviceStampsItsReportsByTheClockOfItsVehicle) {
  std::set<std::string> types, silent_types;
  for (const char* file : {"proving_ground.yaml", "proving_sea.yaml"}) {
    WorldOfOffset on_time(file, 0), early(file, 1);
    const auto expected = all_reports(on_time, 20);
    const auto reports = all_reports(early, 20);
    for (const auto& device : early.world.devices()) {
      if (!device->config().device_type->reports()) continue;
      const std::string& channel = device->report_channel();
      if (!reports.contains(channel)) continue;
      types.insert(device->config().type);
      ASSERT_TRUE(expected.contains(channel)) << channel;
      const auto& a = expected.at(channel);
      const auto& b = reports.at(channel);
      ASSERT_EQ(a.size(), b.size()) << channel;
      for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_EQ(*sim::utime_of(b[i]) - *sim::utime_of(a[i]), 1'000'000) << channel << " report " << i;
    }
    for (const auto& [channel, payloads] : reports) {
      if (!channel.ends_with(".truth")) continue;
      for (std::size_t i = 0; i < payloads.size(); ++i)
        ASSERT_EQ(sim::utime_of(payloads[i]), sim::utime_of(expected.at(channel)[i])) << channel;
    }
  }
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    if (type->reports() && !types.contains(type->name)) silent_types.insert(type->name);
  EXPECT_THAT(silent_types, testing::IsEmpty());
}

TEST(Clock, ChangesNothingButStamps) {
  const std::string devices = "        - {name: imu, type: imu, preset: stim300, rate_hz: 50}\n" +
                              std::string("        - {name: gps, type: gps, position_m: [0, 0, 6], rate_hz: 5, ") +
                              "horizontal_noise: {gaussian_std: 1}, disciplines_clock: true}\n";
  test::TestWorld without(two_boats("{}", "{}", devices));
  test::TestWorld with(two_boats("{preset: tcxo, offset_s: 3}", "{}", devices));
  const auto expected = all_reports(without, 20);
  auto reports = all_reports(with, 20);
  EXPECT_EQ(reports.at("r2.imu"), expected.at("r2.imu"));
  EXPECT_EQ(reports.at("r2.gps"), expected.at("r2.gps"));
  EXPECT_NE(reports.at("r1.imu"), expected.at("r1.imu"));
  for (std::size_t i = 0; i < expected.at("r1.imu").size(); ++i) {
    sim::Bytes& report = reports.at("r1.imu")[i];
    sim::set_utime(report, *sim::utime_of(expected.at("r1.imu")[i]));
    EXPECT_EQ(report, expected.at("r1.imu")[i]);
  }
  for (const char* vehicle : {"r1", "r2"})
    EXPECT_EQ(with.world.find_vehicle(vehicle)->X_WV().matrix(), without.world.find_vehicle(vehicle)->X_WV().matrix());
}

TEST(Clock, IsPartOfTheStateAndAPerfectOneIsNot) {
  const auto hash = [](const std::string& clock) {
    test::TestWorld test(two_boats(clock, "{}", gps_device));
    test.run_for(30);
    return test.world.state().hash();
  };
  EXPECT_EQ(hash("{preset: tcxo}"), hash("{preset: tcxo}"));
  EXPECT_NE(hash("{preset: tcxo}"), hash("{preset: ocxo}"));
  EXPECT_NE(hash("{preset: tcxo}"), hash("{}"));
  EXPECT_EQ(hash("{preset: perfect}"), hash("{}"));
}

TEST(Clock, OfTwoVehiclesAreIndependent) {
  // What each gains in a second is white noise, one draw after the other.
  test::TestWorld test(two_boats("{white_fm: 1e-9}", "{white_fm: 1e-9}", clock_device));
  constexpr int seconds = 500;
  double product = 0, first = 0, second = 0, before1_s = 0, before2_s = 0;
  for (int i = 0; i < seconds; ++i) {
    test.run_for(1);
    const double gained1_s = clock_of(test, "r1").error_s(test.world.now()) - before1_s;
    const double gained2_s = clock_of(test, "r2").error_s(test.world.now()) - before2_s;
    before1_s += gained1_s;
    before2_s += gained2_s;
    product += gained1_s * gained2_s;
    first += gained1_s * gained1_s;
    second += gained2_s * gained2_s;
  }
  EXPECT_NEAR(product / std::sqrt(first * second), 0, 4 / std::sqrt(seconds));
  EXPECT_NEAR(std::sqrt(first / seconds), 1e-9, 4e-9 / std::sqrt(2.0 * seconds));
}

TEST(Clock, StartsWhenItsVehicleComes) {
  test::TestWorld test(two_boats("{drift_ppm: 100}", "{drift_ppm: 100}", clock_device));
  test.run_for(100);
  test.world.editor().remove_vehicle("r2");
  sim::VehicleInstance again = test.loaded.config.vehicles[1];
  test.world.editor().add_vehicle(again);
  test.run_for(100);
  EXPECT_NEAR(clock_of(test, "r1").error_s(test.world.now()), 0.02, 1e-9);
  EXPECT_NEAR(clock_of(test, "r2").error_s(test.world.now()), 0.01, 1e-9);
}

TEST(Clock, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(two_boats("{update_s: 0}", "{}", clock_device)),
              testing::HasSubstr("'update_s' must be >= 0.01 and <= 3600, got 0"));
  EXPECT_THAT(test::error_of_world(two_boats("{offset_s: .nan}", "{}", clock_device)),
              testing::HasSubstr("'offset_s' must be finite"));
  EXPECT_THAT(test::error_of_world(two_boats("{drift: 1}", "{}", clock_device)),
              testing::HasSubstr("unknown key 'drift'; known keys: drift_ppm, drift_std_ppm, flicker_floor, "));
  EXPECT_THAT(test::error_of_world(two_boats("{}", "{}",
                                             clock_device + gps_device +
                                                 "        - {name: gps2, type: gps, disciplines_clock: "
                                                 "true}\n")),
              testing::HasSubstr("already disciplines the clock of this vehicle"));
}

}  // namespace
