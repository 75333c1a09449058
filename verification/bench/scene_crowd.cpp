// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>
#include <vector>

#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/random/random.hpp"
#include "verification/bench/rover_arena.hpp"

namespace verification {

namespace {

constexpr double crowd_cell_m = 0.85;  // a rover of any yaw has room in it

/// Walls 0.5 m high around a square, with the rovers in its cells.
std::string crowd_text(int vehicles) {
  const double side_m = std::ceil(std::sqrt(vehicles)) * crowd_cell_m;
  const double middle_m = side_m / 2 + 0.05;
  std::string text =
      "shoal: 1\nname: crowd\n"
      "physics: {step_s: 0.01, quick_above_rows: 40, quick_iterations: 10, max_contacts_per_pair: 4}\n"
      "objects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n  - name: walls\n    fixed: true\n    "
      "parts:\n";
  for (const int sign : {1, -1}) {
    text += fmt::format("      - {{shape: box, size_m: [0.1, {}, 0.5], position_m: [{}, 0, 0.25]}}\n", side_m + 0.2,
                        sign * middle_m);
    text += fmt::format("      - {{shape: box, size_m: [{}, 0.1, 0.5], position_m: [0, {}, 0.25]}}\n", side_m,
                        sign * middle_m);
  }
  return text +
         fmt::format(
             "vehicles:\n  - name: rover\n    count: {}\n    placement: {{pattern: grid, spacing_m: {}, random_yaw: "
             "true}}\n    model:{}",
             vehicles, crowd_cell_m, rover_model_text(""));
}

/// Each rover goes ahead at 0.4 m/s, and draws another turn rate up to 0.5 rad/s every second.
class CrowdDrivers final : public ScenePrograms {
 public:
  CrowdDrivers(const sim::World& world, sim::Bus& bus) : bus_(bus) {
    for (const auto& vehicle : world.vehicles())
      all_.push_back({vehicle->name() + ".drive.cmd", sim::Random(1, vehicle->name())});
  }
  void think(sim::Time now) override {
    if (now < next_) return;
    for (auto& [channel, random] : all_) {
      random.begin_step(seconds_);
      shoal::twist_command_t command{};
      command.utime = now.count();
      command.forward_mps = 0.4;
      command.turn_radps = random.uniform() - 0.5;
      shoal::encode_into(command, buffer_);
      bus_.publish(channel, buffer_, now);
    }
    next_ = sim::from_seconds(static_cast<double>(++seconds_));
  }

 private:
  struct Driver {
    std::string channel;
    sim::Random random;
  };
  sim::Bus& bus_;
  std::vector<Driver> all_;
  sim::Bytes buffer_;
  sim::Time next_{};
  std::int64_t seconds_ = 0;
};

}  // namespace

BenchScene crowd_scene() {
  return {"crowd",
          "rovers without lidars, each in 0.85 x 0.85 m, that push against each other and the walls",
          {10, 100, 1000},
          crowd_text,
          [](const sim::World& world, sim::Bus& bus) -> std::unique_ptr<ScenePrograms> {
            return std::make_unique<CrowdDrivers>(world, bus);
          }};
}

}  // namespace verification
