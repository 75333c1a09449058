// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "experiment/files/file_replacement.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "motion/analysis/evolve.hpp"
#include "motion/analysis/evolve_page.hpp"
#include "motion/analysis/free_keys.hpp"
#include "motion/analysis/motion_file.hpp"
#include "sim/base/log.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/motion/motion_output.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

constexpr const char* free_keys = "free_keys";

std::vector<std::string> gait_choices() {
  std::vector<std::string> names = motion::gait_names();
  names.emplace_back(free_keys);
  return names;
}

struct EvolveArguments {
  std::string world, vehicle, gait = "half_ellipse", motion, method = "cma_es", output, page;
  sim::LoadOptions load;
  motion::EvolveOptions options;
  int fresh = 20;
  bool overwrite = false;
};

/// Returns a phrase for the worlds in which a value holds.
std::string in_worlds(std::size_t count) {
  return count == 1 ? "in one world" : fmt::format("in the worst of {} worlds", count);
}

/// Writes the best gait, with its numbers.
void write_best(const EvolveArguments& arguments, const motion::GaitFamily& gait, const motion::Evolution& evolution) {
  const motion::Candidate& best = evolution.best();
  sim::JointMotion motion = gait.motion(best.values);
  motion.name = motion::motion_name_of(arguments.output);
  motion.description =
      fmt::format("Gait {} of seed {}, candidate {}: {:.0f} mm/s {};", arguments.gait, arguments.options.seed,
                  best.number, best.value_mps * mm, in_worlds(best.walks.size()));
  for (std::size_t i = 0; i < best.values.size(); ++i)
    motion.description +=
        fmt::format(" {} {:.4g}{}", gait.numbers()[i].name, best.values[i], i + 1 < best.values.size() ? "," : ".");
  check_frames(arguments.output, motion, arguments.overwrite);
  motion::write_motion(arguments.output, motion);
}

/// Row of a table: how the best gait walks in a world.
std::vector<std::string> row(const std::string& name, const motion::Perturbation& world, const motion::Walk& walk) {
  const auto speed = [&](double mps) { return walk.fell ? std::string("-") : fmt::format("{:.1f}", mps * mm); };
  return {name,
          world.friction ? fmt::format("{:.2f}", *world.friction) : "file",
          fmt::format("{:.3f}", world.mass),
          fmt::format("{:.3f}", world.effort),
          fmt::format("{:.1f}", world.lag_s * mm),
          fmt::format("{:.1f}", world.ground_m * mm),
          world.half_step ? "half" : "full",
          speed(walk.forward_mps),
          speed(walk.sideways_mps),
          walk.fell ? fmt::format("fell at {:.2f} s", walk.at_s) : ""};
}

