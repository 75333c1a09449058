#include "tools/experiment/fidelity.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "shoal/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/config/message_text.hpp"
#include "sim/world/load_world.hpp"
#include "sim/world/world.hpp"

namespace tools {

namespace {

constexpr double deg = std::numbers::pi / 180;

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
  void read(sim::ParamReader& in) {
    in.require("name");
    in.read_name("name", name, "of the case");
    in.read("text", text, "a sentence for the report");
    in.require("reference");
    in.read("reference", reference, "CSV file, from the folder of this file");
    in.read_raw("world", world, "dotted path: value, changes of the world, beside those of the group");
    in.read_raw("overrides", overrides, "dotted path: value, changes of the vehicle, beside those of the group");
    in.read("bars", bars, "instead of the group's");
    in.read("trim", trim, "where the reference counts heave and pitch from, when its level at rest is not 0");
  }
};

struct GroupEntry {
  std::string name, title, vehicle;
  sim::ConfigNode world, overrides;
  double step_s = 0.005;
  std::vector<FidelityInput> inputs;
  FidelityBars bars;
  std::vector<CaseEntry> cases;
  void read(sim::ParamReader& in) {
    in.require("name");
    in.read_name("name", name, "of the group");
    in.read("title", title, "heading in the report");
    in.require("vehicle");
    in.read("vehicle", vehicle, "vehicle file, from the folder of this file");
    in.read_raw("world", world, "dotted path: value, such as `physics.gravity_mps2: 9.82`");
    in.read_raw("overrides", overrides, "dotted path: value, changes of the vehicle");
    in.read("step_s", step_s, sim::above(0), "time step");
    in.read_list("inputs", inputs, "input", "how columns command devices");
    in.read("bars", bars, "largest differences");
    in.read_list("cases", cases, "case", "trajectories");
  }
};

struct CaseFile {
  int shoal = 1;
  std::string text;
  std::vector<GroupEntry> groups;
  void read(sim::ParamReader& in) {
    in.read("shoal", shoal, sim::between(1, 1), "version of the format");
    in.read("text", text, "Markdown for the top of the report");
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
                         &FidelityBars::heading_rms_deg})
    if (!(both.*bar)) both.*bar = usual.*bar;
  return both;
}

[[noreturn]] void fail(const std::string& file, int line, const std::string& text) {
  sim::throw_config_error({sim::intern_file_name(file), line, line > 0 ? 1 : 0}, "", text);
}

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != ' ' && c != '\t' && c != '"') {
      cells.back() += c;
    }
  }
  return cells;
}

std::string list_of(std::initializer_list<double> values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + sim::number_text(value);
  return text + "]";
}

sim::Vector3d flipped(const sim::Vector3d& v) {
  return {v.x(), -v.y(), -v.z()};
}

FidelityState state_of(const sim::Body& body) {
  const sim::Pose X_WB = body.X_WB();
  const sim::Matrix3d R = X_WB.linear();
  const sim::Vector3d p = X_WB.translation(), v = flipped(R.transpose() * body.v_WB_W()),
                      w = flipped(R.transpose() * body.w_WB_W());
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  return {p.y(), p.x(), -p.z(), std::atan2(R(2, 1), R(2, 2)), -pitch, std::numbers::pi / 2 - yaw, v.x(), v.y(), v.z(),
          w.x(), w.y(), w.z()};
}

/// The velocity that a row starts with.  Vehicles of several bodies start as one solid.
void set_velocity(const sim::Vehicle& vehicle, const FidelityState& start) {
  const sim::Body& first = vehicle.base();
  const sim::Matrix3d R = first.X_WB().linear();
  const sim::Vector3d v = R * flipped({start[6], start[7], start[8]}),
                      w = R * flipped({start[9], start[10], start[11]});
  const sim::Vector3d origin = first.X_WB().translation();
  for (const auto& [name, body] : vehicle.bodies())
    body->set_velocity_W(v + w.cross(body->X_WB().translation() - origin), w);
}

/// `fields` with the numbers of a row in place of the names of columns.
void fill_in(sim::ConfigNode& node, const FidelityReference& reference, const std::vector<double>& row, double scale) {
  for (sim::ConfigNode& item : node.items) fill_in(item, reference, row, scale);
  for (sim::ConfigNode::Entry& entry : node.entries) fill_in(entry.value, reference, row, scale);
  if (node.kind != sim::ConfigNode::Kind::scalar || node.scalar.empty()) return;
  const bool number = std::string("+-.0123456789").find(node.scalar.front()) != std::string::npos;
  if (!number && !node.quoted)
    node = sim::scalar_node(sim::number_text(scale * row[reference.column(node.scalar)]), node.place);
}

