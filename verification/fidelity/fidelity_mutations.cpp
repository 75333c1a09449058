// SPDX-License-Identifier: BSD-3-Clause
#include "verification/fidelity/fidelity_mutations.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "experiment/files/csv.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"
#include "sim/model/hydrodynamics_config.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/world_file/load_world.hpp"

namespace verification {

namespace {

std::optional<double> number_in(const sim::ConfigNode& node) {
  if (node.kind != sim::ConfigNode::Kind::scalar || node.quoted) return std::nullopt;
  return sim::exact_number<double>(node.scalar);
}

/// Adds the numbers of a list: matrices by rows of 3 or 6 with the mirrored number where they must be symmetric.
void add_list(const std::string& path, const std::string& key, const sim::ConfigNode& list,
              std::vector<FidelityCoefficient>& found) {
  FidelityCoefficient of;
  of.path = path;
  of.list = true;
  for (const sim::ConfigNode& item : list.items) {
    if (!number_in(item)) return;
    of.items.push_back(item.scalar);
  }
  const std::size_t count = of.items.size();
  const bool symmetric = key == "added_mass" || key == "inertia_kgm2";
  const std::size_t width = symmetric && count == 36 ? 6 : symmetric && count == 9 ? 3 : 0;
  for (std::size_t i = 0; i < count; ++i) {
    of.value = *number_in(list.items[i]);
    if (of.value == 0) continue;
    of.places = {i};
    if (width > 0) {
      const std::size_t mirrored = i % width * width + i / width;
      if (mirrored < i) continue;
      if (mirrored > i) of.places.push_back(mirrored);
    }
    of.name = path + "[" + std::to_string(i) + "]";
    found.push_back(of);
  }
}

void add_numbers(const std::string& path, const sim::ConfigNode& node, std::vector<FidelityCoefficient>& found) {
  for (const sim::ConfigNode::Entry& entry : node.entries) {
    const std::string below = path + "." + entry.key;
    if (entry.value.kind == sim::ConfigNode::Kind::map) add_numbers(below, entry.value, found);
    if (entry.value.kind == sim::ConfigNode::Kind::list) add_list(below, entry.key, entry.value, found);
    const std::optional<double> value = number_in(entry.value);
    if (!value || *value == 0) continue;
    FidelityCoefficient of;
    of.name = of.path = below;
    of.value = *value;
    of.items = {entry.value.scalar};
    of.places = {0};
    found.push_back(of);
  }
}

/// Returns the name of the derivative at the mirrored place of the added mass, N_vdot of Y_rdot; empty: it is on the
/// diagonal, or no derivative by an acceleration.
std::string mirrored_derivative(const std::string& name) {
  if (name.size() != 6 || name[1] != '_' || !name.ends_with("dot")) return {};
  const auto row = sim::derivative_rows.find(name[0]), column = sim::derivative_states.find(name[2]);
  if (row == column || row == std::string_view::npos || column == std::string_view::npos) return {};
  return {sim::derivative_rows[column], '_', sim::derivative_states[row], 'd', 'o', 't'};
}

/// Makes one coefficient of both derivatives of a mirrored pair.
void join_mirrored(std::vector<FidelityCoefficient>& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t dot = found[i].path.rfind('.');
    const std::string mirrored = mirrored_derivative(found[i].path.substr(dot + 1));
    if (mirrored.empty()) continue;
    const auto other = std::find_if(found.begin(), found.end(), [&](const FidelityCoefficient& one) {
      return one.path == found[i].path.substr(0, dot + 1) + mirrored;
    });
    if (other == found.end()) continue;
    found[i].mirrored_path = other->path;
    found[i].mirrored_value = other->value;
    found[i].name += ", " + mirrored;
    found.erase(other);
  }
}

bool is_actuator_in_water(const std::string& type) {
  static const std::set<std::string> types{"thruster", "fin", "buoyancy_engine", "moving_mass", "body_wrench"};
  return types.contains(type);
}

/// Returns the text of an error without file, line and case.
std::string reason_in(const sim::ConfigError& error) {
  std::string line = error.lines().front();
  const std::size_t end_of_case = line.find("case '");
  const std::size_t start = line.find("': ", end_of_case == std::string::npos ? 0 : end_of_case);
  return start == std::string::npos ? line : line.substr(start + 3);
}

/// Returns the verdict of the first case that sees a change, and moves this case to the front.
FidelityVerdict find_case(std::vector<const FidelityCase*>& order, const FidelityCoefficient& coefficient,
                          double factor) {
  for (auto of = order.begin(); of != order.end(); ++of) {
    if (overrides_coefficient(**of, coefficient)) continue;
    FidelityVerdict verdict = try_fidelity_mutation(**of, coefficient, factor);
    if (!verdict.refused.empty()) return verdict;
    if (verdict.seen_by.empty()) continue;
    std::rotate(order.begin(), of, of + 1);
    return verdict;
  }
  return {};
}

std::string cell_of(const FidelityVerdict& verdict) {
  if (!verdict.refused.empty()) return "refused";
  return verdict.seen_by.empty() ? "no case" : verdict.seen_by;
}

}  // namespace

