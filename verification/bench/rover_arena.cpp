// SPDX-License-Identifier: BSD-3-Clause
#include "verification/bench/rover_arena.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "autonomy/behaviors/wander.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_state.hpp"

namespace verification {

namespace {

struct ArenaGrid {
  int columns, rows;
  double cell_m;
};

ArenaGrid arena_grid(int robots) {
  if (robots == 1) return {1, 1, 4.0};
  if (robots == 10) return {5, 2, 2.0};
  if (robots == 1000) return {40, 25, 2.0};
  const int columns = static_cast<int>(std::ceil(std::sqrt(robots)));
  return {columns, (robots + columns - 1) / columns, 2.0};
}

constexpr const char* arena_rover = R"(
      shoal: 1
      vehicle: scale_rover
      materials: [{name: rubber}, {name: slick}]
      contacts: [{between: [slick, any], friction: 0}]
      bodies:
        - name: chassis
          position_m: [0, 0, 0.1]
          parts:
            - {name: hull, shape: box, size_m: [0.5, 0.4, 0.12], position_m: [0, 0, 0.04], mass_kg: 20}
            - {name: caster, shape: sphere, radius_m: 0.04, position_m: [-0.18, 0, -0.06], mass_kg: 0.2, material: slick}
        - name: left_wheel
          position_m: [0.08, 0.23, 0.1]
          parts: [{name: tyre, shape: sphere, radius_m: 0.1, mass_kg: 0.6, material: rubber}]
        - name: right_wheel
          position_m: [0.08, -0.23, 0.1]
          parts: [{name: tyre, shape: sphere, radius_m: 0.1, mass_kg: 0.6, material: rubber}]
      joints:
        - {name: left, type: hinge, bodies: [chassis, left_wheel], axis: [0, 1, 0]}
        - {name: right, type: hinge, bodies: [chassis, right_wheel], axis: [0, 1, 0]}
      devices:
        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, track_m: 0.46}
        - {name: odometry, type: odometry, left_joint: left, right_joint: right, track_m: 0.46, rate_hz: 10}
)";

std::string arena_wall(const char* name, double x, double y, double size_x, double size_y) {
  return fmt::format(
      "  - {{name: {}, fixed: true, position_m: [{}, {}, 0.25], parts: [{{shape: box, size_m: [{}, {}, 0.5]}}]}}\n",
      name, x, y, size_x, size_y);
}

std::string arena_boxes(const ArenaGrid& grid, int count) {
  std::string text;
  sim::Random random(7, "scale_scene/boxes");
  random.begin_step(0);
  // Corners are drawn without repetition; the outermost lie under the walls' inner faces and are omitted when there are
  // enough others.
  std::vector<std::pair<int, int>> corners;
  const int margin = (grid.columns - 1) * (grid.rows - 1) >= count ? 1 : 0;
  for (int row = margin; row <= grid.rows - margin; ++row)
    for (int column = margin; column <= grid.columns - margin; ++column) corners.emplace_back(column, row);
  for (int i = 0; i < count; ++i) {
    const auto rest = static_cast<std::uint32_t>(corners.size()) - static_cast<std::uint32_t>(i);
    std::swap(corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(i) + random.integer_below(rest)]);
    const auto [column, row] = corners[static_cast<std::size_t>(i)];
    text += fmt::format(
        "  - {{name: box{}, fixed: true, position_m: [{}, {}, 0.25], rpy_deg: [0, 0, {:.3f}], "
        "parts: [{{shape: box, size_m: [0.5, 0.5, 0.5]}}]}}\n",
        i + 1, (column - grid.columns / 2.0) * grid.cell_m, (row - grid.rows / 2.0) * grid.cell_m,
        random.uniform() * 360);
  }
  return text;
}

std::string arena_rovers(const RoverArena& arena, const ArenaGrid& grid, int robots) {
  const std::string model = rover_model_text(arena.lidar_position);
  if (!arena.one_entry_each)
    return fmt::format(
        "  - name: rover\n    count: {}\n    placement: {{pattern: grid, columns: {}, spacing_m: {}, "
        "jitter_m: 0.4, random_yaw: true}}\n    model:{}",
        robots, grid.columns, grid.cell_m, model);
  std::string text;
  for (int i = 0; i < robots; ++i)
    text += fmt::format("  - name: rover{}\n    position_m: [{}, {}, 0]\n    model:{}", i + 1,
                        (i % grid.columns - 0.5 * (grid.columns - 1)) * grid.cell_m,
                        (i / grid.columns - 0.5 * (grid.rows - 1)) * grid.cell_m, model);
  return text;
}

/// Controller of a rover.
struct Wanderer {
  Wanderer(sim::Bus& bus, const std::string& name)
      : scans(bus.open_mailbox(name + ".lidar", 4)), command_channel(name + ".drive.cmd"), brain(1, name) {}

  std::unique_ptr<sim::Mailbox> scans;
  std::string command_channel;
  autonomy::Wander brain;
};

class Wanderers final : public ScenePrograms {
 public:
  Wanderers(const sim::World& world, sim::Bus& bus) : bus_(bus) {
    for (const auto& vehicle : world.vehicles())
      if (world.find_device(vehicle->name() + "/lidar") != nullptr) all_.emplace_back(bus, vehicle->name());
  }
  void think(sim::Time now) override {
    for (Wanderer& each : all_)
      while (const auto message = each.scans->take()) {
        const auto scan = shoal::decode<shoal::planar_lidar_t>(message->payload, shoal::Finite::any);
        const autonomy::Twist twist = each.brain.step({scan.ranges, scan.rad0, scan.radstep});
        shoal::twist_command_t command{};
        command.utime = scan.utime;
        command.forward_mps = twist.forward_mps;
        command.turn_radps = twist.turn_radps;
        shoal::encode_into(command, buffer_);
        bus_.publish(each.command_channel, buffer_, now);
      }
  }

 private:
  sim::Bus& bus_;
  std::vector<Wanderer> all_;
  sim::Bytes buffer_;
};

}  // namespace

std::string rover_model_text(const std::string& lidar_position) {
  if (lidar_position.empty()) return arena_rover;
  return fmt::format(
      "{}        - name: lidar\n          type: lidar\n          position_m: {}\n          range_max_m: 8\n"
      "          noise: {{gaussian_std: 0.01}}\n",
      arena_rover, lidar_position);
}

std::string rover_arena_text(const RoverArena& arena, int robots) {
  const ArenaGrid grid = arena_grid(robots);
  const double x = grid.columns * grid.cell_m;
  const double y = grid.rows * grid.cell_m;
  // Crowds are in permanent contact: the exact solver is used for isolated rovers only.
  return fmt::format("shoal: 1\nname: {}\n", arena.name) +
         "physics: {step_s: 0.01, quick_above_rows: 40, quick_iterations: 10, max_contacts_per_pair: 4}\nobjects:\n"
         "  - {name: ground, fixed: true, parts: [{shape: plane}]}\n" +
         arena_wall("east", x / 2 + 0.05, 0, 0.1, y + 0.2) + arena_wall("west", -x / 2 - 0.05, 0, 0.1, y + 0.2) +
         arena_wall("north", 0, y / 2 + 0.05, x, 0.1) + arena_wall("south", 0, -y / 2 - 0.05, x, 0.1) +
         arena_boxes(grid, robots / 4) + "vehicles:\n" + arena_rovers(arena, grid, robots);
}

std::unique_ptr<ScenePrograms> wanderers(const sim::World& world, sim::Bus& bus) {
  return std::make_unique<Wanderers>(world, bus);
}

}  // namespace verification
