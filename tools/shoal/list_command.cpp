// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <iostream>
#include <memory>

#include "experiment/world_files/world_by_name.hpp"
#include "shoal/message_schema.hpp"
#include "sim/base/text_layout.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

/// Prints names and descriptions, in the width of the terminal.
void print_rows(const Rows& rows) {
  std::cout << sim::two_columns(rows, static_cast<std::size_t>(sim::text_columns(STDOUT_FILENO)));
}

void print_shipped(experiment::ShippedKind kind) {
  Rows rows;
  for (const experiment::ShippedFile& file : experiment::shipped_files(kind))
    rows.emplace_back(file.name, sim::printable(file.description));
  print_rows(rows);
}

void print_devices() {
  Rows rows;
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    rows.emplace_back(type->name, type->meaning);
  print_rows(rows);
}

void print_messages() {
  for (const auto& [name, schema] : shoal::embedded_types().all()) {
    char fingerprint[20];
    std::snprintf(fingerprint, sizeof fingerprint, "%016llx", static_cast<unsigned long long>(schema.fingerprint));
    std::cout << fingerprint << "  " << name << '\n';
  }
}

int list(const std::string& what) {
  const bool shipped = what != "devices" && what != "messages";
  if (shipped && sim::shipped_folder().empty()) {
    std::cerr << "shoal list: this program finds no shipped worlds: there is neither share/shoal beside its folder nor "
                 "a checkout that it was built from\n";
    return exit_bus;
  }
  if (what == "devices") print_devices();
  if (what == "messages") print_messages();
  if (what == "worlds") print_shipped(experiment::ShippedKind::world);
  if (what == "vehicles") print_shipped(experiment::ShippedKind::vehicle);
  if (what == "studies") print_shipped(experiment::ShippedKind::study);
  if (!what.empty()) return exit_ok;
  std::cout << "Worlds, for `shoal run NAME`:\n";
  print_shipped(experiment::ShippedKind::world);
  std::cout << "\nStudies, for `shoal study NAME`:\n";
  print_shipped(experiment::ShippedKind::study);
  std::cout << "\nVehicles, for `file: NAME.yaml` in a world:\n";
  print_shipped(experiment::ShippedKind::vehicle);
  std::cout << "\nThe files are in " << sim::shipped_folder() << "\n";
  return exit_ok;
}

}  // namespace

static void add_list_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("list");
  add_log_level_option(*command);
  const auto what = std::make_shared<std::string>();
  command->add_option("WHAT", *what, "worlds, vehicles, studies, devices or messages; unset: worlds, studies, vehicles")
      ->check(one_of({"worlds", "vehicles", "studies", "devices", "messages"}).description(""));
  add_plugin_option(*command);
  command_line::set_help_end(*command, {{"shoal list", "shoal list devices"},
                                        {{0, "success"}, {2, "wrong usage"}, {4, "no shipped files were found"}},
                                        {}});
  command->callback([what, &exit_code] { exit_code = list(*what); });
}

SHOAL_COMMAND(make, "list", "List shipped worlds and vehicles, device types or message types", add_list_command);

}  // namespace tools
