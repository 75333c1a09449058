// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "experiment/files/csv.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"
#include "verification/fidelity/fidelity_mutations.hpp"

namespace {

using testing::HasSubstr;

const std::string file_of_cases = test_support::source_path("tests/fidelity/cases.yaml");

std::string vehicle_of(const verification::FidelityCase& of) {
  return std::filesystem::path(of.vehicle).stem().string();
}

/// A vehicle of the cases.  Each is a separate test, so that they run in parallel.
class MutationsOf : public testing::TestWithParam<const char*> {};

TEST_P(MutationsOf, EachChangeByFivePercentIsSeenByACaseOrIsListedAsWithoutEffect) {
  verification::FidelityFile file = verification::read_fidelity_file(file_of_cases);
  std::erase_if(file.cases, [](const auto& of) { return vehicle_of(of) != GetParam(); });
  std::ifstream in(test_support::source_path("docs/models/fidelity/coefficients.csv"));
  const std::string table(std::istreambuf_iterator<char>(in), {});
  const auto mutations = verification::mutate_fidelity(file, 0.05, [](const std::string&) {});
  EXPECT_GT(mutations.size(), 20u);
  for (const verification::FidelityMutation& mutation : mutations) {
    EXPECT_EQ(mutation.unseen(), !mutation.without_effect.empty()) << mutation.of.name;
    // The table is made by `shoal fidelity tests/fidelity/cases.yaml --mutate 0.05 --results docs/models`.
    EXPECT_THAT(table, HasSubstr("\n" + mutation.vehicle + "," + experiment::csv_field(mutation.of.name) + "," +
                                 sim::number_text(mutation.of.value) + ","));
  }
}

const char* const vehicles[] = {"remus100", "otter",           "remus_prestero", "bluerov2_heavy",
                                "bluerov2", "otter_autopilot", "drifter",        "glider"};

INSTANTIATE_TEST_SUITE_P(Fidelity, MutationsOf, testing::ValuesIn(vehicles),
                         [](const auto& which) { return std::string(which.param); });

/// Name and value of each coefficient of a vehicle file.
std::set<std::pair<std::string, double>> coefficients_in(verification::FidelityCase of, const std::string& vehicle) {
  of.vehicle = test_support::source_path("vehicles/" + vehicle + ".yaml");
  std::set<std::pair<std::string, double>> found;
  for (const verification::FidelityCoefficient& one : verification::fidelity_coefficients(of))
    found.emplace(one.name, one.value);
  return found;
}

TEST(Mutations, EveryShippedVehicleWithCoefficientsHasCasesOrTheCoefficientsOfOneThatHas) {
  const verification::FidelityCase any = verification::read_fidelity_file(file_of_cases).cases.front();
  std::map<std::string, std::set<std::pair<std::string, double>>> known;
  for (const char* vehicle : vehicles) known[vehicle] = coefficients_in(any, vehicle);
  int others = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test_support::source_path("vehicles"))) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".yaml" || known.contains(name)) continue;
    const sim::VehicleConfig vehicle = sim::load_vehicle(entry.path().string());
    const bool published = std::any_of(vehicle.bodies.begin(), vehicle.bodies.end(), [](const sim::BodyConfig& body) {
      return body.hydrodynamics && body.hydrodynamics->model == sim::HydrodynamicsConfig::Model::coefficients;
    });
    if (!published) continue;
    ++others;
    const auto own = coefficients_in(any, name);
    EXPECT_TRUE(std::any_of(known.begin(), known.end(), [&](const auto& one) { return one.second == own; })) << name;
  }
  EXPECT_GT(others, 3);
}

}  // namespace