std::map<std::string, std::string> FidelityCoefficient::changes(double factor) const {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool changed = std::find(places.begin(), places.end(), i) != places.end();
    text += (i > 0 ? ", " : "") + (changed ? sim::number_text(factor * value) : items[i]);
  }
  std::map<std::string, std::string> all{{path, list ? "[" + text + "]" : text}};
  if (!mirrored_path.empty()) all[mirrored_path] = sim::number_text(factor * mirrored_value);
  return all;
}

bool FidelityMutation::unseen() const {
  return std::any_of(verdicts.begin(), verdicts.end(),
                     [](const FidelityVerdict& one) { return one.seen_by.empty() && one.refused.empty(); });
}

std::vector<FidelityCoefficient> fidelity_coefficients(const FidelityCase& of) {
  // Overrides belong to the case, not to the vehicle, and are not mutated.
  FidelityCase bare = of;
  bare.overrides = {};
  const std::string file = of.place.file != nullptr ? *of.place.file : of.name;
  const sim::LoadedWorld loaded =
      sim::load_world_tree(fidelity_world(bare, read_fidelity_reference(of.reference)), file);
  const sim::ConfigNode& vehicle = *loaded.config.vehicles.front().config->source;
  std::vector<FidelityCoefficient> found;
  if (const sim::ConfigNode* bodies = vehicle.find("bodies"); bodies != nullptr)
    for (const sim::ConfigNode& body : bodies->items) {
      const sim::ConfigNode* water = body.find("hydrodynamics");
      if (water == nullptr) continue;
      const sim::ConfigNode* model = water->find("model");
      if (model != nullptr && model->scalar == "none") continue;
      add_numbers("bodies." + *sim::name_of(body) + ".hydrodynamics", *water, found);
    }
  if (const sim::ConfigNode* devices = vehicle.find("devices"); devices != nullptr)
    for (const sim::ConfigNode& device : devices->items)
      if (is_actuator_in_water(device.find("type")->scalar))
        add_numbers("devices." + *sim::name_of(device), device, found);
  join_mirrored(found);
  return found;
}

bool overrides_coefficient(const FidelityCase& of, const FidelityCoefficient& coefficient) {
  const auto inside = [](const std::string& outer, const std::string& path) {
    return path == outer || path.starts_with(outer + ".");
  };
  return std::any_of(of.overrides.entries.begin(), of.overrides.entries.end(), [&](const auto& change) {
    return inside(change.key, coefficient.path) || inside(coefficient.path, change.key);
  });
}

FidelityVerdict try_fidelity_mutation(const FidelityCase& of, const FidelityCoefficient& coefficient, double factor) {
  FidelityOptions options;
  options.overrides = coefficient.changes(factor);
  options.until_missed = true;
  try {
    const FidelityResult result = run_fidelity_case(of, options);
    if (result.missed.empty()) return {};
    return {of.name, result.missed.front(), ""};
  } catch (const sim::ConfigError& error) {
    return {"", "", reason_in(error)};
  } catch (const sim::PhysicsFault& fault) {
    return {of.name, fault.what(), ""};
  }
}

