// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "experiment/score/map/grid_map.hpp"
#include "experiment/score/map/published_map.hpp"
#include "experiment/score/map/true_map.hpp"
#include "sim/base/log.hpp"
#include "tools/command_line/checks.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "viewer/film/film_source.hpp"

namespace tools {

namespace {

struct MapArguments {
  std::string source;
  sim::LoadOptions load;
  double at_s = 0, until_s = 0;
  std::optional<double> every_s;
  double height_m = 0.3, cell_m = 0.05;
  std::string area, channel, out = "map.png";
};

std::optional<experiment::MapArea> parse_area(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto numbers = command_line::numbers_in(text, ',', 4);
  const auto is_near = [](double number) { return std::abs(number) <= 1e7; };
  if (!numbers || !std::all_of(numbers->begin(), numbers->end(), is_near))
    throw CLI::ValidationError("--area", "must be four numbers in meters such as -20,-15,20,15, got '" + text + "'");
  return experiment::MapArea{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
}

/// `map.png`, or `map_0003.png` for one of several.
std::string numbered(const MapArguments& arguments, int number) {
  if (!arguments.every_s) return arguments.out;
  return fmt::format("{}_{:04}.png", arguments.out.substr(0, arguments.out.rfind('.')), number);
}

void write(const MapArguments& arguments, const experiment::GridMap& map, const std::string& path, double at_s) {
  const std::string yaml = experiment::write_map(path, map);
  std::size_t occupied = 0;
  for (const experiment::Cell cell : map.cells) occupied += cell == experiment::Cell::occupied ? 1 : 0;
  std::cout << fmt::format("{}, {}: {} x {} cells of {:g} m, {} occupied, {} at {:.3f} s\n", path, yaml,
                           map.frame.width, map.frame.height, map.frame.cell_m, occupied,
                           arguments.channel.empty() ? arguments.source : arguments.channel, at_s);
}

/// Calls `take(time, number)` for each time that the arguments ask for.
template <class Take>
void for_times(const MapArguments& arguments, Take take) {
  int number = 0;
  for (double at_s = arguments.at_s; number == 0 || at_s <= arguments.until_s + 1e-9; ++number) {
    if (!take(at_s, number)) return sim::log_warn("the log ends before {:.6g} s", at_s);
    if (!arguments.every_s) return;
    at_s = arguments.at_s + (number + 1) * *arguments.every_s;
  }
}

experiment::MapFrame frame_of(const MapArguments& arguments, const std::optional<experiment::MapArea>& area,
                              const sim::World& world) {
  const std::optional<experiment::MapArea> all = area ? area : experiment::area_of_objects(world, arguments.height_m);
  if (!all)
    throw std::runtime_error(
        fmt::format("{}: no object is {:g} m above zero at {:.6g} s: give --area, or another "
                    "--height",
                    arguments.source, arguments.height_m, sim::to_seconds(world.now())));
  try {
    return experiment::frame_of_area(*all, arguments.cell_m);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--area", error.what());
  }
}

/// Writes true maps.
int write_truth(const MapArguments& arguments) {
  const auto area = parse_area(arguments.area);
  if (area) experiment::frame_of_area(*area, arguments.cell_m);
  const std::unique_ptr<viewer::FilmSource> source = viewer::open_film_source(arguments.source, arguments.load);
  if (sim::from_seconds(arguments.at_s) < source->world().now() || arguments.at_s > source->end_s() + 1e-9)
    throw std::runtime_error(fmt::format("{}: the log goes from {:.6g} s to {:.6g} s, --at is {:.6g} s",
                                         arguments.source, sim::to_seconds(source->world().now()), source->end_s(),
                                         arguments.at_s));
  std::optional<experiment::MapFrame> frame;  // of the first map: the maps of a series fit
  for_times(arguments, [&](double at_s, int number) {
    if (!source->advance_to(sim::from_seconds(at_s))) return false;
    if (!frame) frame = frame_of(arguments, area, source->world());
    write(arguments, experiment::true_map(source->world(), *frame, arguments.height_m), numbered(arguments, number),
          at_s);
    return true;
  });
  return exit_ok;
}

/// Writes maps that a program published.
int write_published(const MapArguments& arguments) {
  experiment::PublishedMaps maps(arguments.source, arguments.channel);
  for_times(arguments, [&](double at_s, int number) {
    const std::optional<experiment::GridMap> map = maps.at(at_s);
    if (!map) return false;
    write(arguments, *map, numbered(arguments, number), at_s);
    return true;
  });
  return exit_ok;
}

int map(const MapArguments& arguments) {
  if (!arguments.out.ends_with(".png"))
    throw CLI::ValidationError("--out", "must end in .png, got '" + arguments.out + "'");
  if (arguments.every_s && arguments.until_s < arguments.at_s)
    throw CLI::ValidationError("--until", "must not be before --at");
  // Checked before the run, which may take minutes.
  check_writable(numbered(arguments, 0));
  if (!arguments.channel.empty() && !viewer::is_event_log(arguments.source))
    throw std::runtime_error(arguments.source + ": --channel needs a log of shoal run --record");
  try {
    return arguments.channel.empty() ? write_truth(arguments) : write_published(arguments);
  } catch (const sim::PhysicsFault& fault) {
    std::cerr << "shoal: " << fault.what() << '\n';
    return exit_physics;
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--area", error.what());
  }
}

void add_map_options(CLI::App& command, MapArguments& arguments) {
  command.add_option("--at", arguments.at_s, "simulated time, s")
      ->type_name("S")
      ->check(number_from(0, 1e9))
      ->capture_default_str();
  CLI::Option* every =
      command.add_option("--every", arguments.every_s, "interval between maps, s: writes NAME_0000.png and so on")
          ->type_name("S");
  CLI::Option* until = command.add_option("--until", arguments.until_s, "time of the last map, s")->type_name("S");
  every->check(number_from(1e-6, 1e9))->needs(until);
  until->check(number_from(0, 1e9))->needs(every);
  command.add_option("--height", arguments.height_m, "height of the horizontal slice, m (such as the lidar's)")
      ->type_name("M")
      ->check(number_from(-1e6, 1e6))
      ->capture_default_str();
  command.add_option("--cell", arguments.cell_m, "map resolution (cell size), m")
      ->type_name("M")
      ->check(number_from(0.001, 1000))
      ->capture_default_str();
  command
      .add_option("--area", arguments.area,
                  "smallest x and y, and largest x and y, m; default: all objects at this height")
      ->type_name("X,Y,X,Y");
}

}  // namespace

static void add_map_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("map");
  const auto arguments = std::make_shared<MapArguments>();
  add_log_level_option(*command);
  command
      ->add_option("LOG|WORLD", arguments->source,
                   "world file, shipped world, which is run without programs, or log of shoal run --record")
      ->required();
  add_map_options(*command, *arguments);
  command
      ->add_option("--channel", arguments->channel,
                   "export the last shoal.occupancy_grid_t on this channel of a log instead of the ground truth")
      ->type_name("CHANNEL");
  command->add_option("--out", arguments->out, "image, a .png; the .yaml beside it has its place and size")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--seed", arguments->load.seed, "seed of every random stream of a world")
      ->type_name("N")
      ->check(command_line::seed());
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  add_plugin_option(*command);
  command_line::set_help_end(*command,
                             {{"shoal map slam_days --at 36300 --height 0.3 --cell 0.05",
                               "shoal map day.lcm --at 43200 --area=-21,-15,21,15 --out noon.png",
                               "shoal map day.lcm --channel rover1.map --every 3600 --until 86400 --out map.png"},
                              {{0, "success"},
                               {2, "wrong usage, or a mistake in the world"},
                               {3, "physics fault"},
                               {4, "a file cannot be written, or the log cannot be replayed"}},
                              {}});
  command->callback([arguments, &exit_code] { exit_code = map(*arguments); });
}

SHOAL_COMMAND(look, "map", "Write the true map of a world or log, or one that a program published, for ROS map_server",
              add_map_command);

}  // namespace tools
