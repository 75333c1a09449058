// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/results/results.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bridges/base/json_text.hpp"
#include "experiment/files/gnuplot.hpp"
#include "experiment/results/results_folder.hpp"
#include "experiment/results/run_plots.hpp"
#include "experiment/results/summary_file.hpp"
#include "sim/base/log.hpp"
#include "sim/base/number.hpp"

namespace experiment {

namespace {

/// Returns the corners of a box, or a circle, as a closed line on the ground.
std::string outline_of(const sim::PartConfig& part, const sim::Pose& X_WB) {
  const sim::Pose X_WP = X_WB * sim::make_pose(part.position_m, part.rpy_rad);
  std::string text;
  const auto add = [&](double x, double y) {
    const sim::Vector3d p = X_WP * sim::Vector3d(x, y, 0);
    text += fmt::format("{:.4f} {:.4f}\n", p.x(), p.y());
  };
  if (part.shape == sim::PartShape::box) {
    const double x = part.size_m.x() / 2;
    const double y = part.size_m.y() / 2;
    add(x, y), add(-x, y), add(-x, -y), add(x, -y), add(x, y);
  } else if (sim::shape_info(part.shape).round) {
    for (int i = 0; i <= 24; ++i)
      add(part.radius_m * std::cos(i * std::numbers::pi / 12), part.radius_m * std::sin(i * std::numbers::pi / 12));
  }
  return text.empty() ? text : text + "\n";
}

std::runtime_error cannot_write(const std::string& path, const std::string& reason) {
  return std::runtime_error("cannot write results to '" + path + "': " + reason);
}

void write_file(const std::string& path, const std::string& text) {
  remove_link(path);
  std::ofstream out(path, std::ios::binary);
  out << text << std::flush;
  if (!out) throw cannot_write(path, std::strerror(errno));
}

}  // namespace

Judgement Summary::judgement() const {
  const bool rules_hold =
      std::all_of(verdicts.begin(), verdicts.end(), [](const Scoring::Verdict& v) { return v.passed; });
  if (!rules_hold || (event && !event->passed)) return Judgement::failed;
  if (ended_by_hand()) return Judgement::not_judged;
  if (exit_code != 0) return Judgement::failed;
  return verdicts.empty() && !event ? Judgement::not_judged : Judgement::passed;
}

std::string Summary::why_not_judged() const {
  if (!ended_by_hand()) return no_verdicts;
  std::string how = "ended by quit";
  if (ended == "signal") {
    const char* name = sigabbrev_np(exit_code - 128);
    how = name != nullptr ? fmt::format("ended by SIG{}", name) : "ended by a signal";
  } else if (ended == "rewound") {
    how = "left for another branch";
  }
  const std::string of = duration_s > 0 ? fmt::format(" of {:.10g}", duration_s) : "";
  return fmt::format("{} at {:.10g}{} s", how, sim_time_s, of);
}

void Summary::judge_processes() {
  for (const Process& process : processes)
    if (process.failed)
      verdicts.push_back(
          {fmt::format("process '{}' must not fail; it {} at {:.2f} s", process.name, process.how, process.sim_time_s),
           false});
}

void Summary::judge_clients() {
  for (const bridges::LockstepSummary& client : clients)
    if (client.contradictions > 0)
      verdicts.push_back(
          {fmt::format("client '{}' must give one answer to each tick; another program gave {} different one{} under "
                       "its name",
                       client.client, client.contradictions, client.contradictions == 1 ? "" : "s"),
           false});
}

void Summary::fail(int code, const std::string& how_ended, const std::string& why) {
  exit_code = code;
  ended = how_ended;
  error = why;
}

namespace {

/// Lists the first phrases in one line.
std::string listed(const std::vector<std::string>& phrases) {
  constexpr std::size_t max = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(max, phrases.size()); ++i) text += (i == 0 ? "" : "; ") + phrases[i];
  return phrases.size() <= max ? text : text + fmt::format("; and {} more, see summary.json", phrases.size() - max);
}

/// Lists the first hundred pairs: a dense swarm has thousands.
nlohmann::ordered_json contacts_json(const std::vector<FirstContacts::Contact>& contacts) {
  constexpr std::size_t max = 100;
  auto json = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < std::min(max, contacts.size()); ++i)
    json.push_back({{"vehicle", contacts[i].first},
                    {"with", contacts[i].second},
                    {"first_s", contacts[i].first_s},
                    {"count", contacts[i].count}});
  return json;
}

