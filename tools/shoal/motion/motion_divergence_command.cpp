// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <memory>

#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "motion/analysis/divergence.hpp"
#include "motion/analysis/perturbed_world.hpp"
#include "tools/shoal/motion/format_options.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

struct DivergenceArguments {
  std::vector<std::string> files;
  std::string world, vehicle, csv;
  sim::LoadOptions load;
  motion::DivergenceOptions options;
};

struct NamedDivergence {
  std::string motion;
  motion::Divergence divergence;
};

/// Returns the row at a time, the last one if it is earlier.
std::size_t row_at(const motion::Divergence& divergence, double at_s) {
  return std::min(divergence.rows() - 1, static_cast<std::size_t>(at_s / divergence.row_s + 0.5));
}

std::string falls_of(const motion::Divergence& divergence) {
  const auto falls = std::count_if(divergence.curves.begin(), divergence.curves.end(),
                                   [](const motion::DivergenceCurve& curve) { return curve.fell_s >= 0; });
  return fmt::format("{}{}", divergence.fell_s >= 0 ? "falls; " : "",
                     falls > 0 ? fmt::format("{} of {} models fall", falls, divergence.curves.size()) : "none fall");
}

/// Prints a row: distances to the farthest model at a sixth, a third, two thirds and the whole of the time.
void print_row(const NamedDivergence& one, double duration_s) {
  const motion::Divergence& divergence = one.divergence;
  std::cout << fmt::format("{:<20} {:>9.1f}", one.motion, divergence.least_static_margin_m * mm);
  for (const double share : {1.0 / 6, 1.0 / 3, 2.0 / 3, 1.0})
    std::cout << fmt::format(" {:>9.1f}", divergence.greatest_m(row_at(divergence, share * duration_s)) * mm);
  const std::size_t last = divergence.rows() - 1;
  std::cout << fmt::format(" {:>9.1f} {:>9.1f}  {}\n", divergence.median_m(last) * mm,
                           divergence.greatest_until_m(last) * mm, falls_of(divergence));
}

/// Returns the distance to the farthest model by time, a column for each motion.
std::string csv_of(const std::vector<NamedDivergence>& all) {
  std::string text = "t_s";
  for (const NamedDivergence& one : all) text += "," + one.motion + "_mm";
  for (std::size_t row = 0; row < all.front().divergence.rows(); ++row) {
    text += fmt::format("\n{:.3f}", static_cast<double>(row) * all.front().divergence.row_s);
    for (const NamedDivergence& one : all) text += fmt::format(",{:.4f}", one.divergence.greatest_m(row) * mm);
  }
  return text + "\n";
}

int divergence(DivergenceArguments arguments) {
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::LoadedWorld loaded =
      sim::load_world(experiment::file_by_name({experiment::ShippedKind::world}, arguments.world), arguments.load);
  if (!arguments.csv.empty()) check_writable(arguments.csv);
  const std::string vehicle = motion::walking_vehicle(loaded.config, arguments.vehicle);
  const double duration_s = arguments.options.duration_s;
  std::cout << fmt::format("{:<20} {:>9}", "motion", "static mm");
  for (const double share : {1.0 / 6, 1.0 / 3, 2.0 / 3, 1.0})
    std::cout << fmt::format(" {:>9}", fmt::format("{:.3g} s", share * duration_s));
  std::cout << fmt::format(" {:>9} {:>9}\n", "median", "greatest");
  std::vector<NamedDivergence> all;
  for (const std::string& file : arguments.files) {
    const sim::JointMotion motion = motion_of(file);
    all.push_back({motion.name, motion::divergence_of(loaded.config, vehicle, motion, arguments.options)});
    print_row(all.back(), duration_s);
  }
  std::cout << "mm between the vehicle in the world and in the farthest of five models: mass 10 % more, less; efforts "
               "20 % less; friction 0.2 more, less\n";
  if (!arguments.csv.empty()) write_bytes(arguments.csv, csv_of(all));
  return exit_ok;
}

}  // namespace

void add_motion_divergence_command(CLI::App& motion, int& exit_code) {
  CLI::App* command =
      motion.add_subcommand("divergence", "Compare where motions bring a vehicle in models that differ a little");
  const auto arguments = std::make_shared<DivergenceArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->files, "motion files")->required();
  add_stage_options(*command, arguments->world, arguments->vehicle);
  command->add_option("--duration", arguments->options.duration_s, "duration of the repeated motion, s; default 30")
      ->type_name("S")
      ->check(number_from(0.1, 3600));
  command->add_option("--row", arguments->options.row_s, "time between rows of the CSV file, s; default 0.1")
      ->type_name("S")
      ->check(number_from(0.001, 60));
  command->add_option("--csv", arguments->csv, "write the distance to the farthest model by time")->type_name("OUTPUT");
  command
      ->add_option("--threads", arguments->options.threads,
                   "number of threads; 0: one per processor; does not change the results")
      ->type_name("N")
      ->check(whole_from(0, 256));
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  command_line::set_help_end(
      *command,
      {{"shoal motion divergence vehicles/motions/ers7/*.yaml --world ers7_studio",
        "shoal motion divergence walk.yaml --world ers7_studio --duration 10 --csv walk.csv"},
       {{0, "success"}, {2, "wrong usage or configuration"}, {4, "file error"}},
       {"The motion is repeated.  Equal commands go to the vehicle in the world, and to five models of it: masses 10 % "
        "more and less, efforts 20 % less, friction 0.2 more and less.  Columns: least static margin in the world; "
        "distance to the farthest model after a sixth, a third, two thirds and all of the time; at the end to the "
        "median model; and the greatest one of all times."}});
  command->callback([arguments, &exit_code] { exit_code = divergence(*arguments); });
}

}  // namespace tools
