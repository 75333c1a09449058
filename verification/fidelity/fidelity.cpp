// SPDX-License-Identifier: BSD-3-Clause
#include "verification/fidelity/fidelity.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "messages/yaml/message_writer.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world/standalone_world.hpp"
#include "sim/world/world_editor.hpp"
#include "sim/world_file/load_world.hpp"

namespace verification {

namespace {

constexpr double bottom_m = 11000;  ///< below the start of a vehicle

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

/// Sets the initial velocity of a row.  Vehicles of several bodies start as one rigid body.
void set_velocity(const sim::Vehicle& vehicle, const FidelityState& start) {
  const sim::Body& first = vehicle.base();
  const sim::Matrix3d R = first.X_WB().linear();
  const sim::Vector3d v = R * flipped({start[6], start[7], start[8]}),
                      w = R * flipped({start[9], start[10], start[11]});
  const sim::Vector3d origin = first.X_WB().translation();
  for (const auto& [name, body] : vehicle.bodies())
    body->set_velocity_W(v + w.cross(body->X_WB().translation() - origin), w);
}

/// Replaces the names of columns in `node` by the numbers of a row.
void fill_in(sim::ConfigNode& node, const FidelityReference& reference, const std::vector<double>& row, double scale) {
  for (sim::ConfigNode& item : node.items) fill_in(item, reference, row, scale);
  for (sim::ConfigNode::Entry& entry : node.entries) fill_in(entry.value, reference, row, scale);
  if (node.kind != sim::ConfigNode::Kind::scalar || node.scalar.empty()) return;
  const bool number = std::string("+-.0123456789").find(node.scalar.front()) != std::string::npos;
  if (!number && !node.quoted)
    node = sim::scalar_node(sim::number_text(scale * row[reference.column(node.scalar)]), node.place);
}

/// Returns `a, b, c`.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ',')
      words.emplace_back();
    else if (c != ' ')
      words.back() += c;
  }
  return words;
}

/// Checks that the devices of the inputs exist and accept their messages.  Throws ConfigError.
void check_inputs(const FidelityCase& of, const sim::Vehicle& vehicle) {
  const std::string who = "vehicle '" + vehicle.name() + "'";
  for (const FidelityInput& input : of.inputs) {
    std::vector<std::string> names;
    const sim::DeviceConfig* found = nullptr;
    for (const sim::DeviceConfig& device : vehicle.config().devices) {
      if (device.name == input.device) found = &device;
      names.push_back(device.name);
    }
    if (found == nullptr)
      sim::throw_config_error(input.place, who,
                              "there is no device '" + input.device + "'; devices: " + sim::list_text(names));
    const std::string& messages = found->device_type->command_messages;
    const std::vector<std::string> taken = words_of(messages);
    if (std::find(taken.begin(), taken.end(), input.message) == taken.end())
      sim::throw_config_error(input.place, who + ": device '" + input.device + "'",
                              (messages.empty() ? "takes no messages" : "takes " + messages) + ", not '" +
                                  sim::shortened(sim::printable(input.message)) + "'");
  }
}

void send_inputs(const FidelityCase& of, const FidelityReference& reference, const std::vector<double>& row,
                 const std::string& vehicle, sim::World& world) {
  for (const FidelityInput& input : of.inputs) {
    sim::ConfigNode fields = input.fields;
    if (!input.column.empty()) fields = sim::map_node("value", sim::scalar_node(input.column, input.place));
    fill_in(fields, reference, row, input.scale);
    sim::Diagnostics diagnostics;
    const sim::Bytes bytes = shoal::encode_own_message(input.message, fields, diagnostics);
    diagnostics.throw_if_any();
    world.editor().publish(vehicle + "." + input.device + ".cmd", bytes);
  }
}

double norm_of(const FidelityState& a, const FidelityState& b, std::size_t from) {
  return std::hypot(a[from] - b[from], a[from + 1] - b[from + 1], a[from + 2] - b[from + 2]);
}

/// Sums of squared differences over the rows so far.
struct Differences {
  double position = 0, velocity = 0, turn = 0, heading = 0;
};

void add_row(FidelityResult& result, Differences& sums, const FidelityState& theirs, const FidelityState& ours) {
  const double apart = norm_of(theirs, ours, 0);
  sums.position += apart * apart;
  sums.velocity += std::pow(norm_of(theirs, ours, 6), 2);
  sums.turn += std::pow(norm_of(theirs, ours, 9), 2);
  sums.heading += std::pow(std::remainder(theirs[5] - ours[5], 2 * std::numbers::pi), 2);
  result.position_max_m = std::max(result.position_max_m, apart);
  if (!result.theirs.empty()) result.path_m += norm_of(theirs, result.theirs.back(), 0);
  result.theirs.push_back(theirs);
  result.ours.push_back(ours);
}

