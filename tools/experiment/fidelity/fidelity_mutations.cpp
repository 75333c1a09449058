// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/fidelity/fidelity_mutations.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

#include "sim/config/message_text.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

namespace {

std::optional<double> number_in(const sim::ConfigNode& node) {
  if (node.kind != sim::ConfigNode::Kind::scalar || node.quoted) return std::nullopt;
  double value = 0;
  const char* const last = node.scalar.data() + node.scalar.size();
  const auto [end, error] = std::from_chars(node.scalar.data(), last, value);
  if (error != std::errc{} || end != last) return std::nullopt;
  return value;
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

std::string cell_of(const FidelityVerdict& verdict) {
  if (!verdict.refused.empty()) return "refused";
  return verdict.seen_by.empty() ? "**no case**" : verdict.seen_by;
}

}  // namespace

std::string FidelityCoefficient::text_with(double factor) const {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool changed = std::find(places.begin(), places.end(), i) != places.end();
    text += (i > 0 ? ", " : "") + (changed ? sim::number_text(factor * value) : items[i]);
  }
  return list ? "[" + text + "]" : text;
}

bool FidelityMutation::unseen() const {
  return std::any_of(verdicts.begin(), verdicts.end(),
                     [](const FidelityVerdict& one) { return one.seen_by.empty() && one.refused.empty(); });
}

std::vector<FidelityCoefficient> fidelity_coefficients(const FidelityCase& of) {
  FidelityCase bare = of;
  bare.overrides = {};
  const std::string file = of.place.file != nullptr ? *of.place.file : of.name;
  const sim::LoadedWorld loaded = sim::load_world_tree(fidelity_world(bare, read_fidelity_reference(of.reference)), file);
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
  options.overrides[coefficient.path] = coefficient.text_with(factor);
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

std::vector<FidelityMutation> mutate_fidelity(const std::vector<FidelityCase>& cases, double share,
                                              const std::function<void(const std::string&)>& progress) {
  std::vector<FidelityMutation> mutations;
  std::set<std::string> done;
  for (const FidelityCase& first : cases) {
    if (!done.insert(first.vehicle).second) continue;
    // The case that saw the last change is tried first.
    std::vector<const FidelityCase*> order;
    for (const FidelityCase& of : cases)
      if (of.vehicle == first.vehicle) order.push_back(&of);
    std::size_t unseen = 0, count = 0;
    for (const FidelityCoefficient& coefficient : fidelity_coefficients(first)) {
      FidelityMutation mutation{coefficient, first.title, {}};
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t i = 0; i < order.size(); ++i) {
          if (overrides_coefficient(*order[i], coefficient)) continue;
          FidelityVerdict& verdict = mutation.verdicts[side];
          verdict = try_fidelity_mutation(*order[i], coefficient, side == 0 ? 1 - share : 1 + share);
          if (verdict.seen_by.empty() && verdict.refused.empty()) continue;
          if (verdict.refused.empty())
            std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(i),
                        order.begin() + static_cast<std::ptrdiff_t>(i) + 1);
          break;
        }
      if (mutation.unseen()) ++unseen;
      ++count;
      mutations.push_back(std::move(mutation));
    }
    progress(fmt::format("{}: {} coefficients, unseen: {}", first.title, count, unseen));
  }
  return mutations;
}

std::string fidelity_mutations_page(const std::vector<FidelityMutation>& mutations, double share,
                                    const std::string& cases) {
  std::string page = fmt::format(
      "# Which case sees which coefficient\n\nWritten by `shoal fidelity {} --mutate {:g} --results docs/models`.\n\n"
      "Each number of each vehicle that has [coefficients](coefficients.md) is decreased and increased by {:g} %, one "
      "at "
      "a time.\nThe tables name a case that then misses a bar of [fidelity.md](fidelity.md).  Numbers that are 0, and "
      "keys that the file\nleaves to their defaults, are not changed; a pair of a symmetric matrix changes "
      "together.\n\n",
      cases, share, 100 * share);
  // What is not seen, and what is refused.
  std::string unseen, refused;
  for (const FidelityMutation& mutation : mutations) {
    if (mutation.unseen())
      unseen +=
          fmt::format("| {} | {} | {} |\n", mutation.title, mutation.of.name, sim::number_text(mutation.of.value));
    for (std::size_t side = 0; side < 2; ++side)
      if (const std::string& why = mutation.verdicts[side].refused; !why.empty())
        refused += fmt::format("| {} | {} | {}{:g} % | {} |\n", mutation.title, mutation.of.name, side == 0 ? "-" : "+",
                               100 * share, why);
  }
  page += "## What no case sees\n\n";
  page += unseen.empty() ? "Nothing.\n\n" : "| vehicle | coefficient | value |\n|---|---|---:|\n" + unseen + "\n";
  page += "## What a world refuses\n\n";
  page += refused.empty() ? "Nothing.\n" : "| vehicle | coefficient | change | error |\n|---|---|---:|---|\n" + refused;
  std::string title;
  for (const FidelityMutation& mutation : mutations) {
    if (mutation.title != title)
      page += fmt::format("\n## {}\n\n| coefficient | value | -{:g} % | +{:g} % |\n|---|---:|---|---|\n",
                          mutation.title, 100 * share, 100 * share);
    title = mutation.title;
    page += fmt::format("| {} | {} | {} | {} |\n", mutation.of.name, sim::number_text(mutation.of.value),
                        cell_of(mutation.verdicts[0]), cell_of(mutation.verdicts[1]));
  }
  return page;
}

}  // namespace tools
