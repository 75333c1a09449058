// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/bench/scale_scene.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "shoal/message_codec.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/world/world_state.hpp"
#include "tools/autonomy/behaviours/wander.hpp"

namespace tools {

namespace {

struct Grid {
  int columns, rows;
  double cell_m;
};

Grid grid_for(int robots) {
  if (robots == 1) return {1, 1, 4.0};
  if (robots == 10) return {5, 2, 2.0};
  if (robots == 1000) return {40, 25, 2.0};
  const int columns = static_cast<int>(std::ceil(std::sqrt(robots)));
  return {columns, (robots + columns - 1) / columns, 2.0};
}

constexpr const char* rover_model = R"(
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
        - name: lidar
          type: lidar
          position_m: [0.15, 0, 0.15]
          range_max_m: 8
          noise: {gaussian_std: 0.01}
)";

std::string wall(const char* name, double x, double y, double size_x, double size_y) {
  return fmt::format(
      "  - {{name: {}, fixed: true, position_m: [{}, {}, 0.25], parts: [{{shape: box, size_m: [{}, {}, 0.5]}}]}}\n",
      name, x, y, size_x, size_y);
}

std::string boxes(const Grid& grid, int count) {
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

std::string indented(const std::string& text, int spaces) {
  std::string out;
  for (const char c : text) {
    out += c;
    if (c == '\n') out.append(static_cast<std::size_t>(spaces), ' ');
  }
  return out;
}

std::string rovers(const Grid& grid, int robots, bool one_entry_each) {
  if (!one_entry_each)
    return fmt::format(
        "  - name: rover\n    count: {}\n    placement: {{pattern: grid, columns: {}, spacing_m: {}, "
        "jitter_m: 0.4, random_yaw: true}}\n    model:{}",
        robots, grid.columns, grid.cell_m, rover_model);
  std::string text;
  for (int i = 0; i < robots; ++i)
    text += fmt::format("  - name: rover{}\n    position_m: [{}, {}, 0]\n    model:{}", i + 1,
                        (i % grid.columns - 0.5 * (grid.columns - 1)) * grid.cell_m,
                        (i / grid.columns - 0.5 * (grid.rows - 1)) * grid.cell_m, indented(rover_model, 0));
  return text;
}

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::string scale_scene_text(int robots, bool one_entry_each) {
  const Grid grid = grid_for(robots);
  const double x = grid.columns * grid.cell_m;
  const double y = grid.rows * grid.cell_m;
  // Crowds are in permanent contact: the exact solver is used for isolated rovers only.
  return "shoal: 1\nname: scale\n"
         "physics: {step_s: 0.01, quick_above_rows: 40, quick_iterations: 10, max_contacts_per_pair: 4}\nobjects:\n"
         "  - {name: ground, fixed: true, parts: [{shape: plane}]}\n" +
         wall("east", x / 2 + 0.05, 0, 0.1, y + 0.2) + wall("west", -x / 2 - 0.05, 0, 0.1, y + 0.2) +
         wall("north", 0, y / 2 + 0.05, x, 0.1) + wall("south", 0, -y / 2 - 0.05, x, 0.1) + boxes(grid, robots / 4) +
         "vehicles:\n" + rovers(grid, robots, one_entry_each);
}

/// Controller of a rover, connected to the bus like an external program.
struct ScaleScene::Wanderer {
  Wanderer(sim::Bus& own_bus, const std::string& name)
      : bus(own_bus),
        scans(own_bus.open_mailbox(name + ".lidar", 4)),
        command_channel(name + ".drive.cmd"),
        brain(1, name) {}

  void think(sim::Time now) {
    while (const auto message = scans->take()) {
      const auto scan = shoal::decode<shoal::planar_lidar_t>(message->payload, shoal::Finite::any);
      const autonomy::Twist twist = brain.step({scan.ranges, scan.rad0, scan.radstep});
      shoal::twist_command_t command;
      command.utime = scan.utime;
      command.forward_mps = twist.forward_mps;
      command.turn_radps = twist.turn_radps;
      shoal::encode_into(command, buffer);
      bus.publish(command_channel, buffer, now);
    }
  }

  sim::Bus& bus;
  std::unique_ptr<sim::Mailbox> scans;
  std::string command_channel;
  autonomy::Wander brain;
  sim::Bytes buffer;
};

ScaleScene::ScaleScene(int robots, const std::vector<std::string>& sets, int threads)
    : loaded_(sim::load_world_text(scale_scene_text(robots), "scale.yaml", {sets, {}, false, {}})) {
  world_ = std::make_unique<sim::World>(loaded_.config, bus_);
  world_->use_threads(threads);
  for (const auto& vehicle : world_->vehicles())
    wanderers_.push_back(std::make_unique<Wanderer>(bus_, vehicle->name()));
}

ScaleScene::~ScaleScene() = default;

void ScaleScene::step() {
  world_->step();
  for (const auto& wanderer : wanderers_) wanderer->think(world_->now());
}

void ScaleScene::run_for(double time_s) {
  const sim::Time end = world_->now() + sim::from_seconds(time_s);
  while (world_->now() < end) step();
}

ScaleFigures measure_scale(int robots, const ScaleOptions& options) {
  ScaleFigures figures;
  figures.robots = robots;
  const double start_s = wall_seconds();
  ScaleScene scene(robots, options.sets, options.threads);
  figures.load_s = wall_seconds() - start_s;
  scene.run_for(options.warm_up_s);
  const double cpu_s = cpu_seconds();
  const double wall_s = wall_seconds();
  scene.run_for(options.measure_s);
  figures.cpu_ms_per_robot_second = 1e3 * (cpu_seconds() - cpu_s) / robots / options.measure_s;
  figures.real_time_factor = options.measure_s / (wall_seconds() - wall_s);
  figures.run_hash = scene.world().state().run_hash();
  return figures;
}

}  // namespace tools
