// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "tools/shoal/commands/commands.hpp"
#include "verification/fidelity/fidelity.hpp"
#include "verification/fidelity/fidelity_mutations.hpp"

namespace tools {

namespace {

struct FidelityArguments {
  std::string cases, results;
  bool csv = false;
  std::vector<std::string> names;
  std::optional<double> step_s;
  std::vector<std::string> overrides;
  std::optional<double> mutation;
};

/// Changes every coefficient, prints those that a case should see and none does, and writes the page of all.  Returns
/// true when there are none.
bool mutate(const FidelityArguments& arguments, const verification::FidelityFile& file) {
  const std::vector<verification::FidelityMutation> mutations = verification::mutate_fidelity(
      file, *arguments.mutation, [](const std::string& line) { std::cerr << line << '\n'; });
  if (!arguments.results.empty())
    verification::write_fidelity_mutations(
        arguments.results, verification::fidelity_mutations_page(mutations, *arguments.mutation, arguments.cases),
        verification::fidelity_mutations_csv(mutations));
  bool all_seen = true;
  for (const verification::FidelityMutation& mutation : mutations) {
    if (!mutation.unseen() || !mutation.without_effect.empty()) continue;
    std::cout << mutation.vehicle << ": no case sees " << mutation.of.name << '\n';
    all_seen = false;
  }
  return all_seen;
}

int fidelity(const FidelityArguments& arguments) {
  // Options of all cases.
  verification::FidelityOptions options;
  options.step_s = arguments.step_s;
  for (const std::string& change : arguments.overrides) {
    const auto equals = change.find('=');
    if (equals == std::string::npos || equals == 0)
      throw CLI::ValidationError("--override", "must be path=value, got '" + change + "'");
    options.overrides[change.substr(0, equals)] = change.substr(equals + 1);
  }
  // Cases to run.
  verification::FidelityFile file = verification::read_fidelity_file(arguments.cases);
  std::erase_if(file.cases, [&](const verification::FidelityCase& of) {
    const auto is_selected = [&](const std::string& name) { return name == of.name || name == of.group; };
    return !arguments.names.empty() && std::none_of(arguments.names.begin(), arguments.names.end(), is_selected);
  });
  if (file.cases.empty() && arguments.names.empty())
    throw CLI::ValidationError("CASES", "there is no case in " + arguments.cases);
  if (file.cases.empty()) throw CLI::ValidationError("--case", "no case has this name");
  // Results.
  std::vector<verification::FidelityResult> results;
  bool passed = true;
  for (const verification::FidelityCase& of : file.cases) {
    results.push_back(verification::run_fidelity_case(of, options));
    passed = passed && results.back().missed.empty();
    std::cerr << verification::fidelity_line(results.back(), results.size(), file.cases.size()) << '\n';
  }
  std::cout << verification::fidelity_table(results);
  for (const verification::FidelityResult& result : results)
    for (const std::string& missed : result.missed) std::cout << result.of.name << ": missed " << missed << '\n';
  if (!arguments.results.empty())
    verification::write_fidelity_report(arguments.results, file.text, results, arguments.csv);
  // If a bound is missed already, every change would seem to be detected.
  if (passed && arguments.mutation) passed = mutate(arguments, file);
  return passed ? exit_ok : exit_failed;
}

}  // namespace

static void add_fidelity_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("fidelity");
  const auto arguments = std::make_shared<FidelityArguments>();
  add_log_level_option(*command);
  // Options.
  command->add_option("CASES", arguments->cases, "file of cases")->required();
  command->add_option("--case", arguments->names, "run only this case, or the cases of this group")
      ->type_name("NAME")
      ->type_size(1)
      ->allow_extra_args(false);
  command->add_option("--step", arguments->step_s, "compare at this time step, s, instead of at step zero")
      ->type_name("S")
      ->check(number_from(1e-5, 1));
  command->add_option("--override", arguments->overrides, "change a value of the vehicles")
      ->type_name("PATH=VALUE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(command_line::setting());
  command
      ->add_option("--mutate", arguments->mutation,
                   "then change each coefficient by this fraction, and list the changes that no case detects")
      ->type_name("SHARE")
      ->check(number_from(1e-4, 0.5));
  command
      ->add_option(
          "--results", arguments->results,
          "directory for the report: fidelity.md and plots; with --mutate also fidelity_coefficients.md and its table")
      ->type_name("DIR");
  command->add_flag("--csv", arguments->csv, "with --output, also write the states of Shoal as CSV files");
  add_plugin_option(*command);
  // End of the help and action.
  command_line::set_help_end(*command,
                             {{"shoal fidelity tests/fidelity/cases.yaml --case otter_turn --results results/otter",
                               "shoal fidelity tests/fidelity/cases.yaml --mutate 0.05"},
                              {{0, "all cases are within their bounds; with --mutate, each change is detected"},
                               {1, "a case exceeds a bound, or no case detects a change of --mutate"},
                               {2, "wrong usage, or a mistake in a file"},
                               {4, "file error"}},
                              {"docs/models/fidelity.md says how to add cases."}});
  command->callback([arguments, &exit_code] { exit_code = fidelity(*arguments); });
}

SHOAL_COMMAND(measure, "fidelity", "Compare vehicles with published trajectories", add_fidelity_command);

}  // namespace tools
