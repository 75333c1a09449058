// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/verification/acoustics/links_in_the_sea.hpp"
#include "verification/acoustics/acoustic_closed_forms.hpp"
#include "verification/acoustics/acoustic_link.hpp"
#include "verification/acoustics/ray_picture.hpp"

namespace {

using namespace links_in_the_sea;

using sim::AcousticsConfig;
using test_support::ScratchFolder;
using testing::HasSubstr;

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

}  // namespace