std::vector<FidelityMutation> mutate_fidelity(const FidelityFile& file, double share,
                                              const std::function<void(const std::string&)>& progress) {
  std::vector<FidelityMutation> mutations;
  std::set<std::string> done;
  for (const FidelityCase& first : file.cases) {
    if (!done.insert(first.vehicle).second) continue;
    std::vector<const FidelityCase*> order;
    for (const FidelityCase& of : file.cases)
      if (of.vehicle == first.vehicle) order.push_back(&of);
    const std::string vehicle = std::filesystem::path(first.vehicle).stem().string();
    std::size_t unseen = 0, count = 0;
    for (const FidelityCoefficient& coefficient : fidelity_coefficients(first)) {
      FidelityMutation mutation{coefficient, vehicle, {}, {}};
      mutation.verdicts = {find_case(order, coefficient, 1 - share), find_case(order, coefficient, 1 + share)};
      for (const FidelityWithoutEffect& known : file.without_effect)
        if (known.coefficient == coefficient.name) mutation.without_effect = known.why;
      if (mutation.unseen()) ++unseen;
      ++count;
      mutations.push_back(std::move(mutation));
    }
    progress(fmt::format("{}: coefficients: {}, seen by no case: {}", vehicle, count, unseen));
  }
  return mutations;
}

std::string fidelity_mutations_page(const std::vector<FidelityMutation>& mutations, double share,
                                    const std::string& cases) {
  const std::string percent = fmt::format("{:g} %", 100 * share);
  std::string unseen, refused, counts;
  std::vector<std::pair<std::string, int>> count_of;
  for (const FidelityMutation& mutation : mutations) {
    const std::string value = sim::number_text(mutation.of.value);
    if (mutation.unseen())
      unseen += fmt::format("| {} | {} | {} | {} |\n", mutation.vehicle, mutation.of.name, value,
                            mutation.without_effect.empty() ? "a case is missing" : mutation.without_effect);
    for (std::size_t side = 0; side < 2; ++side)
      if (const std::string& why = mutation.verdicts[side].refused; !why.empty())
        refused += fmt::format("| {} | {} | {} | {}{} | {} |\n", mutation.vehicle, mutation.of.name, value,
                               side == 0 ? "-" : "+", percent, why);
    if (count_of.empty() || count_of.back().first != mutation.vehicle) count_of.emplace_back(mutation.vehicle, 0);
    ++count_of.back().second;
  }
  for (const auto& [vehicle, count] : count_of) counts += fmt::format("| {} | {} |\n", vehicle, count);
  const auto table_or_none = [](const char* head, const std::string& rows) {
    return rows.empty() ? std::string("None.\n") : head + rows;
  };
  return fmt::format(
             "# Which case detects which coefficient\n\nWritten by `shoal fidelity {} --mutate {:g}`.\n\n"
             "Each number of each vehicle file with [coefficients](coefficients.md) is decreased and increased by {}, "
             "one at a\ntime. [fidelity/coefficients.csv](fidelity/coefficients.csv) has a row for each: the case "
             "that then misses a bar of\n[fidelity.md](fidelity.md), or `refused`. Numbers in `hydrodynamics:` and "
             "in thrusters, fins, buoyancy engines, moving\nmasses and wrenches are changed, except 0 and keys that "
             "the file leaves to their defaults. Both numbers of a pair of a\nsymmetric matrix change together.\n\n"
             "| vehicle | coefficients |\n|---|---:|\n{}\n## Detected by no case\n\n",
             cases, share, percent, counts) +
         table_or_none("| vehicle | coefficient | value | why |\n|---|---|---:|---|\n", unseen) +
         "\n## Refused values\n\n" +
         table_or_none("| vehicle | coefficient | value | change | error |\n|---|---|---:|---:|---|\n", refused);
}

std::string fidelity_mutations_csv(const std::vector<FidelityMutation>& mutations) {
  std::string text = "vehicle,coefficient,value,decreased,increased\n";
  for (const FidelityMutation& mutation : mutations)
    text +=
        fmt::format("{},{},{},{},{}\n", mutation.vehicle, experiment::csv_field(mutation.of.name),
                    sim::number_text(mutation.of.value), cell_of(mutation.verdicts[0]), cell_of(mutation.verdicts[1]));
  return text;
}

}  // namespace verification