constexpr std::size_t many_zeros = 4;

/// Text of the figures, one in a line; many of a metric that are 0 share one.
std::string figures_text(const std::map<std::string, double>& figures) {
  std::map<std::string, std::vector<std::string>> zeros;  // by metric
  for (const auto& [name, value] : figures)
    if (const std::size_t dot = name.rfind('.'); value == 0 && dot != std::string::npos)
      zeros[name.substr(0, dot)].push_back(name.substr(dot + 1));
  std::erase_if(zeros, [](const auto& each) { return each.second.size() < many_zeros; });
  const auto is_folded = [&](const std::string& name, double value) {
    return value == 0 && zeros.contains(name.substr(0, name.rfind('.')));
  };
  std::size_t width = 28;
  for (const auto& [name, value] : figures)
    if (!is_folded(name, value)) width = std::max(width, name.size());
  std::string text;
  for (const auto& [name, value] : figures)
    if (!is_folded(name, value))
      text += fmt::format("  {:<{}} {}\n", name, width, std::isnan(value) ? "none" : fmt::format("{:.4g}", value));
  for (const auto& [metric, names] : zeros) text += fmt::format("  0 in {}: {}\n", metric, fmt::join(names, ", "));
  return text;
}

}  // namespace

std::string Summary::to_json() const {
  nlohmann::ordered_json json;
  // Run and state.
  json["world"] = world;
  json["description"] = description;
  json["seed"] = seed;
  json["steps"] = steps;
  json["sim_time_s"] = sim_time_s;
  json["duration_s"] = duration_s;
  json["wall_s"] = wall_s;
  json["real_time_factor"] = real_time_factor();
  json["run_hash"] = fmt::format("{:016x}", run_hash);
  json["state_hash"] = fmt::format("{:016x}", state_hash);
  json["messages"] = messages;
  json["dropped_messages"] = dropped_messages;
  json["bad_messages"] = bad_messages;
  json["quick_steps"] = quick_steps;
  // Metrics, rules and contacts.
  json["metrics"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : metrics) json["metrics"][name] = value;  // NaN becomes null
  json["rules"] = nlohmann::ordered_json::array();
  for (const Scoring::Verdict& verdict : verdicts) json["rules"].push_back(json_of(verdict));
  json["contacts"] = contacts_json(contacts);
  json["contact_pairs"] = contacts.size();
  // Programs and clients.
  json["processes"] = nlohmann::ordered_json::array();
  for (const Process& process : processes)
    json["processes"].push_back(
        {{"name", process.name}, {"how", process.how}, {"sim_time_s", process.sim_time_s}, {"failed", process.failed}});
  if (!clients.empty()) json["clients"] = nlohmann::ordered_json::array();
  for (const bridges::LockstepSummary& client : clients) {
    json["clients"].push_back({{"name", client.client},
                               {"ticks", client.ticks},
                               {"repeated_ticks", client.repeated_ticks},
                               {"messages_resent", client.messages_resent},
                               {"messages_requested", client.messages_requested},
                               {"messages_repeated", client.messages_repeated},
                               {"timeouts", client.timeouts},
                               {"contradictions", client.contradictions},
                               {"ended", client.ended.empty() ? "with the run" : client.ended}});
    if (!client.ended.empty()) json["clients"].back()["ended_s"] = client.ended_s;
  }
  if (!not_recorded.empty()) json["not_recorded"] = not_recorded;
  if (!not_repeatable.empty()) json["not_repeatable"] = not_repeatable;
  if (!warnings.empty()) json["warnings"] = warnings;
  // Control, zones and modems.
  json["control"] = {{"needs_key", needs_key}, {"refused_requests", refused_requests}, {"audit_count", audit_count}};
  json["control"]["audit"] = audit_json(audit);
  for (const auto& [vehicle, record] : zones) {
    auto& entry = json["zones"][vehicle];
    entry["finish_s"] = record.finish_s ? nlohmann::ordered_json(*record.finish_s) : nlohmann::ordered_json();
    entry["speeding_s"] = record.speeding_s;
  }
  if (acoustics) {
    json["acoustics"] = {{"sent", acoustics->sent}, {"received", acoustics->received}, {"unsent", acoustics->unsent}};
    json["acoustics"]["lost"] = nlohmann::ordered_json::object();
    for (const auto& [cause, count] : acoustics->lost)
      if (count > 0) json["acoustics"]["lost"][cause] = count;
    json["acoustics"]["effects"] = acoustic_effects;
    for (const Shadowed& loss : shadowed)
      json["acoustics"]["shadowed"].push_back(
          {{"sent_s", loss.sent_s}, {"from", loss.from}, {"to", loss.to}, {"range_m", loss.range_m}});
  }
  json["modem_dropped_messages"] = modem_dropped_messages;
  json["serial_dropped_bytes"] = serial_dropped_bytes;
  // Verdict and end.
  if (event) json["event"] = {{"text", event->text}, {"passed", event->passed}};
  json["judged"] = judged();
  if (!judged()) json["not_judged"] = why_not_judged();
  json["passed"] = nullptr;
  if (const auto flag = as_flag(judgement())) json["passed"] = *flag;
  json["ended"] = ended;
  json["error"] = error;
  json["exit_code"] = exit_code;
  json["shoal"] = version;
  json["build"] = build;
  if (branch > 0) json["branch"] = branch;
  if (!snapshot.empty()) json["snapshot"] = snapshot;
  if (!snapshot.empty()) json["metrics_from_s"] = from_s;
  // The name of a client may contain any bytes: invalid UTF-8 must not prevent the summary.
  return bridges::json_text(json, 2) + "\n";
}

