// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/marine_radar.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "shoal/radar_sector_t.hpp"
#include "tests/devices/ranging/ranging_fixture.hpp"

namespace {

using shoal::radar_sector_t;

constexpr double degree = std::numbers::pi / 180;

/// An antenna 5 m above a calm sea that turns once a second, a spoke at each degree.  A report has one turn, with cells
/// of 2 m up to 1024 m and a pulse of 12 m.  `objects`: as in ranging_world().
std::string radar_world(const std::string& keys = "", const std::string& objects = "",
                        const std::string& medium = "{water: {surface_m: -5}}", const std::string& vehicles = "") {
  std::string yaml = test::ranging_world(
      "type: marine_radar, rotation_rpm: 60, spokes: 360, range_max_m: 1024, sea_state: 0" + keys, objects);
  yaml.replace(yaml.find("rate_hz: 100"), 12, "rate_hz: 1");
  if (objects.empty()) yaml.replace(yaml.find("objects:\n"), 9, "objects: []\n");
  return yaml + vehicles + "medium: " + medium + "\n";
}

/// A box that stands in the sea: its front at a range and a bearing counter-clockwise from +x.
std::string target_at(double range_m, double bearing_deg = 0, const std::string& name = "target",
                      const std::string& size_m = "[2, 2, 4]") {
  const double middle_m = range_m + 1;
  return "  - {name: " + name + ", fixed: true, position_m: [" +
         std::to_string(middle_m * std::cos(bearing_deg * degree)) + ", " +
         std::to_string(middle_m * std::sin(bearing_deg * degree)) + ", -5], rpy_deg: [0, 0, " +
         std::to_string(bearing_deg) + "], parts: [{shape: box, size_m: " + size_m + "}]}\n";
}

/// A turn of the truth, by bearing in whole degrees.
class Turn {
 public:
  explicit Turn(radar_sector_t sector) : sector_(std::move(sector)) {}

  const radar_sector_t& sector() const { return sector_; }
  int value(int bearing_deg, int cell) const {
    const int spoke = (360 - bearing_deg) % 360;  // it turns clockwise, and its last spoke is ahead
    return sector_.data[static_cast<std::size_t>((spoke + 359) % 360 * sector_.ncells + cell)];
  }
  int cell_of(double range_m) const {
    return static_cast<int>(range_m / sector_.range_max_m * static_cast<float>(sector_.ncells));
  }
  double level_dBm(int bearing_deg, double range_m) const {
    return sector_.floor_dBm + value(bearing_deg, cell_of(range_m)) * sector_.dB_per_count;
  }

