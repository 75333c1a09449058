// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_arguments.hpp"

#include <algorithm>
#include <cmath>

#include "sim/config/config_node.hpp"
#include "sim/config/param_reader.hpp"

namespace navigation {

namespace {

NavArguments read_arguments(const sim::ConfigNode& args) {
  static constexpr std::string_view known[] = {"start_m", "start_std_m", "period_s", "sound"};
  sim::ConfigNode own;
  own.kind = sim::ConfigNode::Kind::map;
  for (const sim::ConfigNode::Entry& entry : args.entries)
    if (std::find(std::begin(known), std::end(known), entry.key) != std::end(known)) own.entries.push_back(entry);
  // The run has checked them.
  sim::Diagnostics ignored;
  NavArguments arguments;
  std::vector<double> start_m;
  std::optional<double> period_s;
  std::string sound;
  sim::ParamReader in(own, "args", ignored);
  in.read("start_m", start_m, sim::any_place(), "");
  in.read("start_std_m", arguments.start_std_m, sim::between(0.001, 10'000), "");
  in.read("period_s", period_s, sim::between(0.001, 10), "");
  in.read("sound", sound, "");
  if (start_m.size() == 2) arguments.start_m.emplace(start_m[0], start_m[1]);
  if (period_s) arguments.period_us = std::llround(1e6 * *period_s);
  if (const auto model = sound_models().find(sound); model != sound_models().end()) arguments.sound = model->second;
  return arguments;
}

}  // namespace

const std::map<std::string, SoundModel>& sound_models() {
  static const std::map<std::string, SoundModel> models = {{"straight", SoundModel::straight},
                                                           {"rays", SoundModel::rays}};
  return models;
}

NavOptions NavArguments::applied_to(NavOptions options) const {
  if (start_m) options.start.p_W = start_m;
  options.start.std_m = start_std_m.value_or(options.start.std_m);
  options.period_us = period_us.value_or(options.period_us);
  options.sound = sound.value_or(options.sound);
  return options;
}

std::map<std::string, NavArguments> nav_arguments_of(const std::string& resolved_world) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode world = sim::parse_config_text(resolved_world, "sim.info", diagnostics);
  diagnostics.throw_if_any();
  std::map<std::string, NavArguments> by_vehicle;
  const sim::ConfigNode* processes = world.find("processes");
  if (processes == nullptr) return by_vehicle;
  for (const sim::ConfigNode& process : processes->items) {
    const sim::ConfigNode* program = process.find("program");
    const sim::ConfigNode* args = process.find("args");
    if (program == nullptr || program->scalar != "shoal-nav" || args == nullptr) continue;
    if (const sim::ConfigNode* name = args->find("name")) by_vehicle[name->scalar] = read_arguments(*args);
  }
  return by_vehicle;
}

}  // namespace navigation
