// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/old_options.hpp"

#include <algorithm>
#include <span>

#include "sim/config/yaml_writer.hpp"
#include "tools/experiment/upgrade/number_text.hpp"

namespace tools {

namespace {

using Texts = std::vector<std::string>;

constexpr OldOption old_options[] = {
    {"*", "--name", "name", OptionForm::same},
    {"*", "--period", "period_s", OptionForm::same},
    {"*", "--rewind-s", "rewind_s", OptionForm::same},
    {"*", "--join-timeout", "join_timeout_s", OptionForm::same},
    {"*", "--lcm-url", "lcm_url", OptionForm::same},
    {"shoal-coop-rover", "--waypoints", "waypoints_m", OptionForm::points},
    {"shoal-coop-rover", "--start", "start_m start_yaw_deg", OptionForm::pose},
    {"shoal-coop-rover", "--speed", "speed_mps", OptionForm::same},
    {"shoal-coop-rover", "--seen-std", "seen_std_m", OptionForm::same},
    {"shoal-coop-auv", "--id", "id", OptionForm::same},
    {"shoal-coop-auv", "--depth", "depth_m", OptionForm::same},
    {"shoal-coop-auv", "--start", "start_m", OptionForm::numbers},
    {"shoal-coop-auv", "--start-std", "start_std_m", OptionForm::same},
    {"shoal-coop-auv", "--modem-at", "modem_position_m", OptionForm::numbers},
    {"shoal-coop-auv", "--gps-at", "gps_position_m", OptionForm::numbers},
    {"shoal-coop-auv", "--surface-s", "surface_s", OptionForm::same},
    {"shoal-coop-auv", "--obey", "accept_orders", OptionForm::flag},
    {"shoal-coop-auv", "--execute", "accept_orders", OptionForm::flag},
    {"shoal-coop-auv", "--order-depth-max", "order_depth_max_m", OptionForm::same},
    {"shoal-coop-auv", "--order-speed-max", "order_speed_max_mps", OptionForm::same},
    {"shoal-coop-auv", "--hold-radius", "hold_radius_m", OptionForm::same},
    {"shoal-coop-auv", "--route", "waypoints_m", OptionForm::points},
    {"shoal-coop-auv", "--behaviour", "circle_m zigzag_m zigzag_legs follow follow_offset_m", OptionForm::behaviour},
    {"shoal-coop-auv", "--loop", "loop", OptionForm::flag},
    {"shoal-coop-auv", "--speed", "speed_mps", OptionForm::same},
    {"shoal-coop-auv", "--slot", "slot slots", OptionForm::slot},
    {"shoal-coop-auv", "--slot-s", "slot_s", OptionForm::same},
    {"shoal-coop-auv", "--guard-s", "guard_s", OptionForm::same},
    {"shoal-coop-auv", "--random-s", "random_s", OptionForm::same},
    {"shoal-coop-auv", "--seed", "seed", OptionForm::same},
    {"shoal-coop-auv", "--no-cooperation", "no_cooperation", OptionForm::flag},
    {"shoal-coop-auv", "--steer", "steer", OptionForm::word},
    {"shoal-coop-auv", "--states", "states", OptionForm::same},
    {"shoal-coop-auv", "--sound-speed", "sound_speed_mps", OptionForm::same},
    {"shoal-coop-auv", "--range-std", "range_std_m", OptionForm::same},
    {"shoal-coop-auv", "--sound-speed-std", "sound_speed_std", OptionForm::same},
    {"shoal-coop-auv", "--heading-bias-std", "heading_bias_std_deg", OptionForm::same},
    {"shoal-coop-auv", "--speed-scale-std", "speed_scale_std", OptionForm::same},
    {"shoal-coop-auv", "--heading-noise", "heading_noise_radprtHz", OptionForm::same},
    {"shoal-coop-auv", "--clock-std-ms", "clock_std_ms", OptionForm::same},
    {"shoal-coop-auv", "--clock-drift-std-ppm", "clock_drift_std_ppm", OptionForm::same},
    {"shoal-coop-craft", "--id", "id", OptionForm::same},
    {"shoal-coop-craft", "--transducer-depth", "transducer_depth_m", OptionForm::same},
    {"shoal-coop-craft", "--route", "waypoints_m", OptionForm::points},
    {"shoal-coop-craft", "--behaviour", "circle_m zigzag_m zigzag_legs follow follow_offset_m", OptionForm::behaviour},
    {"shoal-coop-craft", "--loop", "loop", OptionForm::flag},
    {"shoal-coop-craft", "--speed", "speed_mps", OptionForm::same},
    {"shoal-coop-craft", "--slot", "slot slots", OptionForm::slot},
    {"shoal-coop-craft", "--slot-s", "slot_s", OptionForm::same},
    {"shoal-coop-craft", "--guard-s", "guard_s", OptionForm::same},
    {"shoal-coop-craft", "--random-s", "random_s", OptionForm::same},
    {"shoal-coop-craft", "--seed", "seed", OptionForm::same},
    {"shoal-coop-station", "--id", "id", OptionForm::same},
    {"shoal-coop-station", "--to", "to", OptionForm::same},
    {"shoal-coop-station", "--orders", "orders", OptionForm::orders},
    {"shoal-coop-station", "--speed", "speed_mps", OptionForm::same},
    {"shoal-coop-station", "--slot", "slot slots", OptionForm::slot},
    {"shoal-coop-station", "--slot-s", "slot_s", OptionForm::same},
    {"shoal-coop-station", "--guard-s", "guard_s", OptionForm::same},
    {"shoal-coop-station", "--random-s", "random_s", OptionForm::same},
    {"shoal-coop-station", "--seed", "seed", OptionForm::same},
    {"shoal-balance", "--speeds", "speeds", OptionForm::speeds},
    {"shoal-balance", "--balanced-lean", "balanced_tilt_deg", OptionForm::same},
    {"shoal-balance", "--balanced-tilt", "balanced_tilt_deg", OptionForm::same},
    {"shoal-balance", "--kp", "kp_Nm_per_rad", OptionForm::same},
    {"shoal-balance", "--kd", "kd_Nms_per_rad", OptionForm::same},
    {"shoal-balance", "--kv", "kv_rad_per_mps", OptionForm::same},
    {"shoal-balance", "--ki", "ki_rad_per_m", OptionForm::same},
    {"shoal-balance", "--max-lean", "max_tilt_rad", OptionForm::same},
    {"shoal-balance", "--max-tilt", "max_tilt_rad", OptionForm::same},
    {"shoal-balance", "--max-acceleration", "max_acceleration_mps2", OptionForm::same},
    {"shoal-balance", "--turn-gain", "turn_gain_Nms_per_rad", OptionForm::same},
    {"shoal-balance", "--turn-ki", "turn_ki_Nm_per_rad", OptionForm::same},
    {"shoal-balance", "--rate-filter", "rate_filter_s", OptionForm::same},
    {"shoal-balance", "--speed-filter", "speed_filter_s", OptionForm::same},
    {"shoal-balance", "--wheel-radius", "wheel_radius_m", OptionForm::same},
    {"shoal-balance", "--track", "track_m", OptionForm::same},
    {"shoal-balance", "--max-torque", "max_torque_Nm", OptionForm::same},
};

Texts split(std::string_view text, char separator) {
  Texts parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    std::string_view part = text.substr(begin, end - begin);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    parts.emplace_back(part);
    begin = end + 1;
  }
  return parts;
}

std::string flow_list(const Texts& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return "[" + text + "]";
}

bool are_numbers(std::span<const std::string> texts) {
  return std::all_of(texts.begin(), texts.end(), [](const std::string& text) { return number_of(text).has_value(); });
}

/// Returns `[x, y, z]` of numbers, with a limited count.
std::optional<std::string> tuple(const Texts& numbers, std::size_t min, std::size_t max) {
  if (numbers.size() < min || numbers.size() > max || !are_numbers(numbers)) return std::nullopt;
  return flow_list(numbers);
}

/// Returns a list with the result of `row` for each part between semicolons.
template <typename Row>
std::optional<std::string> table(const std::string& value, const Row& row) {
  Texts rows;
  for (const std::string& part : split(value, ';')) {
    if (part.empty()) continue;
    const std::optional<std::string> text = row(part);
    if (!text) return std::nullopt;
    rows.push_back(*text);
  }
  return flow_list(rows);
}

std::optional<std::string> order(const std::string& part) {
  const Texts halves = split(part, ':');
  if (halves.size() != 2) return std::nullopt;
  Texts numbers = split(halves[1], ',');
  numbers.insert(numbers.begin(), halves[0]);
  return tuple(numbers, 4, 5);
}

std::string scalar(const std::string& text) {
  return number_of(text) ? text : sim::to_flow_yaml(sim::scalar_node(text, {}));
}

using Values = std::optional<Texts>;

Values one(std::optional<std::string> text) {
  return text ? Values({std::move(*text)}) : std::nullopt;
}

/// Values of the five keys of a behaviour; empty: the key is not written.
Values behaviour(const std::string& value) {
  const std::size_t colon = std::min(value.find(':'), value.size());
  const std::string word = value.substr(0, colon);
  if (word == "route" && colon == value.size()) return Texts(5);
  if (colon == value.size()) return std::nullopt;
  Texts parts = split(std::string_view(value).substr(colon + 1), ',');
  if (word == "circle") {
    const auto circle = tuple(parts, 3, 3);
    return circle ? Values({*circle, "", "", "", ""}) : std::nullopt;
  }
  if (word == "zigzag" && parts.size() == 6 && are_numbers(parts)) {
    const std::string legs = parts.back();
    parts.pop_back();
    return Texts{"", flow_list(parts), legs, "", ""};
  }
  if (word == "follow" && parts.size() == 3 && !parts[0].empty()) {
    const auto offset = tuple({parts[1], parts[2]}, 2, 2);
    return offset ? Values({"", "", "", scalar(parts[0]), *offset}) : std::nullopt;
  }
  return std::nullopt;
}

Values values_of(OptionForm form, const std::string& value) {
  const Texts parts = split(value, ',');
  switch (form) {
    // Single values.
    case OptionForm::flag:
      return Texts{"true"};
    case OptionForm::same:
      return Texts{scalar(value)};
    case OptionForm::word: {
      std::string word = value;
      std::replace(word.begin(), word.end(), '-', '_');
      return Texts{scalar(word)};
    }
    // Lists and tables.
    case OptionForm::numbers:
      return one(tuple(parts, 1, 100));
    case OptionForm::points:
      return one(table(value, [](const std::string& part) { return tuple(split(part, ','), 2, 2); }));
    case OptionForm::orders:
      return one(table(value, order));
    case OptionForm::speeds:
      return one(table(value, [](const std::string& part) { return tuple(split(part, ':'), 2, 3); }));
    // Values of two keys.
    case OptionForm::pose:
      if (parts.size() != 3 || !are_numbers(parts)) return std::nullopt;
      return Texts{flow_list({parts[0], parts[1]}), parts[2]};
    case OptionForm::slot: {
      const Texts halves = split(value, '/');
      if (halves.size() != 2 || !are_numbers(halves)) return std::nullopt;
      return halves;
    }
    case OptionForm::behaviour:
      break;
  }
  return behaviour(value);
}

}  // namespace

bool is_old_program(std::string_view program) {
  return program != "*" && std::any_of(std::begin(old_options), std::end(old_options),
                                       [&](const OldOption& each) { return each.program == program; });
}

const OldOption* find_old_option(std::string_view program, std::string_view option) {
  for (const OldOption& each : old_options)
    if ((each.program == program || each.program == std::string_view("*")) && each.option == option) return &each;
  return nullptr;
}

std::optional<std::vector<Argument>> arguments_of(const OldOption& option, const std::string& value) {
  const Values values = values_of(option.form, value);
  if (!values) return std::nullopt;
  const Texts keys = split(option.keys, ' ');
  std::vector<Argument> arguments;
  for (std::size_t i = 0; i < keys.size() && i < values->size(); ++i)
    if (!(*values)[i].empty()) arguments.push_back({keys[i], (*values)[i]});
  return arguments;
}

}  // namespace tools
