// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <set>

#include "experiment/process/process_check.hpp"
#include "experiment/process/world_programs.hpp"
#include "experiment/study/load_study.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/camera/texture.hpp"
#include "sim/config/message_text.hpp"
#include "sim/hydrodynamics/level_speed.hpp"
#include "sim/motion/motion.hpp"
#include "sim/program/find_program.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world_file/file_kind.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/shoal/commands/commands.hpp"

namespace tools {

namespace {

sim::ConfigNode keys_of(const std::string& path, const sim::LoadOptions& options) {
  sim::Diagnostics ignored(sim::files_of(path, options));
  return sim::load_config_file(path, ignored);
}

/// Decodes every texture, as the first camera does.
void check_textures(const sim::WorldConfig& world) {
  sim::TextureLibrary textures;
  const auto check_all = [&](const std::vector<sim::MaterialConfig>& materials) {
    for (const sim::MaterialConfig& material : materials)
      textures.get(material.texture, "material '" + material.name + "'");
  };
  check_all(world.materials);
  for (const sim::VehicleInstance& vehicle : world.vehicles) check_all(vehicle.config->materials);
}

/// Returns `1 body`, `3 bodies`.
std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + ' ' + (count == 1 ? word : sim::plural_of(word));
}

std::size_t device_count(const sim::WorldConfig& world) {
  std::size_t count = 0;
  for (const sim::VehicleInstance& vehicle : world.vehicles) count += vehicle.config->devices.size();
  return count;
}

/// Prints the speed at which a vehicle that is pushed, but has nothing that keeps it level, turns over.
void print_tipping(const sim::VehicleConfig& vehicle) {
  const auto has = [&](const char* type) {
    return std::any_of(vehicle.devices.begin(), vehicle.devices.end(),
                       [type](const sim::DeviceConfig& device) { return device.type == type; });
  };
  if (has("autopilot") || has("fin") || !(has("thruster") || has("body_wrench"))) return;
  for (const sim::BodyConfig& body : vehicle.bodies) {
    if (!body.hydrodynamics || body.hydrodynamics->model == sim::HydrodynamicsConfig::Model::none ||
        body.hydrodynamics->waterline)
      continue;
    const double tipping = sim::tipping_mps(
        sim::CoefficientModel(*body.hydrodynamics, sim::PhysicsConfig{}.gravity_mps2), sim::LevelMotion::ahead);
    if (std::isinf(tipping)) continue;
    std::cout << "note: vehicle '" << vehicle.vehicle << "': nothing keeps it level: above "
              << sim::number_text(std::round(100 * tipping) / 100)
              << " m/s ahead, the Munk moment of its added mass turns it over (" << vehicle.description << ")\n";
  }
}

void print_notes(sim::World& world) {
  for (const std::string& note : world.warnings().building().notes()) std::cout << "note: " << note << '\n';
  std::set<const sim::VehicleConfig*> models;
  for (const sim::VehicleInstance& vehicle : world.config().vehicles)
    if (models.insert(vehicle.config.get()).second) print_tipping(*vehicle.config);
}

/// Builds a world, which finds errors that reading cannot: mesh files, bodies without mass.
std::size_t body_count(sim::LoadedWorld& loaded, sim::Warnings& warnings) {
  loaded.config.bodies_only_of_many = true;
  sim::StandaloneWorld world(loaded.config);
  print_notes(world);
  check_textures(loaded.config);
  experiment::warn_of_processes(loaded, warnings);
  experiment::warn_of_missing_programs(loaded, warnings);
  experiment::warn_of_unchecked_arguments(loaded, warnings);
  return world.physics().bodies().size();
}

/// Builds a vehicle with coefficients in deep water.
void check_in_water(sim::VehicleConfig vehicle, sim::LoadOptions options) {
  options.sets.clear();
  if (std::none_of(vehicle.bodies.begin(), vehicle.bodies.end(), [](const sim::BodyConfig& body) {
        return body.hydrodynamics && body.hydrodynamics->model != sim::HydrodynamicsConfig::Model::none;
      }))
    return;
  sim::LoadedWorld loaded = sim::load_world_text(
      "shoal: 1\nphysics: {step_s: 0.001}\nmedium: {water: {}}\n"
      "objects: [{name: bottom, fixed: true, position_m: [0, 0, -100], parts: [{shape: plane}]}]\n",
      "water.yaml", options);
  const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(loaded.config.categories, vehicle.categories);
  add(loaded.config.materials, vehicle.materials);
  add(loaded.config.contacts, vehicle.contacts);
  sim::VehicleInstance instance;
  instance.name = vehicle.vehicle;
  instance.X_WV.translation().z() = -10;
  instance.config = std::make_shared<sim::VehicleConfig>(std::move(vehicle));
  loaded.config.vehicles.push_back(std::move(instance));
  sim::Warnings warnings;
  body_count(loaded, warnings);
}

void check_study(const std::string& path, const sim::LoadOptions& options) {
  sim::Warnings warnings;
  experiment::StudyChanges changes;
  changes.load = options;
  changes.load.warnings = &warnings;
  changes.only_checked = true;
  experiment::LoadedStudy study = experiment::load_study(path, changes);
  for (sim::LoadedWorld& world : study.worlds) body_count(world, warnings);
  const experiment::StudyConfig& config = study.config;
  std::cout << path << ": study '" << config.name << "' of " << config.world_text() << ": "
            << counted(config.cases.size(), "case") << ", "
            << (config.factors.empty() ? "" : counted(study.points.size(), "point") + ", ")
            << counted(config.seeds.size(), "seed") << ", "
            << counted(config.cases.size() * study.points.size() * config.seeds.size(), "run") << ", "
            << counted(config.pass.size(), "rule") << '\n';
}

void check_motion(const std::string& path) {
  const sim::JointMotion motion = sim::load_motion(path);
  std::cout << path << ": motion '" << motion.name << "': " << counted(motion.tracks().size(), "joint") << ", "
            << counted(motion.keys.size(), "key") << ", " << sim::number_text(motion.end_s()) << " s\n";
}

void check_declaration(const std::string& path) {
  sim::Diagnostics diagnostics;
  const sim::ProgramDeclaration declaration = sim::read_declaration_file(path, diagnostics);
  diagnostics.throw_if_any();
  std::cout << path << ": declaration of program '" << declaration.program << "': " << declaration.args.size()
            << " arguments\n";
}

void check(const std::string& path, const sim::LoadOptions& options) {
  if (path.ends_with(sim::declaration_ending)) return check_declaration(path);
  const sim::FileKind kind = sim::kind_of_file(keys_of(path, options));
  if (kind == sim::FileKind::declaration) return check_declaration(path);
  if (kind == sim::FileKind::motion) return check_motion(path);
  if (kind == sim::FileKind::study) return check_study(path, options);
  if (kind == sim::FileKind::vehicle) {
    sim::VehicleConfig vehicle = sim::load_vehicle(path, options);
    std::cout << path << ": vehicle '" << vehicle.vehicle << "': " << counted(vehicle.bodies.size(), "body") << ", "
              << counted(vehicle.joints.size(), "joint") << ", " << counted(vehicle.devices.size(), "device") << '\n';
    return check_in_water(std::move(vehicle), options);
  }
  sim::LoadOptions with_messages = options;
  // Actions of events hold messages, which are encoded here so that mistakes in their fields are found.
  with_messages.encode_message = shoal::encode_own_message;
  // Without the resolved text, which only a run publishes.
  with_messages.resolve = false;
  sim::LoadedWorld loaded = sim::load_world(path, with_messages);
  experiment::read_programs(loaded, {true, options.allow_paths});
  sim::Warnings warnings;
  const std::size_t bodies = body_count(loaded, warnings);
  std::cout << path << ": world '" << loaded.config.name << "': " << counted(loaded.config.vehicles.size(), "vehicle")
            << ", " << counted(loaded.config.objects.size(), "object") << ", "
            << counted(device_count(loaded.config), "device") << ", " << counted(bodies, "body") << '\n';
}

}  // namespace

