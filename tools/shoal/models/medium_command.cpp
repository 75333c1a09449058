// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/medium/medium.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

struct MediumArguments {
  std::string world;
  sim::LoadOptions load;
  std::string at = "0,0,-1";
  double time_s = 0;
  bool profile = false;
  std::optional<double> waves_s;
};

sim::Vector3d parse_point(const std::string& text) {
  const auto point = command_line::point_in(text);
  if (!point)
    throw CLI::ValidationError("--at", "must be three numbers in meters such as 4,-3,-2.5, got '" + text + "'");
  return *point;
}

std::string vector_text(const sim::Vector3d& v) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", v.x(), v.y(), v.z());
}

void print_place(const sim::Medium& medium, const sim::Vector3d& p_W) {
  const auto row = [](const char* name, const std::string& value, const char* unit) {
    std::cout << fmt::format("{:<16}{:>24} {}\n", name, value, unit);
  };
  // Water column.
  if (medium.has_water()) {
    const sim::LocalWater water = medium.water_at(p_W);
    row("surface", fmt::format("{:.3f}", water.surface_m), "m");
    row("depth", fmt::format("{:.3f}", medium.depth_m(p_W)), "m");
    row("temperature", fmt::format("{:.3f}", medium.temperature_C(p_W)), "C");
    row("salinity", fmt::format("{:.3f}", medium.salinity_psu(p_W)), "psu");
    row("water velocity", vector_text(water.velocity_W), "m/s east north up");
    row("acceleration", vector_text(water.acceleration_W), "m/s^2 east north up");
    if (!medium.current_known(p_W)) row("current", "beyond its grid", "");
  }
  // Medium at the position.
  row("medium", medium.in_water(p_W) ? "water" : "air", "");
  row("density", fmt::format("{:.3f}", medium.density_kgpm3(p_W)), "kg/m^3");
  row("pressure", fmt::format("{:.1f}", medium.pressure_Pa(p_W)), "Pa");
  row("sound speed", fmt::format("{:.2f}", medium.sound_speed_mps(p_W)), "m/s");
  if (medium.in_water(p_W))
    row("wind", "none (under water)", "");
  else
    row("wind", vector_text(medium.air_velocity_W(p_W)), "m/s east north up");
}

/// Prints a profile from the surface to the depth of the position: rows at 1, 2 and 5 times powers of ten.
void print_profile(const sim::Medium& medium, const sim::Vector3d& p_W) {
  if (!medium.has_water()) throw CLI::ValidationError("--profile", "this world has no water");
  std::cout
      << "depth_m temperature_C salinity_psu density_kgpm3 sound_speed_mps pressure_Pa east_mps north_mps up_mps\n";
  const double surface_m = medium.surface_m(p_W.x(), p_W.y()), deepest_m = medium.depth_m(p_W);
  const auto print = [&](double depth_m) {
    // Slightly below the surface, where the air starts.
    const sim::Vector3d q_W(p_W.x(), p_W.y(), surface_m - std::max(depth_m, 1e-6));
    const sim::Vector3d v_W = medium.water_velocity_W(q_W);
    std::cout << fmt::format("{:g} {:.3f} {:.3f} {:.3f} {:.2f} {:.0f} {:.3f} {:.3f} {:.3f}\n", depth_m,
                             medium.temperature_C(q_W), medium.salinity_psu(q_W), medium.density_kgpm3(q_W),
                             medium.sound_speed_mps(q_W), medium.pressure_Pa(q_W), v_W.x(), v_W.y(), v_W.z());
  };
  print(0);
  for (double decade = 1; decade < deepest_m; decade *= 10)
    for (const double factor : {1, 2, 5})
      if (decade * factor < deepest_m) print(decade * factor);
  if (deepest_m > 0) print(deepest_m);
}