/// Sets the root mean squares over `rows` rows and the missed bars.  Rows that are not yet there count as equal.
void compare(FidelityResult& result, const Differences& sums, std::size_t rows) {
  const auto count = static_cast<double>(rows);
  result.position_rms_m = std::sqrt(sums.position / count);
  result.velocity_rms_mps = std::sqrt(sums.velocity / count);
  result.turn_rms_degps = std::sqrt(sums.turn / count) / degree_rad;
  result.heading_rms_deg = std::sqrt(sums.heading / count) / degree_rad;
  result.missed.clear();
  const auto check = [&](const char* name, double value, const std::optional<double>& bar) {
    // Not `value > bar`, so that NaN exceeds the limit.
    if (bar && !(value <= *bar))
      result.missed.push_back(std::string(name) + " " + sim::number_text(value) + " > " + sim::number_text(*bar));
  };
  const FidelityBars& bars = result.of.bars;
  check("position_rms_m", result.position_rms_m, bars.position_rms_m);
  check("position_max_m", result.position_max_m, bars.position_max_m);
  check("velocity_rms_mps", result.velocity_rms_mps, bars.velocity_rms_mps);
  check("turn_rms_degps", result.turn_rms_degps, bars.turn_rms_degps);
  check("heading_rms_deg", result.heading_rms_deg, bars.heading_rms_deg);
}

std::int64_t steps_to(double t, double step_s, const FidelityReference& reference) {
  const auto steps = static_cast<std::int64_t>(std::llround(t / step_s));
  if (std::abs(static_cast<double>(steps) * step_s - t) > 1e-7)
    sim::throw_config_error(
        {sim::intern_file_name(reference.file), 0, 0}, "",
        "a step of " + sim::number_text(step_s) + " s does not reach the row at t = " + sim::number_text(t) + " s");
  return steps;
}

FidelityState state_of(const FidelityCase& of, const FidelityReference& reference, const std::vector<double>& row) {
  FidelityState state;
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = row[reference.column(fidelity_states[i])];
  state[2] -= of.trim_heave_m;
  state[4] -= of.trim_pitch_rad;
  return state;
}

/// Sets the source place of the whole tree.
void set_places(sim::ConfigNode& node, const sim::SourcePlace& place) {
  node.place = place;
  for (sim::ConfigNode& item : node.items) set_places(item, place);
  for (sim::ConfigNode::Entry& entry : node.entries) {
    entry.place = place;
    set_places(entry.value, place);
  }
}

/// Returns the name of the vehicle in its world, from that of its file.
std::string vehicle_name(const FidelityCase& of) {
  std::string name = std::filesystem::path(of.vehicle).stem().string();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return name;
}

/// Returns the changes of the vehicle by the case and the options, those of the options last.
sim::ConfigNode overrides_of(const FidelityCase& of, const FidelityOptions& options, sim::Diagnostics& diagnostics) {
  sim::ConfigNode overrides = of.overrides;
  overrides.kind = sim::ConfigNode::Kind::map;
  for (const auto& [path, value] : options.overrides) {
    const sim::SourcePlace place{sim::intern_file_name("--override " + path), 0, 0};
    sim::ConfigNode node = sim::parse_config_text(value, *place.file, diagnostics);
    set_places(node, place);
    std::erase_if(overrides.entries, [&key = path](const auto& known) { return known.key == key; });
    overrides.entries.push_back({path, place, node});
  }
  return overrides;
}

/// Throws the same errors, with the case after the source place that each starts with.
[[noreturn]] void throw_for_case(const FidelityCase& of, const sim::ConfigError& error) {
  std::vector<std::string> lines = error.lines();
  for (std::string& line : lines) {
    const std::size_t end = line.find(": ");
    line.insert(end == std::string::npos ? 0 : end + 2, "case '" + of.name + "': ");
  }
  throw sim::ConfigError(lines);
}

/// World of a case with one step length, which is advanced from row to row of the reference.
class CaseWorld {
 public:
  CaseWorld(const FidelityCase& of, const FidelityReference& reference, FidelityOptions options, double step_s)
      : of_(of), reference_(reference), step_s_(step_s) {
    options.step_s = step_s;
    const std::string file = of.place.file != nullptr ? *of.place.file : of.name;
    sim::LoadOptions load;
    load.resolve = false;
    loaded_ = sim::load_world_tree(fidelity_world(of, reference, options), file, load);
    world_ = std::make_unique<sim::StandaloneWorld>(loaded_.config);
    check_inputs(of, vehicle());
    set_velocity(vehicle(), state_of(of, reference, reference.rows.front()));
  }

