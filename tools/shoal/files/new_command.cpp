// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "messages/yaml/message_writer.hpp"
#include "sim/config/file_access.hpp"
#include "sim/world_file/load_world.hpp"
#include "tools/shoal/commands/commands.hpp"
#include "tools/shoal/options/shared_options.hpp"
#include "tools/shoal/start/start_files.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

struct NewArguments {
  std::string name;
  std::string folder = ".";
  std::string vehicle;
  bool under_water = false;
  bool python = false;
};

std::string check_name(const std::string& name) {
  const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  return plain ? "" : "must be made of letters, digits, '_' and '-', got '" + name + "'";
}

/// Returns the path of a shipped schema; empty: there is none.
std::string schema_file(const std::string& kind) {
  if (sim::shipped_folder().empty()) return "";
  const fs::path file = fs::path(sim::shipped_folder()) / "docs/reference/schema" / (kind + ".schema.json");
  std::error_code error;
  return fs::is_regular_file(file, error) ? file.string() : "";
}

/// Returns the path of the new file.
std::string write_start(const NewArguments& arguments, const std::string& file, const std::string& text) {
  const std::string path = (fs::path(arguments.folder) / file).lexically_normal().string();
  std::error_code error;
  if (fs::exists(path, error)) throw std::runtime_error(path + ": already exists; choose another name or folder");
  check_writable(path);
  std::ofstream out(path, std::ios::binary);
  if (!(out << text << std::flush)) throw std::runtime_error(path + ": cannot be written");
  return path;
}

int write_yaml(const NewArguments& arguments, const std::string& text) {
  const std::string path = write_start(arguments, arguments.name + ".yaml", text);
  std::cout << path << ": written; `shoal check " << path << "` checks it\n";
  return exit_ok;
}

/// Completes the name of a vehicle file: `digger` is digger.yaml, as for other commands.
std::string vehicle_file(const NewArguments& arguments) {
  if (arguments.vehicle.empty()) return arguments.under_water ? "remus100_survey.yaml" : "rover.yaml";
  return fs::path(arguments.vehicle).has_extension() ? arguments.vehicle : arguments.vehicle + ".yaml";
}

/// Names a vehicle: one of digger.yaml is digger1, one of remus100.yaml is remus100_1.
std::string vehicle_name(const NewArguments& arguments) {
  if (arguments.vehicle.empty()) return arguments.under_water ? "auv1" : "rover1";
  const std::string stem = fs::path(arguments.vehicle).stem().string();
  if (!check_name(stem).empty()) return "vehicle1";
  return stem + (std::isdigit(static_cast<unsigned char>(stem.back())) != 0 ? "_1" : "1");
}

/// Throws UsageError when the world cannot be loaded with the vehicle of the command line.
void check_vehicle(const NewArguments& arguments, const std::string& text) {
  sim::LoadOptions options;
  options.encode_message = shoal::encode_own_message;
  sim::Warnings ignored;  // `shoal check` shows them
  options.warnings = &ignored;
  const std::string path = (fs::path(arguments.folder) / (arguments.name + ".yaml")).lexically_normal().string();
  try {
    sim::load_world_text(text, path, options);
  } catch (const sim::ConfigError& error) {
    const std::string hint = arguments.under_water ? "; such a world needs a vehicle with an autopilot" : "";
    throw command_line::UsageError("--vehicle '" + arguments.vehicle + "' does not fit this world" + hint + ": " +
                                   error.lines().front());
  }
}

int new_world(const NewArguments& arguments) {
  const std::string vehicle = vehicle_file(arguments);
  const std::string schema = schema_file("world");
  const std::string text =
      arguments.under_water ? start_sea(arguments.name, vehicle, schema) : start_world(arguments.name, vehicle, schema);
  const std::string named = replaced(text, arguments.under_water ? "auv1" : "rover1", vehicle_name(arguments));
  if (!arguments.vehicle.empty()) check_vehicle(arguments, named);
  return write_yaml(arguments, named);
}