std::string Summary::to_text() const {
  std::string text = fmt::format("world {}  seed {}\n", world, seed);
  // The verdict.
  for (const Scoring::Verdict& verdict : verdicts)
    text += fmt::format("  {}: {}\n", verdict.passed ? "passed" : "FAILED", verdict.text());
  if (event) text += fmt::format("  ended by an event, {}: {}\n", event->passed ? "passed" : "FAILED", event->text);
  if (!judged())
    text += ended_by_hand() ? fmt::format("  {}: not judged\n", why_not_judged())
                            : fmt::format("  not judged: {}\n", why_not_judged());
  text += fmt::format(
      "  {} steps, {:.2f} s simulated in {:.2f} s: {:.1f} x real time\n"
      "  {} messages, {} dropped, {} bad\n",
      steps, sim_time_s, wall_s, real_time_factor(), messages, dropped_messages, bad_messages);
  // Branches and accuracy.
  if (!snapshot.empty())
    text += fmt::format("  {:.2f} s of it here, from {}; metrics count from {:.2f} s\n", stepped_s, snapshot, from_s);
  if (branch > 0) text += fmt::format("  branch {}: the run was rewound\n", branch);
  if (quick_steps > 0)
    text += fmt::format(
        "  {} steps used QuickStep, for islands of bodies that are too large or that ODE's exact solver gave up\n",
        quick_steps);
  if (!threads_advice.empty()) text += "  " + threads_advice + "\n";
  // Modems and serial ports.
  if (acoustics) {
    text += fmt::format("  acoustic packets: {} sent, {} received", acoustics->sent, acoustics->received);
    for (const auto& [cause, count] : acoustics->lost)
      if (count > 0) text += fmt::format(", {} lost ({})", count, cause);
    if (acoustics->unsent > 0) text += fmt::format(", {} not sent", acoustics->unsent);
    text += '\n';
  }
  if (modem_dropped_messages > 0)
    text += fmt::format("  {} messages were dropped from full queues of modems\n", modem_dropped_messages);
  if (serial_dropped_bytes > 0) text += fmt::format("  {} bytes of serial ports were not read\n", serial_dropped_bytes);
  // Contacts and metrics.
  text += contacts_text(contacts) + figures_text(metrics);
  // Programs, interventions and zones.
  for (const Process& process : processes)
    text += fmt::format("  process '{}' {} at {:.2f} s\n", process.name, process.how, process.sim_time_s);
  if (!not_recorded.empty()) text += "  not in the record: " + listed(not_recorded) + "\n";
  if (!not_repeatable.empty()) text += "  not repeatable: " + listed(not_repeatable) + "\n";
  for (const bridges::AuditEntry& audit_entry : audit) text += "  " + audit_text(audit_entry) + "\n";
  if (refused_requests > 0)
    text += fmt::format("  {} requests without the key of the run were rejected\n", refused_requests);
  for (const auto& [vehicle, record] : zones) {
    if (record.finish_s) text += fmt::format("  {} finished at {:.2f} s\n", vehicle, *record.finish_s);
    if (record.speeding_s > 0) text += fmt::format("  {} was too fast for {:.2f} s\n", vehicle, record.speeding_s);
  }
  text += fmt::format("  run hash {:016x}, state hash {:016x}\n", run_hash, state_hash);
  return text;
}

