// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/new_command.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "sim/config/shipped_files.hpp"
#include "tools/shoal/commands.hpp"
#include "tools/shoal/output_file.hpp"
#include "tools/shoal/start_files.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

struct NewArguments {
  std::string name;
  std::string folder = ".";
  std::string vehicle;
  bool under_water = false;
};

std::string check_name(const std::string& name) {
  const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  return plain ? "" : "must be made of letters, digits, '_' and '-', got '" + name + "'";
}

/// Of the shipped schemas; empty: there are none.
std::string schema_file(const std::string& kind) {
  if (sim::shipped_folder().empty()) return "";
  const fs::path file = fs::path(sim::shipped_folder()) / "docs/reference/schema" / (kind + ".schema.json");
  std::error_code error;
  return fs::is_regular_file(file, error) ? file.string() : "";
}

int write_start(const NewArguments& arguments, const std::string& text) {
  const std::string path = (fs::path(arguments.folder) / (arguments.name + ".yaml")).lexically_normal().string();
  std::error_code error;
  if (fs::exists(path, error)) throw std::runtime_error(path + ": is there already; take another name or folder");
  check_writable(path);
  std::ofstream out(path, std::ios::binary);
  if (!(out << text << std::flush)) throw std::runtime_error(path + ": cannot be written");
  std::cout << path << ": written; `shoal check " << path << "` checks it\n";
  return exit_ok;
}

int new_world(const NewArguments& arguments) {
  const std::string vehicle = !arguments.vehicle.empty() ? arguments.vehicle
                              : arguments.under_water    ? "remus100_survey.yaml"
                                                         : "rover.yaml";
  const std::string schema = schema_file("world");
  return write_start(arguments, arguments.under_water ? start_sea(arguments.name, vehicle, schema)
                                                      : start_world(arguments.name, vehicle, schema));
}

CLI::App* add_kind(CLI::App& command, const char* kind, const char* meaning, NewArguments& arguments) {
  CLI::App* of_kind = command.add_subcommand(kind, meaning);
  add_log_level_option(*of_kind);
  of_kind->add_option("NAME", arguments.name, "name, and name of the file: NAME.yaml")
      ->required()
      ->check(CLI::Validator(check_name, ""));
  of_kind->add_option("--folder", arguments.folder, "where the file is written")
      ->type_name("DIR")
      ->capture_default_str();
  return of_kind;
}

}  // namespace

void add_new_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("new", "Write a commented world or vehicle file to begin with");
  command->require_subcommand(1);
  const auto arguments = std::make_shared<NewArguments>();
  CLI::App* world = add_kind(*command, "world", "A world of one vehicle", *arguments);
  world
      ->add_option("--vehicle", arguments->vehicle,
                   "vehicle file, from where the world is; unset: a shipped rover or AUV")
      ->type_name("FILE");
  world->add_flag("--under-water", arguments->under_water, "an AUV in the sea instead of a rover on land");
  const std::vector<std::pair<int, std::string>> exit_codes = {
      {0, "written"}, {2, "wrong usage"}, {4, "the file is there already, or cannot be written"}};
  command_line::set_help_end(*world, {{"shoal new world yard", "shoal new world bay --under-water",
                                       "shoal new world pit --vehicle digger.yaml"},
                                      exit_codes,
                                      {}});
  world->callback([arguments, &exit_code] { exit_code = new_world(*arguments); });
  CLI::App* vehicle = add_kind(*command, "vehicle", "A rover of two driven wheels with a lidar", *arguments);
  command_line::set_help_end(*vehicle, {{"shoal new vehicle digger"}, exit_codes, {}});
  vehicle->callback([arguments, &exit_code] {
    exit_code = write_start(*arguments, start_vehicle(arguments->name, schema_file("vehicle")));
  });
  command_line::set_help_end(*command, {{"shoal new world yard", "shoal new vehicle digger"},
                                        exit_codes,
                                        {"A file that is there already is not touched."}});
}

}  // namespace tools
