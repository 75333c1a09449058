// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/run_record.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "experiment/files/json_reader.hpp"

namespace experiment {

namespace {

constexpr std::uintmax_t max_bytes = std::uintmax_t{64} << 20;

std::map<std::string, std::optional<double>> read_figures(const JsonReader& in) {
  std::map<std::string, std::optional<double>> figures;
  for (const auto& [name, value] : in.object("metrics").items()) {
    if (!value.is_number() && !value.is_null())
      throw std::runtime_error(in.where() + ": 'metrics': '" + name + "' must be a number or null, got " +
                               shown_json(value));
    figures[name] = value.is_null() ? std::nullopt : std::optional<double>(value.get<double>());
  }
  return figures;
}

/// Older versions recorded a run without rules as passed.
Judgement judgement_in(const JsonReader& in, bool has_rules) {
  if (in.at("passed").is_null()) return Judgement::not_judged;
  const bool passed = in.boolean("passed");
  const bool judged = in.has("judged") ? in.boolean("judged") : has_rules;
  return passed && !judged ? Judgement::not_judged : judgement_of(passed);
}

}  // namespace

std::string read_whole_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw std::runtime_error(path + ": is a folder");
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw std::runtime_error(path + ": is not a regular file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + ": cannot be read: " + std::strerror(errno));
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > max_bytes) throw std::runtime_error(path + ": is larger than 64 MB");
  return {std::istreambuf_iterator<char>(in), {}};
}

nlohmann::ordered_json read_json_file(const std::string& path) {
  return parse_json(read_whole_file(path), path);
}

RunRecord read_run(const std::string& directory) {
  const std::string path = directory + "/summary.json";
  const auto json = read_json_file(path);
  const JsonReader in(json, path);
  // Run and state.
  RunRecord run;
  run.directory = directory;
  run.world = in.text("world");
  if (in.has("description")) run.description = in.text("description");
  run.seed = in.whole("seed");
  run.steps = in.whole("steps");
  run.sim_time_s = in.number("sim_time_s");
  run.wall_s = in.number("wall_s");
  run.state_hash = in.text("state_hash");
  if (in.has("run_hash")) run.run_hash = in.text("run_hash");
  run.messages = in.whole("messages");
  run.dropped_messages = in.whole("dropped_messages");
  run.bad_messages = in.whole("bad_messages");
  run.quick_steps = in.whole("quick_steps");
  if (in.has("modem_dropped_messages")) run.modem_dropped_messages = in.whole("modem_dropped_messages");
  run.metrics = read_figures(in);
  // Rules, programs and contacts.
  for (const auto& item : in.list("rules")) {
    const JsonReader rule(item, path + ": rules");
    run.rules.push_back({rule.text("rule"), rule.boolean("passed"), rule.has("result") ? rule.text("result") : ""});
  }
  for (const auto& item : in.list("processes")) {
    const JsonReader process(item, path + ": processes");
    run.processes.push_back({process.text("name"), process.text("how"), process.number("sim_time_s"),
                             process.has("failed") && process.boolean("failed")});
  }
  if (in.has("contacts"))
    for (const auto& item : in.list("contacts")) {
      const JsonReader contact(item, path + ": contacts");
      run.contacts.push_back(
          {contact.text("vehicle"), contact.text("with"), contact.number("first_s"), contact.whole("count")});
    }
  // Shadows.
  if (in.has("acoustics")) {
    const auto acoustics = in.object("acoustics");
    const JsonReader sound(acoustics, path + ": acoustics");
    if (sound.has("shadowed"))
      for (const auto& item : sound.list("shadowed")) {
        const JsonReader loss(item, path + ": acoustics: shadowed");
        run.shadowed.push_back({loss.number("sent_s"), loss.text("from"), loss.text("to"), loss.number("range_m")});
      }
    if (sound.has("lost")) {
      const auto lost = sound.object("lost");
      const JsonReader causes(lost, path + ": acoustics: lost");
      if (causes.has("shadow")) run.shadowed_count = causes.whole("shadow");
    }
  }
  // Verdict and end.
  if (in.has("event")) {
    const JsonReader event(in.object("event"), path + ": event");
    run.event = RunRecord::Rule{event.text("text"), event.boolean("passed")};
  }
  run.judgement = judgement_in(in, !run.rules.empty() || run.event);
  if (run.judgement == Judgement::not_judged)
    run.not_judged = in.has("not_judged") ? in.text("not_judged") : "it had no rules";
  run.ended = in.text("ended");
  run.error = in.text("error");
  run.exit_code = static_cast<int>(in.whole("exit_code"));
  if (in.has("shoal")) run.version = in.text("shoal");
  if (in.has("build")) run.build = in.text("build");
  return run;
}

}  // namespace experiment