namespace {

/// The number of rules and metrics is small, that of zones and contacts grows with the vehicles.
std::size_t room_for_summary(const sim::World& world) {
  return (std::size_t{256} << 10) + 512 * world.vehicles().size();
}

/// Creates the folder if it does not exist.
std::string made(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw cannot_write(directory, error.message());
  return directory;
}

}  // namespace

void write_summary(const std::string& directory, const Summary& summary) {
  const std::string path = directory + "/summary.json";
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!error) {
    write_file(path + ".part", summary.to_json());
    std::filesystem::rename(path + ".part", path, error);
  }
  if (error) throw cannot_write(path, error.message());
}

void try_to_write_summary(const std::string& directory, const Summary& summary) {
  try {
    write_summary(directory, summary);
  } catch (const std::exception& error) {
    sim::log_debug("{}", error.what());
  }
}

void write_results_world(const std::string& directory, const sim::ConfigNode& resolved) {
  write_file(directory + "/world.yaml", sim::to_yaml(resolved));
}

Results::Results(const std::string& directory, const sim::World& world, bool plots)
    : directory_(made(directory)), summary_file_(directory, room_for_summary(world)), world_(world), plots_(plots) {
  const std::string path = directory + "/tracks.csv";
  remove_link(path);
  tracks_ = std::fopen(path.c_str(), "w");
  if (tracks_ == nullptr) throw cannot_write(path, std::strerror(errno));
  // Start the tracks.
  std::fprintf(tracks_, "time_s,vehicle,x_m,y_m,z_m,yaw_rad\n");
  const double step_s = sim::to_seconds(world.step_time());
  every_steps_ = std::max<std::int64_t>(1, std::llround(1.0 / (world.config().run.track_rate_hz * step_s)));
  steps_per_second_ = std::max<std::int64_t>(1, std::llround(1.0 / step_s));
  write_outlines();
}

Results::~Results() {
  if (tracks_ != nullptr) std::fclose(tracks_);
}

void Results::after_step() {
  // Flushed once a second, so that a killed run leaves its tracks.
  if (world_.step_number() % steps_per_second_ == 0 && std::fflush(tracks_) != 0 && !error_)
    error_ = cannot_write(directory_ + "/tracks.csv", std::strerror(errno)).what();
  if (world_.step_number() % every_steps_ != 0) return;
  for (const auto& vehicle : world_.vehicles()) {
    const sim::Pose X_WV = vehicle->X_WV();
    const sim::Vector3d p = X_WV.translation();
    const std::string row = fmt::format("{:.6f},{},{:.6f},{:.6f},{:.6f},{:.6f}\n", sim::to_seconds(world_.now()),
                                        vehicle->name(), p.x(), p.y(), p.z(), sim::yaw_of(X_WV.linear()));
    if (std::fputs(row.c_str(), tracks_) < 0 && !error_)
      error_ = cannot_write(directory_ + "/tracks.csv", std::strerror(errno)).what();
  }
}

void Results::write(const std::string& file, const std::string& text) const {
  write_file(directory_ + "/" + file, text);
}

void Results::write_outlines() const {
  std::string text;
  for (const auto& [name, object] : world_.objects())
    for (std::size_t i = 0; i < object.bodies().size(); ++i)
      for (const sim::PartConfig& part : object.config->bodies[i].parts)
        text += outline_of(part, object.bodies()[i].second->X_WB());
  write("outlines.dat", text.empty() ? "0 0\n" : text);
}

void Results::write_errors(const std::string& directory, const Scoring& scoring) const {
  std::string text =
      "time_s,metric,error_m,estimate_x_m,estimate_y_m,truth_x_m,truth_y_m,estimate_z_m,truth_z_m,travelled_m,sigma_m,"
      "nees\n";
  for (const Scoring::Track& track : scoring.tracks())
    for (const ErrorSample& sample : *track.samples)
      text += fmt::format("{:.6f},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.3f},{:.6f},{:.6f}\n",
                          sample.time_s, track.metric, sample.error_m, sample.estimate_m.x(), sample.estimate_m.y(),
                          sample.truth_m.x(), sample.truth_m.y(), sample.estimate_m.z(), sample.truth_m.z(),
                          sample.travelled_m, sample.sigma_m, sample.nees);
  write_file(directory + "/errors.csv", text);
}

