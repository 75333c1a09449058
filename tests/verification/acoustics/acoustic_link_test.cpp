// SPDX-License-Identifier: BSD-3-Clause
#include "verification/acoustics/acoustic_link.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "verification/acoustics/acoustic_closed_forms.hpp"
#include "verification/acoustics/ray_picture.hpp"

namespace {

using sim::AcousticsConfig;
using sim::Decibels;
using sim::Vector3d;
using test_support::ScratchFolder;
using testing::HasSubstr;

sim::Medium sea(double c_mps = 1500, double wind_mps = 5) {
  sim::MediumConfig config;
  config.water.emplace().sound_speed_mps = c_mps;
  config.wind.emplace().velocity_mps = Vector3d(wind_mps, 0, 0);
  return sim::Medium(config, 9.80665, 1);
}

verification::AcousticLink link_over(double range_m) {
  verification::AcousticLink link;
  link.from.p_W = Vector3d(0, 0, -20);
  link.to.p_W = Vector3d(range_m, 0, -20);
  return link;
}

AcousticsConfig thorp() {
  AcousticsConfig config;
  config.absorption.model = sim::AbsorptionConfig::Model::thorp;
  return config;
}

TEST(AcousticLink, HasTheBudgetOfTheReference) {
  // closed_forms.csv acoustic_link: 185 dB, 25 kHz, 4 kHz wide, 1500 m, k 1.5, shipping 0.5, wind 5 m/s.
  const verification::LinkBudget budget = verification::link_budget(link_over(1500), thorp(), sea());
  EXPECT_NEAR((budget.spreading + budget.absorption).dB(), -56.79857654, 1e-6);
  EXPECT_NEAR(budget.snr.dB(), 53.63274597, 0.1);
  EXPECT_DOUBLE_EQ(budget.travel_time_s, 1);
  EXPECT_FALSE(budget.echoes);
}

TEST(AcousticLink, CountsTheDirectionsOfBothEnds) {
  verification::AcousticLink link = link_over(800);
  link.from.directivity.pattern = link.to.directivity.pattern = sim::DirectivityConfig::Pattern::hemisphere;
  // Both look along +x: the sender at the receiver, the receiver away from the sender.
  const verification::LinkBudget budget = verification::link_budget(link, thorp(), sea());
  EXPECT_EQ(budget.from_gain.dB(), 0);
  EXPECT_EQ(budget.to_gain.dB(), -30);
  // Half of the noise is received, and a thousandth of the other half.
  EXPECT_NEAR((verification::link_budget(link_over(800), thorp(), sea()).noise - budget.noise).dB(),
              -10 * std::log10(0.5 * 1.001), 1e-6);
  link.to.R_WS = Eigen::AngleAxisd(3.14159265358979, Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_EQ(verification::link_budget(link, thorp(), sea()).to_gain.dB(), 0);
}

TEST(AcousticLink, DeliversByTheBitErrorsWithoutFading) {
  verification::AcousticLink link = link_over(100);
  link.detection = Decibels(-100);
  const verification::LinkBudget at_185 = verification::link_budget(link, thorp(), sea());
  // A level at which Eb/N0 is 10 dB: the reference's 0.4215 for 32 bytes of FSK.
  const verification::AcousticPacket packet = *verification::parse_packet("fsk:80:32");
  link.source_level += Decibels(10 - 10 * std::log10(4000.0 / 80)) - at_185.snr;
  EXPECT_NEAR(verification::delivery_probability(link, packet, thorp(), sea()), 0.4215093644, 1e-6);
  link.detection = Decibels(6);
  EXPECT_EQ(verification::delivery_probability(link, packet, thorp(), sea()), 0) << "10 dB less 17 dB is not noticed";
}

TEST(AcousticLink, RayleighFadingCostsTheShareOfDeepFades) {
  verification::AcousticLink link = link_over(1000);
  const verification::LinkBudget at_185 = verification::link_budget(link, thorp(), sea());
  link.source_level += Decibels(16) - at_185.snr;
  AcousticsConfig config = thorp();
  config.fading.type = sim::FadingConfig::Type::rayleigh;
  // One bit more or less comes through always: what is lost is what fades by 10 dB and more below the detection.
  const double lost =
      1 - verification::delivery_probability(link, *verification::parse_packet("psk:80:1"), config, sea());
  const double expected = 1 - std::exp(-0.1);
  EXPECT_NEAR(lost, expected, 4 * std::sqrt(expected / 2000));
}

TEST(AcousticLink, EchoesHelpInsideTheWindowAndDisturbAfterIt) {
  AcousticsConfig config = thorp();
  config.multipath.emplace().surface_loss_dB = 0;
  config.multipath->max_bounces = 1;
  config.spreading.factor = 2;
  verification::AcousticLink link = link_over(40);
  config.absorption = {sim::AbsorptionConfig::Model::constant, 0, 8};
  // The surface path is hypot(40, 40) m: 16.569 m and 11.046 ms later, 3.01 dB weaker.
  config.multipath->window_s = 0.012;
  const verification::LinkBudget helped = verification::link_budget(link, config, sea());
  EXPECT_NEAR(helped.echoes->dB(), 10 * std::log10(1.5), 1e-9);
  EXPECT_EQ(helped.late->dB(), -HUGE_VAL);
  config.multipath->window_s = 0.011;
  const verification::LinkBudget hurt = verification::link_budget(link, config, sea());
  EXPECT_NEAR(hurt.echoes->dB(), 0, 1e-12);
  EXPECT_NEAR((hurt.level - *hurt.late).dB(), 10 * std::log10(2.0), 1e-9);
  // rms of two arrivals of shares 2/3 and 1/3: sqrt(2)/3 of the time between them.
  EXPECT_NEAR(hurt.delay_spread_s, std::sqrt(2.0) / 3 * (std::sqrt(2.0) - 1) * 40 / 1500, 1e-9);
  EXPECT_LT(verification::delivery_probability(link, *verification::parse_packet("psk:4000:64"), config, sea()), 0.01)
      << "3 dB over its own echo is below the 6 dB that are needed";
}

TEST(AcousticLink, WordsOfAPacketAreRead) {
  const auto packet = verification::parse_packet("psk:500.5:64");
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->modulation, sim::Modulation::psk);
  EXPECT_EQ(packet->bit_rate_bps, 500.5);
  EXPECT_EQ(packet->bytes, 64);
  EXPECT_EQ(packet->name, "psk_500.5_64");
  for (const char* wrong :
       {"", "fsk", "fsk:80", "ask:80:32", "fsk:0:32", "fsk:-1:32", "fsk:nan:32", "fsk:80:32:1", "fsk:80:x", "fsk:80:-3",
        "fsk::32", "fsk:80:", "fsk:1e99:32", "fsk:80:99999999999999999999"})
    EXPECT_FALSE(verification::parse_packet(wrong)) << wrong;
}

TEST(AcousticLink, TableOverRangeFallsAndKeepsTheDepths) {
  verification::AcousticLink link = link_over(500);
  link.to.p_W.z() = -320;
  const std::vector<verification::AcousticPacket> packets = verification::micromodem_packets();
  const auto rows = verification::over_range(link, packets, {100, 300, 1000, 4000, 9000}, thorp(), sea());
  ASSERT_EQ(rows.size(), 4u) << "100 m are less than the 300 m between the depths";
  EXPECT_NEAR(rows[0].budget.range_m, 300, 1e-9);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_LT(rows[i].budget.snr, rows[i - 1].budget.snr);
    for (std::size_t p = 0; p < packets.size(); ++p) EXPECT_LE(rows[i].delivered[p], rows[i - 1].delivered[p]);
  }
  const std::string csv = verification::csv_text(rows, packets);
  EXPECT_THAT(csv, testing::StartsWith("range_m,travel_time_s,level_dB,noise_dB,snr_dB,delivered_fsk_80_32,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), 5 * (4 + 7));
}

TEST(AcousticLink, SaysWhichPhasesItsEchoesHaveAndTheRatioWithThem) {
  AcousticsConfig config = thorp();
  config.multipath.emplace();
  config.multipath->water_depth_m = 100;
  for (const auto& [phases, text] : {std::pair{sim::MultipathConfig::Phases::random, "phases averaged;"},
                                     {sim::MultipathConfig::Phases::geometric, "phases of the paths;"}}) {
    config.multipath->phases = phases;
    const auto rows = verification::over_range(link_over(500), {}, {500}, config, sea());
    const std::string budget = verification::budget_text(link_over(500), rows.at(0).budget, config);
    EXPECT_THAT(budget, HasSubstr(text));
    const std::string csv = verification::csv_text(rows, {});
    EXPECT_THAT(csv, testing::StartsWith("range_m,travel_time_s,level_dB,noise_dB,snr_dB,snr_with_echoes_dB\n"));
    // The budget has the same number, rounded to 0.1 dB.
    const std::size_t row = budget.find("signal over noise, echoes") + 25;
    EXPECT_NEAR(std::stod(csv.substr(csv.rfind(',') + 1)), std::stod(budget.substr(row)), 0.051);
  }
}

TEST(AcousticLink, DrawsAnImage) {
  const ScratchFolder folder;
  const std::vector<verification::AcousticPacket> packets{*verification::parse_packet("fsk:80:32")};
  const auto rows = verification::over_range(link_over(500), packets, {100, 500, 2000}, thorp(), sea());
  verification::draw_over_range(rows, packets, "it's a 'title'; exit", folder.file("link.png"));
  std::ifstream in(folder.file("link.png"), std::ios::binary);
  char head[4] = {};
  in.read(head, 4);
  EXPECT_EQ(std::string(head + 1, 3), "PNG");
}

TEST(AcousticClosedForms, AllHold) {
  const auto rows =
      verification::acoustic_closed_forms(test_support::source_path("tests/fidelity/reference/closed_forms.csv"));
  EXPECT_EQ(rows.size(), 48u);
  for (const verification::ClosedFormRow& row : rows)
    EXPECT_TRUE(row.within()) << row.name << " " << row.parameters << ": " << row.computed;
}

TEST(AcousticClosedForms, SayWhichRowIsWrong) {
  const ScratchFolder folder;
  const std::string file = folder.file("forms.csv");
  const auto error_of = [&](const std::string& row) -> std::string {
    std::ofstream(file) << "case,parameters,quantity,expected,unit,tolerance,tol_kind,note\n" << row << "\n";
    try {
      verification::acoustic_closed_forms(file);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of("absorption_thorp,f_kHz=1,alpha,0.069,dB/km,0.001,rel,"), "");
  EXPECT_THAT(error_of("absorption_thorp,f=1,alpha,0.069,dB/km,0.001,rel,"), HasSubstr(":2: no closed form of"));
  EXPECT_THAT(error_of("absorption_thorp,f_kHz=x,alpha,0.069,dB/km,0.001,rel,"), HasSubstr(":2: no closed form of"));
  EXPECT_THAT(error_of("absorption_thorp,f_kHz=1,alpha"), HasSubstr(":2: no closed form of"));
  EXPECT_THAT(error_of("spar_cylinder,d=1,T,2,s,1,abs,"), HasSubstr("no closed forms about sound"));
  std::filesystem::remove(file);
  EXPECT_THROW(verification::acoustic_closed_forms(file), std::runtime_error);
}

TEST(AcousticClosedForms, OneThatIsOffIsMarked) {
  const ScratchFolder folder;
  std::ofstream(folder.file("forms.csv")) << "header\nabsorption_thorp,f_kHz=1,alpha,0.07,dB/km,0.001,rel,\n";
  const auto rows = verification::acoustic_closed_forms(folder.file("forms.csv"));
  EXPECT_FALSE(rows.at(0).within());
  EXPECT_THAT(verification::closed_forms_text(rows), HasSubstr("FAILS"));
}

/// A mixed layer over a thermocline, with the speeds of the reference.
sim::Medium thermocline() {
  sim::MediumConfig config;
  auto& profile = config.water.emplace().profile;
  for (const auto& [depth_m, speed_mps] : {std::pair{0.0, 1515.80}, {20, 1516.12}, {40, 1483.07}, {200, 1485.68}})
    profile.push_back({depth_m, 8, 35, {}, speed_mps});
  return sim::Medium(config, 9.80665, 1);
}

verification::AcousticLink to_50_m(double range_m) {
  verification::AcousticLink link;
  link.from.p_W = Vector3d(0, 0, -1);
  link.to.p_W = Vector3d(range_m, 0, -50);
  return link;
}

TEST(AcousticLink, FollowsTheRayOfAThermocline) {
  AcousticsConfig config = thorp();
  const verification::LinkBudget budget = verification::link_budget(to_50_m(1000), config, thermocline());
  EXPECT_TRUE(budget.bent);
  EXPECT_FALSE(budget.shadow);
  EXPECT_NEAR(budget.travel_time_s, 0.66303492, 2e-7);  // by BELLHOP, as the loss
  EXPECT_NEAR(-budget.spreading.dB(), 69.26, 0.03);
  EXPECT_NEAR(budget.arrival_rad * 180 / std::numbers::pi, -12.011, 0.01);
  config.propagation = sim::SoundPaths::straight;
  EXPECT_FALSE(verification::link_budget(to_50_m(1000), config, thermocline()).bent);
}

TEST(AcousticLink, SaysThatNoRayReachesAShadow) {
  AcousticsConfig config = thorp();
  const verification::LinkBudget dark = verification::link_budget(to_50_m(2300), config, thermocline());
  EXPECT_TRUE(dark.shadow);
  EXPECT_EQ(dark.level.dB(), -HUGE_VAL);
  EXPECT_THAT(verification::budget_text(to_50_m(2300), dark, config), HasSubstr("in a shadow: no ray arrives"));
  EXPECT_THAT(verification::budget_text(to_50_m(2300), dark, config), Not(HasSubstr("travel time")));
  const auto rows = verification::over_range(to_50_m(2300), {}, {2300}, config, thermocline());
  EXPECT_THAT(verification::csv_text(rows, {}), HasSubstr("\n2300,nan,-inf,"));
  config.shadow_loss_dB = 20;
  EXPECT_GT(verification::link_budget(to_50_m(2300), config, thermocline()).level.dB(), 50);
}

TEST(RayField, ShadowsBeginWhereTheLastRayGrazes) {
  // 1897 m to the bottom of the mixed layer, and 238 m from there to 50 m: 2135 m.
  const verification::RayField field = verification::ray_field(1, 2400, 25000, thorp(), thermocline(), {});
  const double row_m = field.deepest_m / field.rows;
  double first_dark_m = 0;
  for (const verification::RayField::Point& point : field.points)
    if (std::abs(point.depth_m - 50) < 0.51 * row_m && point.shadow && first_dark_m == 0) first_dark_m = point.range_m;
  EXPECT_NEAR(first_dark_m, 2135, 30);
  ASSERT_FALSE(field.fan.empty());
  for (const sim::RayTrace& ray : field.fan) EXPECT_NEAR(ray.depth_m.at(0), 1, 1e-9);
  const ScratchFolder folder;
  verification::draw_rays(field, "rays", folder.file("rays.png"));
  EXPECT_GT(std::filesystem::file_size(folder.file("rays.png")), 10000u);
}

}  // namespace
