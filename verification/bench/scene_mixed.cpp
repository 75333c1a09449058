// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "verification/bench/marine_helpers.hpp"
#include "verification/bench/rover_arena.hpp"

namespace verification {

namespace {

/// Numbers of vehicles by kind: of ten, four rovers, two REMUS, one that localizes itself, one Otter, the rest naive.
struct MixedFleet {
  explicit MixedFleet(int vehicles)
      : rovers(vehicles * 4 / 10), remus(vehicles * 2 / 10), nav(vehicles / 10), otters(vehicles / 10) {
    naive = vehicles - rovers - remus - nav - otters;
  }
  int rovers, remus, nav, otters, naive;
};

std::string mixed_entry(const char* name, int count, const std::string& position, double spacing_m,
                        const std::string& vehicle) {
  if (count == 0) return {};
  return fmt::format(
      "  - name: {}\n    count: {}\n    position_m: {}\n    placement: {{pattern: grid, spacing_m: {}, random_yaw: "
      "true}}\n    {}\n",
      name, count, position, spacing_m, vehicle);
}

double mixed_grid_m(int count, double spacing_m) {
  return std::ceil(std::sqrt(std::max(1, count))) * spacing_m;
}

/// Deck on piles with a wall around it, for the rovers; its top is 2 m above the water.
std::string mixed_deck(double side_m) {
  std::string text = fmt::format(
      "  - name: deck\n    fixed: true\n    parts:\n      - {{shape: box, size_m: [{0}, {0}, 0.5], "
      "position_m: [0, 0, 1.75]}}\n",
      side_m + 0.2);
  for (const int sign : {1, -1}) {
    text += fmt::format("      - {{shape: box, size_m: [0.1, {}, 0.5], position_m: [{}, 0, 2.25]}}\n", side_m + 0.2,
                        sign * (side_m / 2 + 0.05));
    text += fmt::format("      - {{shape: box, size_m: [{}, 0.1, 0.5], position_m: [0, {}, 2.25]}}\n", side_m,
                        sign * (side_m / 2 + 0.05));
  }
  return text;
}

std::string mixed_text(int vehicles) {
  const MixedFleet fleet(vehicles);
  const double deck_m = mixed_grid_m(fleet.rovers, 2);
  const double boats_m = deck_m / 2 + mixed_grid_m(fleet.otters, 10) / 2 + 10;  // south of the deck
  return "shoal: 1\nname: mixed\n"
         "physics: {step_s: 0.01, quick_above_rows: 40, quick_iterations: 10, max_contacts_per_pair: 4}\n"
         "medium:\n  water: {}\n  current: [{velocity_mps: [0.2, 0.1, 0]}]\n"
         "  waves: {type: jonswap, hs_m: 0.3, tp_s: 4, components: 50, spreading: 4}\nobjects:\n"
         "  - {name: bottom, fixed: true, position_m: [0, 0, -60], parts: [{shape: plane}]}\n" +
         mixed_deck(deck_m) + "vehicles:\n" +
         mixed_entry("rover", fleet.rovers, "[0, 0, 2]", 2, "model:" + rover_model_text("[0.24, 0, 0.04]")) +
         mixed_entry("auv", fleet.remus, "[0, 0, -20]", 5, "file: remus100_fleet.yaml") +
         mixed_entry("nav", fleet.nav, "[0, 0, -30]", 20, "file: remus100_nav.yaml") +
         mixed_entry("otter", fleet.otters, fmt::format("[0, {}, 0]", -boats_m), 10, "file: otter.yaml") +
         mixed_entry("naive", fleet.naive, "[0, 0, -45]", 5, "file: naive_auv.yaml");
}

void set_off_mixed(const sim::Vehicle& vehicle, int index, sim::Bus& bus) {
  const std::string& model = vehicle.config().vehicle;
  if (model == "remus100_fleet") set_off_remus(vehicle, index, bus);
  if (model == "remus100_nav") set_off_autopilot(vehicle, index, bus);
  if (model == "otter") set_off_otter(vehicle, index, bus);
}

class MixedPrograms final : public ScenePrograms {
 public:
  MixedPrograms(const sim::World& world, sim::Bus& bus)
      : rovers_(wanderers(world, bus)), start_(world, bus, set_off_mixed), talkers_(world, bus) {}
  void think(sim::Time now) override {
    rovers_->think(now);
    start_.think(now);
    talkers_.think(now);
  }

 private:
  std::unique_ptr<ScenePrograms> rovers_;
  StartCommands start_;
  Talkers talkers_;
};

}  // namespace

BenchScene mixed_scene() {
  return {"mixed",
          "of ten vehicles four rovers on a deck, two REMUS, one with autopilot and modem, one Otter, two naive AUVs",
          {10, 100, 1000},
          mixed_text,
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<MixedPrograms>(world, bus);
          }};
}

}  // namespace verification
