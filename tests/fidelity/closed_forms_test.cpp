// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fidelity/closed_forms.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>

#include "tests/project_paths.hpp"

// Each row of closed_forms.csv about water and what is in it is compared with something by some test.

namespace {

namespace fs = std::filesystem;
using test::ClosedForm;

const std::vector<std::string> cases_of_the_sea = {
    "sphere_immersed_volume",
    "floating_.*",
    "spar_cylinder",
    "capsule_.*",
    "falling_sphere",
    "quadratic_coast",
    "linear_coast",
    "thrust_accel_quadratic",
    "submerged_roll_period",
    "prolate_spheroid_added_mass",
    "munk_moment",
    "added_mass_coriolis",
    "passive_drift_linear",
    "gauss_markov",
    "current_.*",
    "deep_water_wave",
    "finite_depth_wave",
    "pierson_moskowitz",
    "jonswap",
    "sound_speed_.*",
    "absorption_thorp",
    "ambient_noise_wenz_coates",
    "acoustic_link",
    "one_way_travel_time",
    "ber_.*",
    "packet_success_bfsk",
    "micromodem_packet_time",
    "hydrostatic_pressure",
    "gps_gauss_markov",
};

bool is_of_the_sea(const ClosedForm& form) {
  return std::any_of(cases_of_the_sea.begin(), cases_of_the_sea.end(),
                     [&](const std::string& name) { return std::regex_match(form.name, std::regex(name)); });
}

/// A mention of rows in the source of a test: case, part of the parameters, quantity.  What is empty stands for all.
struct Mention {
  std::string name, parameters, quantity;
  bool covers(const ClosedForm& form) const {
    return form.name == name && (quantity.empty() || form.quantity == quantity) &&
           form.parameters.find(parameters) != std::string::npos;
  }
};

std::vector<Mention> mentions_in(const std::string& source) {
  static const std::regex in_a_row("\"(\\w+)\",\\s*(?:\"([^\"]*)\",\\s*)?\"(\\w+)\"");
  static const std::regex all_rows("closed_forms_of\\(\"(\\w+)\"(?:,\\s*\"(\\w+)\")?\\)");
  std::vector<Mention> mentions;
  const std::sregex_iterator end;
  for (std::sregex_iterator it(source.begin(), source.end(), in_a_row); it != end; ++it)
    mentions.push_back({(*it)[1], (*it)[2], (*it)[3]});
  for (std::sregex_iterator it(source.begin(), source.end(), all_rows); it != end; ++it)
    mentions.push_back({(*it)[1], "", (*it)[2]});
  return mentions;
}

TEST(ClosedForms, EveryRowAboutWaterIsUsedByATest) {
  std::vector<Mention> mentions;
  for (const auto& entry : fs::recursive_directory_iterator(test_support::source_path("tests"))) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
    std::ifstream in(entry.path());
    const std::string source{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (source.find("closed_form") == std::string::npos) continue;
    for (const Mention& mention : mentions_in(source)) mentions.push_back(mention);
  }
  int rows = 0;
  for (const ClosedForm& form : test::all_closed_forms()) {
    if (!is_of_the_sea(form)) continue;
    ++rows;
    EXPECT_TRUE(std::any_of(mentions.begin(), mentions.end(), [&](const Mention& each) { return each.covers(form); }))
        << form.name << " " << form.parameters << " " << form.quantity << " is used by no test";
  }
  EXPECT_GE(rows, 111);
}

}  // namespace