void Results::write_metrics(const std::string& directory, const Summary& summary) const {
  std::string text = "metric,value\n";
  for (const auto& [name, value] : summary.metrics) text += fmt::format("{},{:.9g}\n", name, value);
  write_file(directory + "/metrics.csv", text);
}

void Results::drop_branch() {
  std::error_code error;
  if (!kept_.empty()) std::filesystem::remove_all(kept_, error);
  kept_.clear();
}

void Results::start_branch(sim::Time back_to, bool ours) {
  kept_.clear();
  const std::string path = directory_ + "/tracks.csv";
  const auto cannot_cut = [&] { return cannot_write(path, std::strerror(errno)); };
  if (std::fflush(tracks_) != 0) throw cannot_cut();
  std::ifstream in(path);
  std::string line;
  std::uintmax_t keep = 0;
  // Times are written with all digits.
  for (bool first = true; std::getline(in, line); first = false) {
    const double time_s = sim::read_number(std::string_view(line).substr(0, line.find(','))).value_or(0);
    if (!first && (!ours || time_s > sim::to_seconds(back_to) + 1e-7)) break;
    keep += line.size() + 1;
  }
  std::error_code error;
  std::filesystem::resize_file(path, keep, error);
  if (error) throw cannot_write(path, error.message());
  if (std::fseek(tracks_, 0, SEEK_END) != 0) throw cannot_cut();
}

void Results::keep_branch(const Summary& left, const Scoring& scoring, const sim::ConfigNode& resolved) {
  const std::string directory = directory_ + "/branch" + std::to_string(left.branch);
  remove_link(directory);
  std::error_code error;
  // Only a folder that this run made may be removed again.
  if (!std::filesystem::exists(directory, error)) kept_ = directory;
  write_summary(directory, left);
  write_metrics(directory, left);
  write_errors(directory, scoring);
  write_file(directory + "/world.yaml", sim::to_yaml(resolved));
  if (std::fflush(tracks_) != 0) throw cannot_write(directory_ + "/tracks.csv", std::strerror(errno));
  remove_link(directory + "/tracks.csv");
  std::filesystem::copy_file(directory_ + "/tracks.csv", directory + "/tracks.csv",
                             std::filesystem::copy_options::overwrite_existing, error);
  if (error) throw cannot_write(directory + "/tracks.csv", error.message());
}

void Results::close_tracks() {
  const bool bad = std::ferror(tracks_) != 0;
  const bool closed = std::fclose(std::exchange(tracks_, nullptr)) == 0;
  if (bad || !closed)
    throw std::runtime_error(error_.value_or(
        cannot_write(directory_ + "/tracks.csv", closed ? "an earlier write failed" : std::strerror(errno)).what()));
}

void Results::finish(const Summary& summary, const Scoring& scoring, const sim::ConfigNode& resolved,
                     const std::function<bool()>& give_up) {
  std::optional<std::string> first_error;
  // Each file is tried, so that one error does not lose the others; the first one is reported.
  const auto attempt = [&](const auto& write_it) {
    try {
      write_it();
    } catch (const std::exception& error) {
      if (!first_error) first_error = error.what();
    }
  };
  attempt([&] { summary_file_.write(summary.to_json()); });
  attempt([&] { close_tracks(); });
  attempt([&] { write_metrics(directory_, summary); });
  attempt([&] { write_errors(directory_, scoring); });
  attempt([&] { write_results_world(directory_, resolved); });
  attempt([&] { plot(summary, scoring, give_up); });
  if (first_error) throw std::runtime_error(*first_error);
}

void Results::plot(const Summary& summary, const Scoring& scoring, const std::function<bool()>& give_up) const {
  if (summary.steps == 0 || error_ || !plots_) return;
  // The script names its files without a directory, so that the folder can be moved and plotted again.
  write("plot.gp", run_plots_script(world_, scoring));
  const bool plotted = run_gnuplot(directory_, "plot.gp", std::chrono::seconds(30), give_up);
  if (!plotted && !give_up() && summary.ended != "signal")
    sim::log_warn("no plots: gnuplot failed, see {}/plot.log", directory_);
}

}  // namespace experiment
