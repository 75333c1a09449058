#include <unistd.h>

#include <iostream>
#include <memory>
#include <sstream>

#include "shoal/message_schema.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/shipped_files.hpp"
#include "sim/device/device_registry.hpp"
#include "tools/experiment/world_by_name.hpp"
#include "tools/shoal/commands.hpp"

namespace tools {

namespace {

constexpr std::size_t name_width = 20;
constexpr std::size_t line_width = 80;

/// `name    what it means`; on a terminal wrapped under itself, else on one line for other programs.
void print_entry(const std::string& name, const std::string& meaning) {
  std::string line = name + std::string(name_width - std::min(name_width - 1, name.size()), ' ');
  const bool wraps = isatty(STDOUT_FILENO) != 0;
  bool first = true;
  std::istringstream words(meaning);
  for (std::string word; words >> word; first = false) {
    if (wraps && !first && line.size() + 1 + word.size() > line_width) {
      std::cout << line << '\n';
      line = std::string(name_width, ' ');
      first = true;
    }
    line += (first ? "" : " ") + word;
  }
  std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
}

void print_shipped(ShippedKind kind) {
  for (const ShippedFile& file : shipped_files(kind)) print_entry(file.name, sim::printable(file.description));
}

void print_devices() {
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all()) print_entry(type->name, type->meaning);
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
  if (what == "worlds") print_shipped(ShippedKind::world);
  if (what == "vehicles") print_shipped(ShippedKind::vehicle);
  if (what == "studies") print_shipped(ShippedKind::study);
  if (!what.empty()) return exit_ok;
  std::cout << "Worlds, for `shoal run NAME`:\n";
  print_shipped(ShippedKind::world);
  std::cout << "\nStudies, for `shoal study NAME`:\n";
  print_shipped(ShippedKind::study);
  std::cout << "\nVehicles, for `file: NAME.yaml` in a world:\n";
  print_shipped(ShippedKind::vehicle);
  std::cout << "\nThe files are in " << sim::shipped_folder() << "\n";
  return exit_ok;
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("list", "List shipped worlds and vehicles, device types or message types");
  const auto what = std::make_shared<std::string>();
  command->add_option("WHAT", *what, "worlds, vehicles, studies, devices or messages; unset: worlds, studies, vehicles")
      ->check(CLI::IsMember({"worlds", "vehicles", "studies", "devices", "messages"}));
  add_plugin_option(*command);
  command->footer("Examples:\n  shoal list\n  shoal list devices");
  command->callback([what, &exit_code] { exit_code = list(*what); });
}

}  // namespace tools