std::string text_of(const std::vector<std::string>& cells) {
  std::string text = fmt::format("{:<9}", cells[0]);
  for (std::size_t i = 1; i < cells.size(); ++i) text += fmt::format(" {:>9}", cells[i]);
  return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

/// Lets the best gait walk in all worlds, and prints the result.
motion::EvolveReport print_result(const EvolveArguments& arguments, const motion::GaitFamily& gait,
                                  motion::Evolution& evolution) {
  const motion::Candidate& best = evolution.best();
  motion::EvolveReport report;
  report.world_head = {"world",     "friction", "mass", "effort",    "1/kp + ms",
                       "ground mm", "step",     "mm/s", "left mm/s", "fall"};
  for (std::size_t w = 0; w < best.walks.size(); ++w)
    report.worlds.push_back(row(std::to_string(w + 1), evolution.perturbations()[w], *best.walks[w]));
  const std::vector<motion::Perturbation> as_it_is(1);
  report.worlds.push_back(row("as it is", as_it_is.front(), evolution.walks_of_best(as_it_is).front()));
  std::string fresh;
  if (arguments.fresh > 0) {
    const auto worlds = motion::drawn_perturbations(arguments.fresh, arguments.options.seed, "evolve/fresh_worlds");
    const std::vector<motion::Walk> walks = evolution.walks_of_best(worlds);
    double worst_mps = 1e9;
    int falls = 0;
    for (std::size_t i = 0; i < walks.size(); ++i) {
      report.worlds.push_back(row(fmt::format("fresh {}", i + 1), worlds[i], walks[i]));
      if (walks[i].fell) ++falls;
      worst_mps = std::min(worst_mps, walks[i].value_mps);
    }
    fresh = fmt::format("in {} fresh worlds: {} falls, worst {:.1f} mm/s", arguments.fresh, falls, worst_mps * mm);
  }
  for (std::size_t i = 0; i < best.values.size(); ++i)
    report.numbers.push_back({gait.numbers()[i].name, fmt::format("{:.4f}", best.values[i]),
                              fmt::format("{:.4f}", evolution.start().values[i])});
  const std::string outcome =
      fmt::format("candidate {}, {:.1f} mm/s {}; the start had {:.1f} mm/s", best.number, best.value_mps * mm,
                  in_worlds(best.walks.size()), evolution.start().value_mps * mm);
  const std::string effort = fmt::format("{} candidates, {} walks", evolution.tried(), evolution.walks());
  report.facts = {{"best", outcome},
                  {"search", effort},
                  {"gait", arguments.gait},
                  {"world", arguments.world},
                  {"seed", std::to_string(arguments.options.seed)}};
  if (!fresh.empty()) report.facts.insert(report.facts.begin() + 1, {"fresh worlds", fresh});
  // Print it.
  std::cout << text_of(report.world_head);
  for (const auto& cells : report.worlds) std::cout << text_of(cells);
  if (!fresh.empty()) std::cout << fresh << '\n';
  for (const auto& cells : report.numbers)
    std::cout << fmt::format("{:<24} {:>8}   from {}\n", cells[0], cells[1], cells[2]);
  std::cout << fmt::format("best: {}; {}; written to {}\n", outcome, effort, arguments.output);
  return report;
}

std::unique_ptr<motion::GaitFamily> gait_of(const EvolveArguments& arguments, const sim::VehicleConfig& vehicle) {
  if ((arguments.gait == free_keys) == arguments.motion.empty())
    throw command_line::UsageError("--motion FILE and --gait free_keys need each other");
  if (arguments.gait == free_keys) return std::make_unique<motion::FreeKeys>(motion_of(arguments.motion), vehicle);
  return motion::make_gait(arguments.gait, vehicle);
}

/// Throws UsageError or std::runtime_error when the page cannot be written.
void check_page(const EvolveArguments& arguments) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path page = fs::weakly_canonical(arguments.page, error);
  for (const fs::path& file : {fs::path(arguments.output), fs::path(arguments.output).replace_extension(".csv")})
    if (fs::weakly_canonical(file, error) == page)
      throw command_line::UsageError("--page '" + arguments.page + "' must not be a file of the motion, --output '" +
                                     arguments.output + "'");
  if (!arguments.overwrite && fs::exists(page, error))
    throw command_line::UsageError("'" + arguments.page + "' exists; --overwrite replaces it");
  check_writable(arguments.page);
  experiment::check_whole_file(arguments.page);
}

int evolve(EvolveArguments arguments) {
  if (arguments.options.candidates < arguments.options.population)
    throw command_line::UsageError("--candidates must be at least --population, a generation: " +
                                   std::to_string(arguments.options.population));
  check_new_file(arguments.output, arguments.overwrite);
  if (!arguments.page.empty()) check_page(arguments);
  arguments.load.encode_message = shoal::encode_own_message;
  const sim::LoadedWorld loaded =
      sim::load_world(experiment::file_by_name({experiment::ShippedKind::world}, arguments.world), arguments.load);
  const std::string vehicle = motion::walking_vehicle(loaded.config, arguments.vehicle);
  const auto instance = std::find_if(loaded.config.vehicles.begin(), loaded.config.vehicles.end(),
                                     [&](const sim::VehicleInstance& one) { return one.name == vehicle; });
  const std::unique_ptr<motion::GaitFamily> gait = gait_of(arguments, *instance->config);
  std::vector<double> start;
  for (const motion::GaitNumber& number : gait->numbers()) start.push_back(number.start);
  check_frames(arguments.output, gait->motion(start), arguments.overwrite);
  arguments.options.method =
      arguments.method == "genetic" ? motion::SearchMethod::genetic : motion::SearchMethod::cma_es;
  motion::Evolution evolution(loaded.config, vehicle, *gait, arguments.options);
  sim::log_info("start of the search: {:.1f} mm/s {}", evolution.start().value_mps * mm,
                in_worlds(evolution.perturbations().size()));
  // The best so far is always in the file: the search takes hours, and may be ended at any time.
  write_best(arguments, *gait, evolution);
  const double start_mps = evolution.start().value_mps;
  std::vector<motion::EvolveGeneration> generations{{0, start_mps, start_mps}};
  while (evolution.advance()) {
    const motion::Candidate& of_generation = evolution.best_of_generation();
    generations.push_back({evolution.tried(), evolution.best().value_mps, of_generation.value_mps});
    if (evolution.best().number == of_generation.number) write_best(arguments, *gait, evolution);
    sim::log_info("{} of {} candidates: best {:.1f} mm/s in the worst world, of this generation {:.1f} mm/s",
                  evolution.tried(), arguments.options.candidates, evolution.best().value_mps * mm,
                  of_generation.value_mps * mm);
  }
  motion::EvolveReport report = print_result(arguments, *gait, evolution);
  report.title = "Search for a gait: " + motion::motion_name_of(arguments.output);
  report.generations = std::move(generations);
  if (!arguments.page.empty()) experiment::write_whole_file(arguments.page, motion::evolve_page(report));
  return evolution.best().fell() ? exit_failed : exit_ok;
}

}  // namespace