/// Prints statistics of the surface at a position.  The heights are evaluated at any time; the medium is not advanced.
void print_waves(const sim::Medium& medium, const sim::Vector3d& p_W, double from_s, double length_s) {
  if (!medium.has_waves()) throw CLI::ValidationError("--waves", "this world has no waves");
  // Surface elevation over time.
  constexpr double step_s = 0.05;
  const auto count = static_cast<std::int64_t>(length_s / step_s) + 1;
  std::vector<double> heights;
  double mean = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const double t_s = from_s + static_cast<double>(i) * step_s;
    heights.push_back(medium.surface_m(p_W.x(), p_W.y(), sim::from_seconds(t_s)));
    mean += heights.back() / static_cast<double>(count);
  }
  // Variance, extremes and zero up-crossings.
  double squares = 0, low = heights[0], high = heights[0];
  int rises = 0;
  double first_s = 0, last_s = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    squares += (heights[i] - mean) * (heights[i] - mean);
    low = std::min(low, heights[i]);
    high = std::max(high, heights[i]);
    if (i == 0 || heights[i - 1] > mean || heights[i] <= mean) continue;
    last_s = static_cast<double>(i) * step_s;
    if (rises++ == 0) first_s = last_s;
  }
  // Significant wave height and zero-crossing period.
  std::cout << fmt::format("mean surface    {:.3f} m\n", mean);
  std::cout << fmt::format("Hs = 4 std      {:.3f} m\n", 4 * std::sqrt(squares / static_cast<double>(count)));
  std::cout << fmt::format("lowest, highest {:.3f} {:.3f} m\n", low, high);
  if (rises > 1)
    std::cout << fmt::format("Tz              {:.3f} s over {} waves\n", (last_s - first_s) / (rises - 1), rises - 1);
}

int look(MediumArguments& arguments) {
  const sim::Vector3d p_W = parse_point(arguments.at);
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::WorldConfig config = sim::load_world(experiment::world_file(arguments.world), arguments.load).config;
  // Without physics: the medium alone takes no time to build, even of a large world.
  sim::Medium medium(config.medium, config.physics.gravity_mps2, static_cast<std::uint64_t>(config.run.seed));
  medium.advance_to(sim::from_seconds(arguments.time_s));
  if (arguments.waves_s)
    print_waves(medium, p_W, arguments.time_s, *arguments.waves_s);
  else if (arguments.profile)
    print_profile(medium, p_W);
  else
    print_place(medium, p_W);
  return exit_ok;
}

}  // namespace

static void add_medium_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("medium");
  const auto arguments = std::make_shared<MediumArguments>();
  add_log_level_option(*command);
  // Options.
  command->add_option("WORLD", arguments->world, "world file, or the name of a shipped world")->required();
  command->add_option("--at", arguments->at, "the place, m")->type_name("X,Y,Z")->capture_default_str();
  command->add_option("--time", arguments->time_s, "simulated time, s")
      ->type_name("S")
      ->check(number_from(0, 1e6))
      ->capture_default_str();
  CLI::Option* profile =
      command->add_flag("--profile", arguments->profile, "print a vertical profile from the surface to --at");
  command->add_option("--waves", arguments->waves_s, "print height and period of the waves at --at over this time, s")
      ->type_name("S")
      ->check(number_from(1, 1e5))
      ->excludes(profile);
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  add_plugin_option(*command);
  // End of the help and action.
  command_line::set_help_end(
      *command,
      {{"shoal medium worlds/minimal.yaml --set 'medium={water: {}, waves: {sea_state: 3}}' --at 0,0,-5 --time 10",
        "shoal medium worlds/minimal.yaml --set 'medium={water: {density: eos80}}' --at 0,0,-200 --profile",
        "shoal medium worlds/minimal.yaml --set 'medium={water: {}, waves: {sea_state: 3}}' --waves 1000"},
       {{0, "success"}, {2, "wrong usage, or a mistake in the world"}},
       {}});
  command->callback([arguments, &exit_code] { exit_code = look(*arguments); });
}

SHOAL_COMMAND(look, "medium", "Show the water and the air of a world at a place and a time", add_medium_command);

}  // namespace tools