 private:
  radar_sector_t sector_{};
};

Turn turn_of(const std::string& yaml, const std::string& channel = "r1.s.truth") {
  test::TestWorld test(yaml);
  test::Listener<radar_sector_t> sectors(test, channel);
  test.run_for(2);  // the first turn lacks what was reported at its start
  return Turn(sectors.last());
}

/// K sigma / r^4 of the default radar: 4 kW, 4 x 25 degrees: G = 260, 9.41 GHz, losses of 3 dB.
double echo_dBm(double rcs_m2, double range_m) {
  const double wavelength_m = 0.299792458 / 9.41, gain = 260;
  return 10 * std::log10(4e6 * std::pow(gain * wavelength_m, 2) * rcs_m2 /
                         (std::pow(4 * std::numbers::pi, 3) * std::pow(range_m, 4))) -
         3;
}

/// Half of a step of 0.5 dB, and what the finite size of the target and its elevation of half a degree take.
constexpr double level_tolerance_dB = 0.25 + 0.05;

TEST(MarineRadar, SpokesFollowTheAntennaClockwise) {
  test::TestWorld test(radar_world());
  test::Listener<radar_sector_t> sectors(test, "r1.s");
  test.run_for(2);
  const auto sector = sectors.last();
  ASSERT_EQ(sector.nspokes, 360);
  EXPECT_EQ(sector.size, 360 * 512);
  EXPECT_EQ(sector.dB_per_count, 0.5F);
  for (std::size_t i = 0; i < 360; ++i) {
    // Spoke i + 1 of the turn from time 0, in whole microseconds.
    EXPECT_NEAR(sector.time_offsets_us[i], (static_cast<double>(i) + 1) * 1e6 / 360 - 1e6, 1);
    EXPECT_NEAR(sector.azimuths_rad[i], sim::wrap_angle(-(static_cast<double>(i) + 1) * degree), 1e-6);  // float
  }
}

TEST(MarineRadar, SectorsHaveEachSpokeOnce) {
  std::string yaml = radar_world();
  yaml.replace(yaml.find("rate_hz: 1,"), 11, "rate_hz: 7,");
  test::TestWorld test(yaml);
  test::Listener<radar_sector_t> sectors(test, "r1.s");
  test.run_for(3);
  std::int64_t spokes = 0;
  for (const auto& sector : sectors.take_all())
    for (const auto offset_us : sector.time_offsets_us) {
      ++spokes;
      const std::int64_t time_us = sector.utime + offset_us - test.world.epoch_us();
      EXPECT_EQ(time_us, spokes * 1'000'000 / 360);
    }
  EXPECT_GE(spokes, 360 * 2);
}

TEST(MarineRadar, ATargetIsAtItsRangeWithThePowerOfTheRadarEquation) {
  const Turn turn = turn_of(radar_world(", rcs: [{name: target, rcs_m2: 10}]", target_at(500)));
  EXPECT_NEAR(turn.level_dBm(0, 500), echo_dBm(10, 500), level_tolerance_dB);
  // The echo of a pulse of 12 m reaches 6 m to both sides.
  EXPECT_NEAR(turn.level_dBm(0, 497), echo_dBm(10, 500), level_tolerance_dB);
  EXPECT_NEAR(turn.level_dBm(0, 503), echo_dBm(10, 500), level_tolerance_dB);
  const double sea_dBm = turn.level_dBm(40, 500);
  EXPECT_NEAR(turn.level_dBm(0, 492), sea_dBm, 1);
  EXPECT_NEAR(turn.level_dBm(0, 509), sea_dBm, 1);
}

TEST(MarineRadar, WithoutACrossSectionItIsTheProjectedArea) {
  // Above the sea it is 2 m wide and 2 m high; `target_dB` multiplies it.  Its top adds 0.6 % at a grazing angle of 0.3
  // degrees.
  EXPECT_NEAR(turn_of(radar_world("", target_at(500))).level_dBm(0, 500), echo_dBm(4, 500), level_tolerance_dB);
  EXPECT_NEAR(turn_of(radar_world(", target_dB: 10", target_at(500))).level_dBm(0, 500), echo_dBm(40, 500),
              level_tolerance_dB);
}

TEST(MarineRadar, PowerFallsByTwelveDecibelWhenTheDistanceDoubles) {
  const std::string keys = ", rcs: [{name: target, rcs_m2: 100}]";
  const double near_dBm = turn_of(radar_world(keys, target_at(400))).level_dBm(0, 400);
  const double far_dBm = turn_of(radar_world(keys, target_at(800))).level_dBm(0, 800);
  EXPECT_NEAR(near_dBm - far_dBm, 40 * std::log10(2), 2 * level_tolerance_dB);
}

/// Stretches of neighboring bearings from -20 to 20 degrees within 6 dB of the strongest, in the cell of a range.
int blobs_at(const Turn& turn, double range_m) {
  int strongest = 0, blobs = 0;
  for (int bearing = -20; bearing <= 20; ++bearing)
    strongest = std::max(strongest, turn.value((bearing + 360) % 360, turn.cell_of(range_m)));
  bool in_blob = false;
  for (int bearing = -20; bearing <= 20; ++bearing) {
    const bool strong = turn.value((bearing + 360) % 360, turn.cell_of(range_m)) >= strongest - 12;
    if (strong && !in_blob) ++blobs;
    in_blob = strong;
  }
  return blobs;
}

TEST(MarineRadar, ASmallTargetIsSmearedOverTheBeam) {
  const Turn turn = turn_of(radar_world(", rcs: [{name: target, rcs_m2: 100}]", target_at(500)));
  // Both ways the Gaussian beam of 4 degrees has -6.02 dB at 2 degrees and a quarter of that at 1 degree.
  for (const int bearing : {1, 359})
    EXPECT_NEAR(turn.level_dBm(bearing, 500), echo_dBm(100, 500) - 1.505, level_tolerance_dB);
  for (const int bearing : {2, 358})
    EXPECT_NEAR(turn.level_dBm(bearing, 500), echo_dBm(100, 500) - 6.02, level_tolerance_dB);
}

TEST(MarineRadar, TwoTargetsMergeWithinTheBeamAndAreSplitBeyondIt) {
  const auto both = [](double apart_deg) {
    return turn_of(radar_world(", rcs: [{name: left, rcs_m2: 100}, {name: right, rcs_m2: 100}]",
                               target_at(500, apart_deg / 2, "left") + target_at(500, -apart_deg / 2, "right")));
  };
  EXPECT_EQ(blobs_at(both(2), 500), 1);
  EXPECT_EQ(blobs_at(both(10), 500), 2);
}

TEST(MarineRadar, AWallHidesWhatIsBehindItAndTheSeaThere) {
  const std::string wall =
      "  - {name: wall, fixed: true, position_m: [201, 0, 0], parts: [{shape: box, size_m: [2, 200, 40]}]}\n";
  const std::string keys = ", rcs: [{name: target, rcs_m2: 1000}]";
  const Turn open = turn_of(radar_world(keys, target_at(500))),
             hidden = turn_of(radar_world(keys, target_at(500) + wall));
  EXPECT_GT(open.level_dBm(0, 500), -70);
  EXPECT_GT(open.value(0, open.cell_of(400)), 0);  // the sea
  for (const double range_m : {250.0, 400.0, 500.0, 900.0}) EXPECT_EQ(hidden.value(0, hidden.cell_of(range_m)), 0);
  EXPECT_GT(hidden.level_dBm(0, 200), -40);
  EXPECT_EQ(hidden.value(180, hidden.cell_of(400)), open.value(180, open.cell_of(400)));
}

TEST(MarineRadar, AWallThatFillsTheBeamIsLandAsLargeAsItIsSeen) {
  // 20 m above the sea, 600 m wide: at 200 m the two-way beam covers 4 degrees * 0.753 (Gaussian) of it, and all of its
  // height of 5.7 degrees.
  const std::string wall =
      "  - {name: wall, fixed: true, position_m: [201, 0, 0], parts: [{shape: box, size_m: [2, 600, 30]}]}\n";
  const double area_m2 = 200 * 4 * degree * 0.7527 * 20;
  // The gain at its upper edge is 0.7 dB less; the outermost of the rays that meet it stand for a tenth of its height.
  EXPECT_NEAR(turn_of(radar_world("", wall)).level_dBm(0, 200), echo_dBm(area_m2, 200), 0.8);
}

TEST(MarineRadar, NothingIsReceivedFromTheBlindRange) {
  const std::string keys = ", range_min_m: 30, rcs: [{name: target, rcs_m2: 100}]";
  const std::string dry = "{}";
  const Turn truth = turn_of(radar_world(keys, target_at(20), dry));
  EXPECT_TRUE(
      std::all_of(truth.sector().data.begin(), truth.sector().data.end(), [](auto value) { return value == 0; }));
  const Turn report = turn_of(radar_world(keys + ", floor_dBm: -150", target_at(20), dry), "r1.s");
  for (int bearing = 0; bearing < 360; ++bearing) EXPECT_EQ(report.value(bearing, 14), 0);
  int silent = 0;
  for (int bearing = 0; bearing < 360; ++bearing) silent += report.value(bearing, 15) == 0 ? 1 : 0;
  EXPECT_EQ(silent, 0);  // noise of -97 dBm
}

TEST(MarineRadar, TheHorizonHidesWhatIsLow) {
  // 5 m high its horizon is at 9.2 km; at 20 km 6.9 m are hidden.
  const auto seen = [](const std::string& size_m) {
    std::string yaml = radar_world(", range_max_m: 24576, rcs: [{name: target, rcs_m2: 100000}]",
                                   target_at(20000, 0, "target", size_m));
    yaml.replace(yaml.find("range_max_m: 1024, "), 19, "");
    const Turn turn = turn_of(yaml);
    return turn.value(0, turn.cell_of(20000));
  };
  EXPECT_EQ(seen("[2, 20, 12]"), 0);
  EXPECT_GT(seen("[2, 20, 60]"), 0);
}

TEST(MarineRadar, NoiseIsThatOfItsBandAndFigure) {
  const Turn turn = turn_of(radar_world(", floor_dBm: -150", "", "{}"), "r1.s");
  double sum = 0, count = 0;
  for (int bearing = 0; bearing < 360; ++bearing)
    for (int cell = 20; cell < 512; ++cell, ++count)
      sum += std::pow(10, (turn.sector().floor_dBm + turn.value(bearing, cell) * turn.sector().dB_per_count) / 10);
  // k 290 K / 80 ns and 6 dB; its power is exponential.  The steps of 0.5 dB change the mean by 0.06 %.
  const double expected_mW = std::pow(10, (-173.975 + 70.969 + 6) / 10);
  EXPECT_NEAR(sum / count / expected_mW, 1, 4 / std::sqrt(count) + 6e-4);
}

TEST(MarineRadar, MeanOfTheSeaFollowsItsModel) {
  std::string yaml = radar_world(", sea_state: 4, floor_dBm: -150, clutter_shape: 2");
  yaml.replace(yaml.find("sea_state: 0, "), 14, "");
  test::TestWorld test(yaml);
  test::Listener<radar_sector_t> sectors(test, "r1.s");
  test.run_for(5);
  const auto turns = sectors.take_all();
  for (const int cell : {50, 100}) {
    double sum = 0, count = 0;
    for (const auto& turn : turns)
      for (int spoke = 0; spoke < turn.nspokes; ++spoke, ++count)
        sum += std::pow(
            10, (turn.floor_dBm + turn.data[static_cast<std::size_t>(spoke * turn.ncells + cell)] * turn.dB_per_count) /
                    10);
    ASSERT_GE(count, 4 * 360);
    const double range_m = 2 * cell + 1, grazing_rad = std::asin(5 / range_m) - range_m / (2 * 4.0 / 3 * 6.371e6);
    const auto kind = devices::RadarParams::Polarization::horizontal;
    // Twice the beam in 6 columns sums to its Gaussian integral, 0.7527 widths.  The gain is that of its depression.
    const double area_m2 = range_m * 4 * degree * 0.7527 * 11.99 / std::cos(std::asin(5 / range_m));
    const double gain = std::exp2(-2 * std::pow(2 * std::asin(5 / range_m) / (25 * degree), 2));
    const double expected_mW =
        std::pow(10, echo_dBm(devices::sea_reflectivity(grazing_rad, 9.41, 4, kind) * area_m2 * gain, range_m) / 10) +
        std::pow(10, (-173.975 + 70.969 + 6) / 10);
    // The variance of a K distribution of shape 2 is (1 + 2 / 2) squared means; 1 % for steps, columns and constants.
    EXPECT_NEAR(sum / count / expected_mW, 1, 4 * std::sqrt(2 / count) + 0.01) << range_m;
  }
}

TEST(MarineRadar, SpokesTurnWithTheBoatThatYaws) {
  test::TestWorld test(radar_world(", rcs: [{name: target, rcs_m2: 1000}]", target_at(500, 90), "{}"));
  test::Listener<radar_sector_t> sectors(test, "r1.s.truth");
  for (const auto& [name, body] : test.world.find_vehicle("r1")->bodies())
    body->set_velocity_W(sim::Vector3d::Zero(), {0, 0, 30 * degree});
  test.run_for(2);
  const Turn turn(sectors.last());
  // In the second turn the antenna points to 90 degrees when 30 degrees (1 s + t) - 360 degrees t = 90 - 360 degrees:
  // after 10/11 of it, with a yaw of 57.3 degrees.
  double moment = 0, weight = 0;
  for (int bearing = 20; bearing < 46; ++bearing) {
    const double power = std::pow(10, turn.level_dBm(bearing, 500) / 10) - std::pow(10, -11);
    moment += power * bearing;
    weight += power;
  }
  EXPECT_NEAR(moment / weight, 90 - 30 * (1 + 10 / 11.0), 0.1);
}

TEST(MarineRadar, SeesVehiclesAndNothingUnderWater) {
  const std::string boat =
      "  - name: other\n    position_m: [0, 300, -4]\n    model:\n      shoal: 1\n      bodies: [{name: hull, "
      "kinematic: true, parts: [{shape: box, size_m: [4, 2, 2]}]}]\n";
  EXPECT_GT(turn_of(radar_world("", "", "{water: {surface_m: -5}}", boat)).level_dBm(90, 299), -80);
  const Turn under_water = turn_of(radar_world("", "", "{water: {surface_m: 1}}", boat));
  EXPECT_TRUE(std::all_of(under_water.sector().data.begin(), under_water.sector().data.end(),
                          [](auto value) { return value == 0; }));
}

TEST(MarineRadar, GivesTheSameWithAnyNumberOfThreads) {
  const auto data = [](int threads) {
    test::TestWorld test(radar_world(", clutter_shape: 1", target_at(300)));
    test.world.use_threads(threads);
    test::Listener<radar_sector_t> sectors(test, "r1.s");
    test.run_for(1);
    return sectors.last().data;
  };
  const auto once = data(1);
  EXPECT_EQ(once, data(1));
  EXPECT_EQ(once, data(3));
}

TEST(MarineRadar, SaysWhatIsWrongWithItsParameters) {
  using testing::HasSubstr;
  const auto error = [](const std::string& keys) {
    return test::error_of_world(test::ranging_world("type: marine_radar, " + keys, test::wall_at(100)));
  };
  const std::string all =
      error("rotation_rpm: 0, horizontal_deg: 40, sea_state: 7, clutter_shape: 0, polarization: left");
  EXPECT_THAT(all, HasSubstr("'rotation_rpm' must be >= 0.1 and <= 600, got 0"));
  EXPECT_THAT(all, HasSubstr("'horizontal_deg' must be >= 0.1 and <= 30, got 40"));
  EXPECT_THAT(all, HasSubstr("'sea_state' must be >= 0 and <= 6, got 7"));
  EXPECT_THAT(all, HasSubstr("'clutter_shape' must be >= 0.05 and <= 1000, got 0"));
  EXPECT_THAT(all, HasSubstr("'polarization' must be one of: horizontal, vertical; got 'left'"));
  EXPECT_THAT(error("range_min_m: 50, range_max_m: 40"),
              HasSubstr("'range_min_m' must be < range_max_m, got 50 and 40"));
  EXPECT_THAT(error("spokes: 10000, elevation_rays: 100"),
              HasSubstr("must be at most 1000000 rays in a sample, got 10000 x 6 x 100 = 6000000"));
  EXPECT_THAT(error("spokes: 16384, beam_rays: 1, rotation_rpm: 600, range_cells: 8192"),
              HasSubstr("must have at most 4000000 cells, got 13426688"));
  EXPECT_THAT(error("rcs: [{name: ghost, rcs_m2: 1}]"),
              HasSubstr("'rcs' names what is neither a vehicle nor an object: 'ghost'"));
}

}  // namespace