static void add_check_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.get_subcommand("check");
  const auto path = std::make_shared<std::string>();
  const auto options = std::make_shared<sim::LoadOptions>();
  add_log_level_option(*command);
  // Options.
  command
      ->add_option("FILE", *path,
                   "world, vehicle, study or motion file, the name of a shipped one, or a declaration NAME.args.yaml")
      ->required();
  add_set_option(*command, options->sets);
  add_allow_path_option(*command, *options);
  add_plugin_option(*command);
  // End of the help and action.
  command_line::set_help_end(
      *command, {{"shoal check worlds/coop_land.yaml --set run.seed=3", "shoal check worlds/studies/coop_land.yaml",
                  "shoal check pilot.args.yaml"},
                 {{0, "no mistake was found"}, {2, "wrong usage, or mistakes, each on its own line"}},
                 {"Every mistake is printed as file:line:column: who: rule, value.  Warnings have the "
                  "same form and leave the exit code at 0; see docs/reference/warnings.md."}});
  command->callback([path, options, &exit_code] {
    check(
        experiment::file_by_name(
            {experiment::ShippedKind::world, experiment::ShippedKind::vehicle, experiment::ShippedKind::study}, *path),
        *options);
    exit_code = exit_ok;
  });
}

SHOAL_COMMAND(run, "check", "Check a world, vehicle, study or motion file without running it", add_check_command);

}  // namespace tools