void send_inputs(const FidelityCase& of, const FidelityReference& reference, const std::vector<double>& row,
                 const std::string& vehicle, sim::World& world) {
  for (const FidelityInput& input : of.inputs) {
    if (world.find_device(vehicle + "/" + input.device) == nullptr)
      fail(of.vehicle, 0, "there is no device '" + input.device + "'");
    sim::ConfigNode fields = input.fields;
    if (!input.column.empty()) fields = sim::map_node("value", sim::scalar_node(input.column, {}));
    fill_in(fields, reference, row, input.scale);
    sim::Diagnostics diagnostics;
    const sim::Bytes bytes = shoal::encode_own_message(input.message, fields, diagnostics);
    diagnostics.throw_if_any();
    world.publish(vehicle + "." + input.device + ".cmd", bytes);
  }
}

double norm_of(const FidelityState& a, const FidelityState& b, std::size_t from) {
  return std::hypot(a[from] - b[from], a[from + 1] - b[from + 1], a[from + 2] - b[from + 2]);
}

void compare(FidelityResult& result) {
  double position = 0, velocity = 0, turn = 0, heading = 0;
  for (std::size_t i = 0; i < result.t.size(); ++i) {
    const FidelityState &a = result.theirs[i], &b = result.ours[i];
    const double apart = norm_of(a, b, 0);
    position += apart * apart;
    result.position_max_m = std::max(result.position_max_m, apart);
    velocity += std::pow(norm_of(a, b, 6), 2);
    turn += std::pow(norm_of(a, b, 9), 2);
    heading += std::pow(std::remainder(a[5] - b[5], 2 * std::numbers::pi), 2);
    if (i > 0) result.path_m += norm_of(a, result.theirs[i - 1], 0);
  }
  const auto count = static_cast<double>(result.t.size());
  result.position_rms_m = std::sqrt(position / count);
  result.velocity_rms_mps = std::sqrt(velocity / count);
  result.turn_rms_degps = std::sqrt(turn / count) / deg;
  result.heading_rms_deg = std::sqrt(heading / count) / deg;
  const auto check = [&](const char* name, double value, const std::optional<double>& bar) {
    // Not `value > bar`: a value that is no number has missed it.
    if (bar && !(value <= *bar))
      result.missed.push_back(std::string(name) + " " + sim::number_text(value) + " > " + sim::number_text(*bar));
  };
  check("position_rms_m", result.position_rms_m, result.of.bars.position_rms_m);
  check("position_max_m", result.position_max_m, result.of.bars.position_max_m);
  check("velocity_rms_mps", result.velocity_rms_mps, result.of.bars.velocity_rms_mps);
  check("heading_rms_deg", result.heading_rms_deg, result.of.bars.heading_rms_deg);
}

std::int64_t steps_to(double t, double step_s, const FidelityReference& reference) {
  const auto steps = static_cast<std::int64_t>(std::llround(t / step_s));
  if (std::abs(static_cast<double>(steps) * step_s - t) > 1e-7)
    fail(reference.file, 0,
         "a step of " + sim::number_text(step_s) + " s does not meet the row at t = " + sim::number_text(t) + " s");
  return steps;
}

}  // namespace

void FidelityInput::read(sim::ParamReader& in) {
  in.require("device");
  in.read_name("device", device, "of the vehicle");
  in.read("message", message, "type of its commands");
  in.read("column", column, "column that becomes `value`");
  in.read_raw("fields", fields, "of the message, with names of columns for numbers; instead of `column`");
  in.read("scale", scale, sim::any_number(), "times the columns: 57.29577951308232 makes degrees of radians");
  if (!in.describing() && in.has("column") == in.has("fields")) in.error("one of 'column' and 'fields' must be given");
}

void FidelityBars::read(sim::ParamReader& in) {
  in.read("position_rms_m", position_rms_m, sim::at_least(0), "root mean square of the distance");
  in.read("position_max_m", position_max_m, sim::at_least(0), "largest distance");
  in.read("velocity_rms_mps", velocity_rms_mps, sim::at_least(0), "root mean square of the velocity's difference");
  in.read("heading_rms_deg", heading_rms_deg, sim::at_least(0), "root mean square of the yaw's difference");
}