void add_motion_evolve_command(CLI::App& motion, int& exit_code) {
  CLI::App* command = motion.add_subcommand("evolve", "Search for a gait that is fast in perturbed worlds");
  const auto arguments = std::make_shared<EvolveArguments>();
  motion::EvolveOptions& options = arguments->options;
  add_log_level_option(*command);
  add_stage_options(*command, arguments->world, arguments->vehicle);
  command->add_option("--gait", arguments->gait, "gait family; default half_ellipse")
      ->type_name("NAME")
      ->check(one_of(gait_choices()));
  command
      ->add_option("--motion", arguments->motion, "motion file that loops, whose keys are searched: --gait free_keys")
      ->type_name("FILE");
  command->add_option("--output", arguments->output, "motion file to write, updated with each better candidate")
      ->type_name("FILE")
      ->required();
  command->add_option("--page", arguments->page, "HTML page with the curve of the search and its result")
      ->type_name("FILE");
  add_overwrite_option(*command, arguments->overwrite);
  command->add_option("--candidates", options.candidates, "number of gaits tried; default 500")
      ->check(whole_from(1, 1000000));
  command->add_option("--population", options.population, "candidates per generation; default 16")
      ->check(whole_from(4, 1000));
  command->add_option("--method", arguments->method, "search algorithm; default cma_es")
      ->type_name("NAME")
      ->check(one_of({"cma_es", "genetic"}));
  command->add_option("--sigma", options.sigma, "initial step size as a fraction of each range; default 0.3")
      ->check(number_from(0.001, 1));
  command->add_option("--worlds", options.worlds, "number of perturbed worlds; 0: only the world as it is; default 8")
      ->check(whole_from(0, 1000));
  command
      ->add_option("--fresh", arguments->fresh,
                   "number of further perturbed worlds in which the best gait is tested at the end; default 20")
      ->check(whole_from(0, 1000));
  command->add_option("--measure", options.walk.measured_s, "measured time of a walk, s; default 4")
      ->check(number_from(0.1, 600));
  command->add_option("--seed", options.seed, "seed of candidates and perturbed worlds; default 1")
      ->check(command_line::seed());
  command
      ->add_option("--threads", options.threads, "number of threads; 0: one per processor; does not change the results")
      ->check(whole_from(0, 256));
  add_set_option(*command, arguments->load.sets);
  add_allow_path_option(*command, arguments->load);
  command_line::set_help_end(
      *command,
      {{"shoal motion evolve --world ers7_studio --gait half_ellipse --candidates 500 --seed 1 --output walk.yaml",
        "shoal motion evolve --world ers7_studio --worlds 0 --output fragile.yaml",
        "shoal motion evolve --world ers7_studio --gait skelliptical --output walk.yaml --page walk.html",
        "shoal motion evolve --world ers7_studio --gait free_keys --motion walk.yaml --sigma 0.1 --output better.yaml",
        "shoal motion play walk.yaml --world ers7_studio"},
       {{0, "a gait that does not fall in any world of the search"},
        {1, "the best gait falls in one of them"},
        {2, "wrong usage or configuration"},
        {4, "file error"}},
       {"The value of a gait is its forward speed less 0.3 of its sideways speed, in the worst of the perturbed "
        "worlds: friction 0.4 to 1, masses 10 % more or less, efforts 60 to 120 %, time constants of servos up to 16 "
        "ms "
        "longer, ground up to 3 mm uneven, steps halved.  Half of each generation walks in all worlds, the others in "
        "one."}});
  command->callback([arguments, &exit_code] { exit_code = evolve(*arguments); });
}

}  // namespace tools