int new_program(const NewArguments& arguments) {
  const StartFiles files = arguments.python ? start_python_program(arguments.name, arguments.vehicle)
                                            : start_cpp_program(arguments.name, arguments.vehicle);
  if (!arguments.python) {
    std::error_code error;
    fs::create_directory(fs::path(arguments.folder) / arguments.name, error);  // write_start() reports a failure
  }
  std::vector<std::string> paths;
  for (const auto& [file, text] : files) paths.push_back(write_start(arguments, file, text));
  const std::string folder = fs::path(paths.front()).parent_path().string();
  if (arguments.python)
    std::cout << paths.front() << ": written; `python3 " << paths.front() << "` starts it\n";
  else
    std::cout << folder << "/: written; `cmake -S " << folder << " -B " << folder << "/build` and `cmake --build "
              << folder << "/build` build it\n";
  return exit_ok;
}

CLI::App* add_kind(CLI::App& command, const char* kind, const char* meaning, NewArguments& arguments) {
  CLI::App* of_kind = command.add_subcommand(kind, meaning);
  add_log_level_option(*of_kind);
  of_kind->add_option("NAME", arguments.name, "name of the world, vehicle or program, and of its file or folder")
      ->required()
      ->check(CLI::Validator(check_name, ""));
  of_kind->add_option("--folder", arguments.folder, "folder to write to")->type_name("DIR")->capture_default_str();
  return of_kind;
}

}  // namespace

static void add_new_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("new");
  command->require_subcommand(1);
  const auto arguments = std::make_shared<NewArguments>();
  // World.
  CLI::App* world = add_kind(*command, "world", "A world with one vehicle", *arguments);
  world
      ->add_option("--vehicle", arguments->vehicle,
                   "vehicle file, relative to the world; unset: a shipped rover or AUV")
      ->type_name("FILE");
  world->add_flag("--under-water", arguments->under_water, "an AUV in the sea instead of a rover on land");
  const std::vector<std::pair<int, std::string>> exit_codes = {
      {0, "written"}, {2, "wrong usage"}, {4, "the file already exists, or cannot be written"}};
  command_line::set_help_end(*world, {{"shoal new world yard", "shoal new world bay --under-water",
                                       "shoal new world pit --vehicle digger.yaml"},
                                      exit_codes,
                                      {}});
  world->callback([arguments, &exit_code] { exit_code = new_world(*arguments); });
  // Vehicle.
  CLI::App* vehicle =
      add_kind(*command, "vehicle", "A rover with two driven wheels and a lidar, or an AUV", *arguments);
  vehicle->add_flag("--under-water", arguments->under_water, "an AUV instead of a rover");
  command_line::set_help_end(*vehicle,
                             {{"shoal new vehicle digger", "shoal new vehicle fish --under-water"}, exit_codes, {}});
  vehicle->callback([arguments, &exit_code] {
    exit_code = write_yaml(*arguments, start_vehicle(arguments->name, arguments->under_water, schema_file("vehicle")));
  });
  // Program.
  CLI::App* program = add_kind(*command, "program", "A program that drives a vehicle in lockstep", *arguments);
  program->add_flag("--python", arguments->python, "in Python, instead of C++");
  program->add_option("--vehicle", arguments->vehicle, "name of the vehicle in its world; unset: rover1")
      ->type_name("NAME");
  command_line::set_help_end(
      *program, {{"shoal new program pilot", "shoal new program pilot --python --vehicle digger1"}, exit_codes, {}});
  program->callback([arguments, &exit_code] {
    if (arguments->vehicle.empty()) arguments->vehicle = "rover1";
    exit_code = new_program(*arguments);
  });
  // End of the help.
  command_line::set_help_end(*command,
                             {{"shoal new world yard", "shoal new vehicle digger", "shoal new program pilot --python"},
                              exit_codes,
                              {"Existing files are never overwritten."}});
}

SHOAL_COMMAND(make, "new", "Write a world, a vehicle or a program to start with", add_new_command);

}  // namespace tools
