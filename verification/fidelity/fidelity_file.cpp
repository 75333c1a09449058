// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "verification/fidelity/fidelity.hpp"

namespace verification {

namespace {

struct TrimEntry {
  double heave_m = 0, pitch_rad = 0;
  void read(sim::ParamReader& in) {
    in.read("heave_m", heave_m, sim::between(-100, 100), "down, of the origin");
    in.read_deg("pitch_deg", pitch_rad, sim::between(-45, 45), "bow up");
  }
};

struct CaseEntry {
  std::string name, text, reference;
  TrimEntry trim;
  sim::ConfigNode world, overrides;
  FidelityBars bars;
  sim::SourcePlace place;
  void read(sim::ParamReader& in) {
    if (!in.describing()) place = in.node()->place;
    in.require("name");
    in.read_name("name", name, "name of the case");
    in.read("text", text, "a sentence for the report");
    in.require("reference");
    in.read("reference", reference, "CSV file, relative to the folder of this file");
    in.read_raw("world", world, "dotted path: value, changes of the world, beside those of the group");
    in.read_raw("overrides", overrides, "dotted path: value, changes of the vehicle, beside those of the group");
    in.read("bars", bars, "instead of the group's");
    in.read("trim", trim, "offset of heave and pitch in the reference, when its level at rest is not 0");
  }
};

struct GroupEntry {
  std::string name, title, vehicle;
  sim::ConfigNode world, overrides;
  double step_s = 0.005;
  std::vector<FidelityInput> inputs;
  FidelityBars bars;
  std::vector<CaseEntry> cases;
  sim::SourcePlace vehicle_place;
  void read(sim::ParamReader& in) {
    in.require("name");
    in.read_name("name", name, "name of the group");
    in.read("title", title, "heading in the report");
    in.require("vehicle");
    in.read("vehicle", vehicle, "vehicle file, relative to the folder of this file");
    if (const sim::ConfigNode* node = in.has("vehicle") ? in.child("vehicle") : nullptr) vehicle_place = node->place;
    in.read_raw("world", world, "dotted path: value, such as `physics.gravity_mps2: 9.82`");
    in.read_raw("overrides", overrides, "dotted path: value, changes of the vehicle");
    in.read("step_s", step_s, sim::above(0),
            "time step; the comparison extrapolates from it and half of it to step zero");
    in.read_list("inputs", inputs, "input", "how columns command devices");
    in.read("bars", bars, "largest differences");
    in.read_list("cases", cases, "case", "trajectories");
  }
};

struct CaseFile {
  int shoal = 1;
  std::string text;
  std::vector<FidelityWithoutEffect> without_effect;
  std::vector<GroupEntry> groups;
  void read(sim::ParamReader& in) {
    in.read("shoal", shoal, sim::between(1, 1), "version of the format");
    in.read("text", text, "Markdown for the top of the report");
    in.read_list("without_effect", without_effect, "coefficient", "coefficients that no case can detect");
    in.require("groups");
    in.read_list("groups", groups, "group", "vehicles with their cases");
  }
};

void append(sim::ConfigNode& to, const sim::ConfigNode& more) {
  if (more.kind != sim::ConfigNode::Kind::map) return;
  if (to.kind != sim::ConfigNode::Kind::map) to = {};
  to.kind = sim::ConfigNode::Kind::map;
  for (const sim::ConfigNode::Entry& entry : more.entries) {
    std::erase_if(to.entries, [&](const auto& known) { return known.key == entry.key; });
    to.entries.push_back(entry);
  }
}

FidelityBars over(const FidelityBars& bars, const FidelityBars& usual) {
  FidelityBars both = bars;
  for (const auto bar : {&FidelityBars::position_rms_m, &FidelityBars::position_max_m, &FidelityBars::velocity_rms_mps,
                         &FidelityBars::turn_rms_degps, &FidelityBars::heading_rms_deg})
    if (!(both.*bar)) both.*bar = usual.*bar;
  return both;
}

}  // namespace

void FidelityInput::read(sim::ParamReader& in) {
  if (!in.describing()) place = in.node()->place;
  in.require("device");
  in.read_name("device", device, "device of the vehicle");
  in.read("message", message, "type of its commands");
  in.read("column", column, "column that gives `value`");
  in.read_raw("fields", fields, "fields of the message, with names of columns for numbers; instead of `column`");
  in.read("scale", scale, sim::any_number(), "times the columns: 57.29577951308232 makes degrees of radians");
  if (!in.describing() && in.has("column") == in.has("fields")) in.error("one of 'column' and 'fields' must be given");
}

void FidelityWithoutEffect::read(sim::ParamReader& in) {
  in.require("coefficient");
  in.read("coefficient", coefficient, "its name in the table of `--mutate`");
  in.require("why");
  in.read("why", why, "why it affects no motion");
}

void FidelityBars::read(sim::ParamReader& in) {
  in.read("position_rms_m", position_rms_m, sim::at_least(0), "root mean square of the distance");
  in.read("position_max_m", position_max_m, sim::at_least(0), "largest distance");
  in.read("velocity_rms_mps", velocity_rms_mps, sim::at_least(0), "root mean square of the velocity's difference");
  in.read("turn_rms_degps", turn_rms_degps, sim::at_least(0), "root mean square of the angular rate's difference");
  in.read("heading_rms_deg", heading_rms_deg, sim::at_least(0), "root mean square of the yaw's difference");
}

FidelityFile read_fidelity_file(const std::string& path) {
  // Read the file.
  sim::Diagnostics diagnostics;
  const sim::ConfigNode tree = sim::load_config_file(path, diagnostics);
  diagnostics.throw_if_any();
  CaseFile file;
  sim::ParamReader in(tree, "", diagnostics);
  file.read(in);
  in.finish();
  diagnostics.throw_if_any();
  // Merge each case with the defaults of its group.
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  FidelityFile result{file.text, file.without_effect, {}};
  for (const GroupEntry& group : file.groups)
    for (const CaseEntry& entry : group.cases) {
      FidelityCase of;
      of.name = entry.name;
      of.place = entry.place;
      of.vehicle_place = group.vehicle_place;
      of.text = entry.text;
      of.group = group.name;
      of.title = group.title.empty() ? group.name : group.title;
      of.vehicle = (folder / group.vehicle).lexically_normal().string();
      of.reference = (folder / entry.reference).lexically_normal().string();
      append(of.world, group.world);
      append(of.world, entry.world);
      append(of.overrides, group.overrides);
      append(of.overrides, entry.overrides);
      of.step_s = group.step_s;
      of.inputs = group.inputs;
      of.bars = over(entry.bars, group.bars);
      of.trim_heave_m = entry.trim.heave_m;
      of.trim_pitch_rad = entry.trim.pitch_rad;
      result.cases.push_back(std::move(of));
    }
  return result;
}

}  // namespace verification