  /// Steps to the time of a row, returns the state there and sends the inputs of the row.
  FidelityState advance_to(const std::vector<double>& row) {
    for (const std::int64_t end = steps_to(row[0], step_s_, reference_); world_->step_number() < end;) world_->step();
    const FidelityState state = state_of(vehicle().base());
    send_inputs(of_, reference_, row, vehicle().name(), *world_);
    return state;
  }

 private:
  const sim::Vehicle& vehicle() const { return *world_->vehicles().front(); }
  const FidelityCase& of_;
  const FidelityReference& reference_;
  double step_s_;
  sim::LoadedWorld loaded_;
  std::unique_ptr<sim::StandaloneWorld> world_;
};

/// Richardson's extrapolation to step zero, for a step of second order: from the states at a step and at half of it.
FidelityState at_step_zero(const FidelityState& coarse, const FidelityState& fine) {
  FidelityState state;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const bool angle = i >= 3 && i < 6;
    const double change = angle ? std::remainder(fine[i] - coarse[i], 2 * std::numbers::pi) : fine[i] - coarse[i];
    state[i] = fine[i] + change / 3;
  }
  return state;
}

FidelityResult run(const FidelityCase& of, const FidelityOptions& options) {
  if (std::error_code error; !std::filesystem::is_regular_file(of.vehicle, error))
    sim::throw_config_error(of.vehicle_place, "", "there is no vehicle file '" + of.vehicle + "'");
  const FidelityReference reference = read_fidelity_reference(of.reference);
  CaseWorld world(of, reference, options, options.step_s.value_or(of.step_s));
  std::optional<CaseWorld> finer;
  // The results of both steps are extrapolated to step zero, so that models are compared and not the errors of
  // integration.
  if (!options.step_s) finer.emplace(of, reference, options, of.step_s / 2);
  FidelityResult result;
  result.of = of;
  result.step_s = options.step_s.value_or(0);
  Differences sums;
  for (const std::vector<double>& row : reference.rows) {
    FidelityState ours = world.advance_to(row);
    if (finer) ours = at_step_zero(ours, finer->advance_to(row));
    result.t.push_back(row[0]);
    add_row(result, sums, state_of(of, reference, row), ours);
    // Mutations only ask whether a bound is missed; the rest of the run would be wasted.
    if (!options.until_missed) continue;
    compare(result, sums, reference.rows.size());
    if (!result.missed.empty()) return result;
  }
  compare(result, sums, reference.rows.size());
  return result;
}

}  // namespace

sim::ConfigNode fidelity_world(const FidelityCase& of, const FidelityReference& reference,
                               const FidelityOptions& options) {
  const FidelityState start = state_of(of, reference, reference.rows.front());
  // The bottom is far away; without any bottom, every case would cause a warning.
  const std::string text =
      "shoal: 1\nname: " + of.name + "\nphysics: {step_s: " + sim::number_text(options.step_s.value_or(of.step_s)) +
      "}\nmedium: {water: {}}\nobjects:\n  - name: far_bottom\n    fixed: true\n    position_m: " +
      list_of({0, 0, -start[2] - bottom_m}) +
      "\n    parts: [{shape: plane}]\nvehicles:\n  - name: " + vehicle_name(of) +
      "\n    file: ''\n    position_m: " + list_of({start[1], start[0], -start[2]}) +
      "\n    rpy_deg: " + list_of({start[3] / degree_rad, -start[4] / degree_rad, 90 - start[5] / degree_rad}) + "\n";
  sim::Diagnostics diagnostics;
  sim::ConfigNode world = sim::parse_config_text(text, of.name, diagnostics);
  set_places(world, of.place);
  sim::ConfigNode& vehicle = world.find("vehicles")->items.front();
  const std::filesystem::path folder =
      of.place.file != nullptr ? std::filesystem::path(*of.place.file).parent_path() : "";
  vehicle.find("file")->scalar = std::filesystem::path(of.vehicle).lexically_proximate(folder).string();
  vehicle.entries.push_back({"overrides", of.place, overrides_of(of, options, diagnostics)});
  for (const sim::ConfigNode::Entry& change : of.world.entries)
    sim::set_config_path(world, change.key, change.value, change.place, diagnostics);
  diagnostics.throw_if_any();
  return world;
}

FidelityResult run_fidelity_case(const FidelityCase& of, const FidelityOptions& options) {
  try {
    return run(of, options);
  } catch (const sim::ConfigError& error) {
    throw_for_case(of, error);
  }
}

}  // namespace verification