FidelityFile read_fidelity_file(const std::string& path) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode tree = sim::load_config_file(path, diagnostics);
  diagnostics.throw_if_any();
  CaseFile file;
  sim::ParamReader in(tree, "", diagnostics);
  file.read(in);
  in.finish();
  diagnostics.throw_if_any();
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  FidelityFile result{file.text, {}};
  for (const GroupEntry& group : file.groups)
    for (const CaseEntry& entry : group.cases) {
      FidelityCase of;
      of.name = entry.name;
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

std::size_t FidelityReference::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end())
    fail(file, 1,
         "there is no column '" + sim::shortened(sim::printable(name)) + "'; there are " + sim::list_text(columns));
  return static_cast<std::size_t>(found - columns.begin());
}

FidelityReference read_fidelity_reference(const std::string& path) {
  FidelityReference reference;
  reference.file = path;
  std::ifstream in(path);
  std::string line;
  if (!in || !std::getline(in, line)) fail(path, 0, "cannot be read");
  for (const std::string& name : cells_of(line)) reference.columns.push_back(name.substr(0, name.find('[')));
  for (int number = 2; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r") continue;
    std::vector<double> row;
    for (const std::string& cell : cells_of(line)) {
      double value = 0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
        fail(path, number, "must have finite numbers, got '" + sim::shortened(sim::printable(cell)) + "'");
      row.push_back(value);
    }
    if (row.size() != reference.columns.size())
      fail(path, number,
           "must have " + std::to_string(reference.columns.size()) + " numbers, got " + std::to_string(row.size()));
    if (!reference.rows.empty() && !(row[0] > reference.rows.back()[0])) fail(path, number, "the time must rise");
    reference.rows.push_back(std::move(row));
  }
  if (reference.columns.front() != "t") fail(path, 1, "the first column must be t");
  if (reference.rows.empty() || reference.rows.front().front() != 0) fail(path, 2, "the first row must be at t = 0");
  return reference;
}

namespace {

FidelityState state_of(const FidelityCase& of, const FidelityReference& reference, const std::vector<double>& row) {
  FidelityState state;
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = row[reference.column(fidelity_states[i])];
  state[2] -= of.trim_heave_m;
  state[4] -= of.trim_pitch_rad;
  return state;
}

}  // namespace

std::string fidelity_world(const FidelityCase& of, const FidelityReference& reference, const FidelityOptions& options) {
  const FidelityState start = state_of(of, reference, reference.rows.front());
  const std::string text = "shoal: 1\nname: " + of.name +
                           "\nphysics: {step_s: " + sim::number_text(options.step_s.value_or(of.step_s)) +
                           "}\nmedium: {water: {}}\nvehicles:\n  - name: vehicle\n    file: " +
                           std::filesystem::path(of.vehicle).filename().string() +
                           "\n    position_m: " + list_of({start[1], start[0], -start[2]}) +
                           "\n    rpy_deg: " + list_of({start[3] / deg, -start[4] / deg, 90 - start[5] / deg}) + "\n";
  sim::Diagnostics diagnostics;
  sim::ConfigNode world = sim::parse_config_text(text, of.name, diagnostics);
  for (const sim::ConfigNode::Entry& change : of.world.entries)
    sim::set_config_path(world, change.key, change.value, change.place, diagnostics);
  sim::ConfigNode overrides = of.overrides;
  for (const auto& [path, value] : options.overrides)
    append(overrides, sim::map_node(path, sim::parse_config_text(value, path, diagnostics)));
  if (!overrides.entries.empty())
    sim::set_config_path(world, "vehicles.vehicle.overrides", overrides, overrides.place, diagnostics);
  diagnostics.throw_if_any();
  return sim::to_yaml(world);
}

FidelityResult run_fidelity_case(const FidelityCase& of, const FidelityOptions& options) {
  const FidelityReference reference = read_fidelity_reference(of.reference);
  const std::string folder = std::filesystem::path(of.vehicle).parent_path().string();
  const sim::LoadedWorld loaded =
      sim::load_world_text(fidelity_world(of, reference, options), folder + "/" + of.name + ".yaml");
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus);
  const sim::Vehicle& vehicle = *world.vehicles().front();
  set_velocity(vehicle, state_of(of, reference, reference.rows.front()));

  FidelityResult result;
  result.of = of;
  result.step_s = options.step_s.value_or(of.step_s);
  for (std::size_t k = 0; k < reference.rows.size(); ++k) {
    const std::vector<double>& row = reference.rows[k];
    for (std::int64_t end = steps_to(row[0], result.step_s, reference); world.step_number() < end;) world.step();
    result.t.push_back(row[0]);
    result.theirs.push_back(state_of(of, reference, row));
    result.ours.push_back(state_of(vehicle.base()));
    send_inputs(of, reference, row, vehicle.name(), world);
  }
  compare(result);
  return result;
}

}  // namespace tools
