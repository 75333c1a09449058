// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/reference/reference_pages.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <stdexcept>

#include "shoal/message_schema.hpp"
#include "sim/base/text_layout.hpp"
#include "sim/config/param_info.hpp"
#include "sim/program/program_declaration.hpp"
#include "sim/random/noise.hpp"
#include "sim/world_file/metric_registry.hpp"
#include "sim/world_file/world_config.hpp"
#include "tools/shoal/reference/json_schema.hpp"

namespace tools {

namespace {

std::string rate_text(double rate_hz) {
  return rate_hz > 0 ? fmt::format("{} Hz", rate_hz) : std::string("every step");
}

std::string traffic_of(const sim::DeviceType& type) {
  std::string text;
  if (!type.report_message.empty())
    text += fmt::format("Reports `{}` on `VEHICLE.DEVICE`, by default {}. ", type.report_message,
                        rate_text(type.default_rate_hz));
  if (!type.command_messages.empty()) text += fmt::format("Takes `{}` on `VEHICLE.DEVICE.cmd`.", type.command_messages);
  return text + "\n";
}

/// Lines have any length unless `columns` are given.
std::string message_text(const shoal::MessageSchema& schema, std::size_t columns = 100'000) {
  std::string text = fmt::format("{}  fingerprint {:016x}\n", schema.name, schema.fingerprint);
  std::string comment = schema.comment;  // it has its own lines
  if (columns < 1000) std::replace(comment.begin(), comment.end(), '\n', ' ');
  if (!comment.empty()) text += (columns < 1000 ? sim::wrapped(comment, columns) : comment) + "\n";
  for (const shoal::Member& member : schema.members) {
    std::string name = member.name;
    for (const shoal::Dimension& dimension : member.dimensions) name += "[" + dimension.text + "]";
    const std::string begin = fmt::format("  {:<8} {:<32} ", member.type_name, name);
    const bool beside = begin.size() + 20 <= columns;
    const std::size_t indent = beside ? begin.size() : 6;
    const std::string meaning = sim::wrapped(member.comment, columns, indent, indent);
    if (meaning.empty() && columns < 1000)  // the page has its blanks
      text += begin.substr(0, begin.find_last_not_of(' ') + 1) + "\n";
    else if (beside)
      text += begin + meaning + "\n";
    else
      text += fmt::format("  {} {}\n", member.type_name, name) +
              (meaning.empty() ? "" : std::string(indent, ' ') + meaning + "\n");
  }
  return text;
}

/// Lays out keys in columns where they fit, else each key followed by its description.
std::string keys_text(const std::vector<sim::ParamInfo>& params, std::size_t columns) {
  const std::string table = sim::text_table(params);
  std::size_t longest = 0;
  for (std::size_t at = 0; at < table.size();) {
    const std::size_t end = std::min(table.find('\n', at), table.size());
    longest = std::max(longest, sim::column_count(std::string_view(table).substr(at, end - at)));
    at = end + 1;
  }
  if (longest <= columns) return table;
  std::vector<std::pair<std::string, std::string>> rows;
  for (const auto& [key, type, rule, initial, meaning] : sim::param_rows(params)) {
    std::string facts = type;
    if (!rule.empty()) facts += " " + rule;
    if (!initial.empty())
      facts += initial == "required" || initial == "unset" ? ", " + initial : ", default " + initial;
    rows.emplace_back(key, meaning.empty() ? facts : meaning + " (" + facts + ")");
  }
  return sim::two_columns(rows, columns, 28);
}

const char* const generated = "<!-- Generated: `shoal describe --page {}`. Do not edit. -->\n\n";

std::string devices_page() {
  std::string page = fmt::format(fmt::runtime(generated), "devices") +
                     "# Devices\n\nEach device of a vehicle file has the keys of its type and the keys that all "
                     "devices have. Angles ending in `_deg` are degrees; everything else is SI.\n\n"
                     "## Keys of every device\n\n" +
                     sim::markdown_table(common_params()) +
                     "\n## Noise\n\nA key of type map that describes an error has these keys. They compose in this "
                     "order: scale error, bias, random walk, Gauss-Markov, gaussian, uniform, outliers, quantization, "
                     "saturation.\n\n" +
                     sim::markdown_table(params_of<sim::NoiseParams>());
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    page += fmt::format("\n## {}\n\n{}\n\n{}\n{}", type->name, type->meaning, traffic_of(*type),
                        sim::markdown_table(params_of(*type)));
  return page;
}

std::string world_format_page() {
  return fmt::format(fmt::runtime(generated), "world_format") +
         "# World and vehicle files\n\n"
         "YAML. Every error is reported as `file:line:column: who: rule, value`; an unknown key is an error. Lengths "
         "are meters, masses kilograms, times seconds; keys ending in `_deg` are degrees. Frames: see "
         "[conventions.md](../develop/conventions.md).\n\n"
         "* `include: FILE` (or a list) at the top of a file: the included file is the base over which this one is "
         "merged, maps key by key, lists of named items item by item, anything else replaced. It is looked up "
         "beside the file, then, by its name alone, among the shipped worlds and vehicles.\n"
         "* `${name}` in a vehicle file stands for a parameter: the file's `parameters:` gives the default, the "
         "world's `parameters:` of that vehicle another value. `${index}` is the number of the instance (from 1), "
         "`${name}` its entry's name.\n"
         "* `overrides:` of a vehicle, and `--set` on the command line, change one value each by its dotted path; an "
         "item of a list is named by its `name`: `vehicles.rover1.devices.lidar.rate_hz`. One vehicle of a `count` is "
         "addressed by its own name: "
         "`vehicles.rover7.devices.lidar.rate_hz` with --set, `rover7/devices.lidar.rate_hz` in `overrides:`.\n"
         "* A vehicle file is looked up beside the world file, then in `../vehicles`, then among the shipped ones "
         "(`shoal list`).\n"
         "* Where two materials touch, the entry of `contacts` that names both takes precedence over one with `any`; "
         "among "
         "equals the last one wins.\n\n"
         "## World\n\n" +
         sim::markdown_table(params_of<sim::WorldConfig>()) + "\n## Vehicle\n\n" +
         sim::markdown_table(params_of<sim::VehicleConfig>()) +
         "\nThe keys of `devices` depend on the type: see [devices.md](devices.md).\n";
}

std::string messages_page() {
  std::string page = fmt::format(fmt::runtime(generated), "messages") +
                     "# Messages\n\nPackage `shoal`, from `messages/*/*.lcm`. `utime` is the run's epoch plus "
                     "simulated time, in microseconds. Channels are `VEHICLE.DEVICE` for reports, "
                     "`VEHICLE.DEVICE.cmd` for commands, `VEHICLE.DEVICE.truth` for readings without errors, and "
                     "`sim.*` for the simulator itself.\n\n"
                     "| channel | message | |\n|---|---|---|\n"
                     "| `sim.clock` | `shoal.utime_t` | simulated time |\n"
                     "| `sim.state` | `shoal.sim_state_t` | true poses of all vehicles |\n"
                     "| `sim.info` | `shoal.sim_info_t` | world, seed, resolved configuration, versions |\n"
                     "| `sim.inputs` | `shoal.sim_inputs_t` | inputs of the world from outside, for replaying a log |\n"
                     "| `sim.hash` | `shoal.sim_hash_t` | hashes of the state, whole and by part |\n"
                     "| `sim.control` | `shoal.sim_control_request_t` | requests to the simulator |\n"
                     "| `sim.control.reply` | `shoal.sim_control_reply_t` | their answers |\n"
                     "| `sim.tick` | `shoal.sim_tick_t` | lockstep: the world waits for the named clients |\n"
                     "| `sim.ack` | `shoal.sim_ack_t` | lockstep: a client is done |\n"
                     "| `sim.resend` | `shoal.sim_resend_t` | lockstep: requests messages that did not arrive |\n"
                     "| `sim.resent` | `shoal.sim_resent_t` | lockstep: messages that were requested |\n"
                     "| `sim.snapshot` | `shoal.sim_snapshot_t` | snapshot with which a run started, if any |\n"
                     "| `sim.vehicle` | `shoal.sim_vehicle_t` | a vehicle was added, removed, or requested |\n\n"
                     "Types that are equal on the wire to those of `bot_core` say so.\n";
  for (const auto& [name, schema] : shoal::embedded_types().all())
    page += fmt::format("\n## {}\n\n```\n{}```\n", name, message_text(schema));
  return page;
}

std::string channels_text(const char* verb, const std::optional<std::vector<std::string>>& channels) {
  if (!channels || channels->empty()) return {};
  std::string text;
  for (const std::string& channel : *channels) text += (text.empty() ? "" : ", ") + ("`" + channel + "`");
  return fmt::format("{} {}. ", verb, text);
}

std::string groups_text(const char* rule, const std::vector<std::vector<std::string>>& groups) {
  std::string text;
  for (const std::vector<std::string>& group : groups) {
    std::string names;
    for (std::size_t i = 0; i < group.size(); ++i)
      names += (i == 0 ? "" : i + 1 == group.size() ? " and " : ", ") + ("`" + group[i] + "`");
    text += fmt::format("{} of {} {} given. ", rule, names, rule[0] == 'E' ? "must be" : "may be");
  }
  return text;
}

std::string programs_page() {
  std::string page =
      fmt::format(fmt::runtime(generated), "programs") +
      "# Programs and their arguments\n\nThe programs that come with Shoal, as the files "
      "`NAME.args.yaml` beside them declare them. In a world:\n\n"
      "```yaml\nprocesses:\n  - name: rover1\n    client: rover1\n    program: shoal-coop-rover\n"
      "    args: {name: rover1, waypoints_m: [[-28, 28], [-20, 28]]}\n```\n\n"
      "On a command line the argument `speed_mps` is `--speed-mps`. "
      "[program_arguments.md](../guides/program_arguments.md) explains the declarations, and how a program of "
      "your own gets one. `{name}` in a channel stands for the argument `name`; a column with `?` may "
      "be left out.\n";
  for (const sim::ProgramDeclaration& program : shipped_declarations())
    page += fmt::format("\n## {}\n\n{}\n\n{}{}{}{}\n\n{}", program.program, program.meaning,
                        channels_text("Receives", program.subscribes), channels_text("Publishes", program.publishes),
                        groups_text("Exactly one", program.exactly_one),
                        groups_text("At most one", program.at_most_one), sim::markdown_table(param_table_of(program)));
  for (std::size_t at = page.find(" \n"); at != std::string::npos; at = page.find(" \n")) page.erase(at, 1);
  return page;
}

/// Returns the output of `shoal describe` for a program; empty: there is no such program.
std::string program_text(const std::string& name, std::size_t columns) {
  for (const sim::ProgramDeclaration& program : shipped_declarations()) {
    if (program.program != name) continue;
    return sim::wrapped(program.program + ": " + program.meaning, columns) + "\n" +
           sim::wrapped(channels_text("Receives", program.subscribes) + channels_text("Publishes", program.publishes) +
                            groups_text("Exactly one", program.exactly_one) +
                            groups_text("At most one", program.at_most_one),
                        columns) +
           "\n\n" + keys_text(param_table_of(program), columns);
  }
  return {};
}

std::string unit_text(const sim::FigureKind& figure) {
  return figure.unit == "1" ? "ratio" : figure.unit;
}

std::string keys_text(const sim::MetricKind& kind) {
  std::string text;
  const std::vector<sim::ParamInfo> keys = kind.keys();
  for (const bool required : {true, false})
    for (const sim::ParamInfo& info : keys) {
      if (info.required != required) continue;
      const char* bold = required ? "**" : "";
      text += (text.empty() ? "" : ", ") + (bold + ("`" + info.key + "`")) + bold;
    }
  return text;
}

std::string metrics_page() {
  std::string page =
      fmt::format(fmt::runtime(generated), "metrics") +
      "# Metrics and their figures\n\nEach type of metric gives these figures, called `NAME.figure` in "
      "`summary.json`, `metrics.csv` and pass rules. A figure without data is NaN: null in `summary.json`, `none` in "
      "reports. Keys that a type needs are bold; "
      "[world_format.md](world_format.md) explains them, [scoring.md](../guides/scoring.md) the metrics.\n";
  for (const sim::MetricKind* kind : sim::MetricRegistry::instance().all()) {
    page += fmt::format("\n## {}\n\nWhat it measures: {}. Keys: {}.\n\n| figure | unit | meaning |\n|---|---|---|\n",
                        kind->word, kind->meaning, keys_text(*kind));
    for (const sim::FigureKind& figure : kind->figures)
      page += fmt::format("| `{}` | {} | {} |\n", figure.name, unit_text(figure), figure.meaning);
  }
  return page;
}

std::string metrics_text(std::size_t columns) {
  constexpr std::size_t indent = 6;
  std::string text = "Figures of the metrics of a world, NAME.figure.\n";
  for (const sim::MetricKind* kind : sim::MetricRegistry::instance().all()) {
    text += "\n" + sim::wrapped(kind->word + ": " + kind->meaning, columns) + "\n";
    for (const sim::FigureKind& figure : kind->figures)
      text += fmt::format("  {} ({})\n{:{}}{}\n", figure.name, unit_text(figure), "", indent,
                          sim::wrapped(figure.meaning, columns, indent, indent));
  }
  return text;
}

}  // namespace

std::string reference_page(const std::string& name) {
  if (name == "devices") return devices_page();
  if (name == "world_format") return world_format_page();
  if (name == "messages") return messages_page();
  if (name == "metrics") return metrics_page();
  if (name == "programs") return programs_page();
  throw std::out_of_range("no page '" + name + "'; pages: devices, messages, metrics, programs, world_format");
}

std::string describe_keys(const std::string& title, const std::vector<sim::ParamInfo>& params, std::size_t columns) {
  return sim::wrapped(title, columns) + "\n\n" + keys_text(params, columns);
}

namespace {

/// A key of the top level of a world or vehicle file with the keys below it; empty: there is no such key.
std::string section_text(const std::string& key, std::size_t columns) {
  for (const auto& [file, params] :
       {std::pair("world", params_of<sim::WorldConfig>()), std::pair("vehicle", params_of<sim::VehicleConfig>())}) {
    std::vector<sim::ParamInfo> found;
    for (const sim::ParamInfo& info : params)
      if (info.key == key || info.key.starts_with(key + ".") || info.key.starts_with(key + "[]")) found.push_back(info);
    if (!found.empty()) return describe_keys("'" + key + "' of a " + file + " file.", found, columns);
  }
  return {};
}

}  // namespace

std::string describe_text(const std::string& name, std::size_t columns) {
  const auto keys = [columns](const std::string& title, const std::vector<sim::ParamInfo>& params) {
    return describe_keys(title, params, columns);
  };
  if (name == "device") return keys("Keys of every device.", common_params());
  if (name == "noise") return keys("Error of a measured quantity.", params_of<sim::NoiseParams>());
  if (name == "world") return keys("Keys of a world file.", params_of<sim::WorldConfig>());
  if (name == "vehicle") return keys("Keys of a vehicle file.", params_of<sim::VehicleConfig>());
  if (name == "metrics") return metrics_text(columns);
  if (const sim::DeviceType* type = sim::DeviceRegistry::instance().find(name)) {
    std::string traffic = traffic_of(*type);
    traffic.pop_back();  // the newline
    return sim::wrapped(type->name + ": " + type->meaning, columns) + "\n" + keys(traffic, params_of(*type)) +
           "\nBeside these, the keys of every device: shoal describe device\n";
  }
  const shoal::MessageTypes& types = shoal::embedded_types();
  for (const std::string& full : {name, "shoal." + name})
    if (const shoal::MessageSchema* schema = types.find(std::string_view(full))) return message_text(*schema, columns);
  if (const std::string text = program_text(name, columns); !text.empty()) return text;
  return section_text(name, columns);
}

}  // namespace tools
