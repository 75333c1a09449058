#include "tools/experiment/results.hpp"

#include <spawn.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

extern char** environ;

namespace tools {

namespace {

/// More vehicles than this are drawn as dots in one colour.
constexpr std::size_t most_named_tracks = 12;

/// Corners of a box, or a circle, as a closed line on the ground.
std::string outline_of(const sim::PartConfig& part, const sim::Pose& X_WB) {
  const sim::Pose X_WP = X_WB * sim::make_pose(part.position_m, part.rpy_rad);
  std::string text;
  const auto add = [&](double x, double y) {
    const sim::Vector3d p = X_WP * sim::Vector3d(x, y, 0);
    text += fmt::format("{:.4f} {:.4f}\n", p.x(), p.y());
  };
  if (part.shape == "box") {
    const double x = part.size_m.x() / 2;
    const double y = part.size_m.y() / 2;
    add(x, y), add(-x, y), add(-x, -y), add(x, -y), add(x, y);
  } else if (part.shape == "sphere" || part.shape == "cylinder" || part.shape == "capsule") {
    for (int i = 0; i <= 24; ++i)
      add(part.radius_m * std::cos(i * std::numbers::pi / 12), part.radius_m * std::sin(i * std::numbers::pi / 12));
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace

bool Summary::passed() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Scoring::Verdict& v) { return v.passed; });
}

std::string Summary::to_json() const {
  nlohmann::ordered_json json;
  json["world"] = world;
  json["seed"] = seed;
  json["steps"] = steps;
  json["sim_time_s"] = sim_time_s;
  json["wall_s"] = wall_s;
  json["real_time_factor"] = real_time_factor();
  json["state_hash"] = fmt::format("{:016x}", state_hash);
  json["messages"] = messages;
  json["dropped_messages"] = dropped_messages;
  json["bad_messages"] = bad_messages;
  json["quick_steps"] = quick_steps;
  json["metrics"] = nlohmann::ordered_json::object();
  for (const auto& [name, value] : metrics) json["metrics"][name] = value;  // NaN becomes null
  json["rules"] = nlohmann::ordered_json::array();
  for (const Scoring::Verdict& verdict : verdicts)
    json["rules"].push_back({{"rule", verdict.rule}, {"passed", verdict.passed}});
  json["passed"] = passed() && exit_code == 0;
  json["ended"] = ended;
  json["error"] = error;
  json["exit_code"] = exit_code;
  return json.dump(2) + "\n";
}

std::string Summary::to_text() const {
  std::string text = fmt::format(
      "world {}  seed {}\n"
      "  {} steps, {:.2f} s simulated in {:.2f} s: {:.1f} x real time\n"
      "  {} messages, {} dropped, {} bad\n",
      world, seed, steps, sim_time_s, wall_s, real_time_factor(), messages, dropped_messages, bad_messages);
  if (quick_steps > 0)
    text += fmt::format("  {} steps used QuickStep, for an island of bodies was too large\n", quick_steps);
  for (const auto& [name, value] : metrics) text += fmt::format("  {:<28} {:.4g}\n", name, value);
  for (const Scoring::Verdict& verdict : verdicts)
    text += fmt::format("  {}: {}\n", verdict.passed ? "passed" : "FAILED", verdict.rule);
  text += fmt::format("  state hash {:016x}\n", state_hash);
  return text;
}

Results::Results(const std::string& directory, const sim::World& world) : directory_(directory), world_(world) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  const std::string path = directory + "/tracks.csv";
  tracks_ = error ? nullptr : std::fopen(path.c_str(), "w");
  if (tracks_ == nullptr)
    throw std::runtime_error("cannot write results to '" + path +
                             "': " + (error ? error.message() : std::string(std::strerror(errno))));
  std::fprintf(tracks_, "time_s,vehicle,x_m,y_m,z_m,yaw_rad\n");
  const double step_s = sim::to_seconds(world.step_time());
  every_steps_ = std::max<std::int64_t>(1, std::llround(1.0 / (world.config().run.track_rate_hz * step_s)));
  write_outlines();
}

Results::~Results() {
  if (tracks_ != nullptr) std::fclose(tracks_);
}

void Results::after_step() {
  if (world_.step_number() % every_steps_ != 0) return;
  for (const auto& vehicle : world_.vehicles()) {
    const sim::Pose X_WV = vehicle->X_WV();
    const sim::Vector3d p = X_WV.translation();
    std::fprintf(tracks_, "%.6f,%s,%.6f,%.6f,%.6f,%.6f\n", sim::to_seconds(world_.now()), vehicle->name().c_str(),
                 p.x(), p.y(), p.z(), sim::yaw_of(X_WV.linear()));
  }
}

void Results::write(const std::string& file, const std::string& text) const {
  const std::string path = directory_ + "/" + file;
  std::ofstream out(path, std::ios::binary);
  out << text << std::flush;
  if (!out) throw std::runtime_error("cannot write results to '" + path + "': " + std::strerror(errno));
}

void Results::write_outlines() const {
  std::string text;
  std::size_t body = 0;  // objects are built first, one body each
  for (const sim::ObjectConfig& object : world_.config().objects)
    for (int i = 0; i < object.count; ++i, ++body)
      for (const sim::PartConfig& part : object.parts)
        text += outline_of(part, world_.physics().bodies()[body]->X_WB());
  write("outlines.dat", text.empty() ? "0 0\n" : text);
}

void Results::write_errors(const Scoring& scoring) const {
  std::string text = "time_s,metric,error_m,estimate_x_m,estimate_y_m,truth_x_m,truth_y_m\n";
  for (const Scoring::Track& track : scoring.tracks())
    for (const Scoring::Sample& sample : track.samples)
      text += fmt::format("{:.6f},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", sample.time_s, track.metric,
                          sample.error_m(), sample.estimate_m.x(), sample.estimate_m.y(), sample.truth_m.x(),
                          sample.truth_m.y());
  write("errors.csv", text);
}

void Results::finish(const Summary& summary, const Scoring& scoring, const sim::ConfigNode& resolved) {
  const bool tracks_ok = std::fclose(tracks_) == 0;
  tracks_ = nullptr;
  if (!tracks_ok) throw std::runtime_error("cannot write results to '" + directory_ + "/tracks.csv'");
  write("summary.json", summary.to_json());
  std::string metrics = "metric,value\n";
  for (const auto& [name, value] : summary.metrics) metrics += fmt::format("{},{:.9g}\n", name, value);
  write("metrics.csv", metrics);
  write_errors(scoring);
  write("world.yaml", sim::to_yaml(resolved));
  plot(scoring);
}

void Results::plot(const Scoring& scoring) const {
  const auto tracks = scoring.tracks();
  std::string script =
      // The vehicles' rows alternate: without `missing` each row of another one would break the line.
      "set datafile separator ','\nset datafile missing NaN\n"
      "set terminal pngcairo size 1000,1080\nset output 'tracks.png'\n"
      "set size ratio -1\nset xlabel 'east (m)'\nset ylabel 'north (m)'\nset grid\nset key below\n"
      "set title '" + world_.config().name + "' noenhanced\n"
      "plot 'outlines.dat' using (real(word(strcol(1),1))):(real(word(strcol(1),2))) with lines lc 'gray40' notitle";
  if (world_.vehicles().size() > most_named_tracks) {
    script += ", 'tracks.csv' every ::1 using 3:4 with dots lc 'blue' title 'vehicles'";
  } else {
    for (const auto& vehicle : world_.vehicles())
      script += fmt::format(", 'tracks.csv' every ::1 using (strcol(2) eq '{0}' ? $3 : NaN):4 with lines lw 2 "
                            "title '{0}' noenhanced",
                            vehicle->name());
  }
  for (const Scoring::Track& track : tracks)
    script += fmt::format(", 'errors.csv' every ::1 using (strcol(2) eq '{0}' ? $4 : NaN):5 with lines dt 2 title "
                          "'{0} estimate of {1}' noenhanced",
                          track.metric, track.vehicle);
  script += "\n";
  if (!tracks.empty()) {
    script += "set output 'errors.png'\nset size noratio\nset xlabel 'time (s)'\nset ylabel 'position error (m)'\nplot ";
    for (std::size_t i = 0; i < tracks.size(); ++i)
      script += fmt::format("{0}'errors.csv' every ::1 using (strcol(2) eq '{1}' ? $1 : NaN):3 with lines lw 2 title "
                            "'{1}' noenhanced",
                            i > 0 ? ", " : "", tracks[i].metric);
    script += "\n";
  }
  write("plot.gp", script);
  // The script names its files without a directory, so that the folder can be moved and plotted again.
  std::string command = "cd \"$0\" && exec gnuplot plot.gp > plot.log 2>&1";
  std::string shell = "sh";
  std::string option = "-c";
  std::string directory = directory_;
  char* arguments[] = {shell.data(), option.data(), command.data(), directory.data(), nullptr};
  pid_t pid = 0;
  int status = -1;
  if (posix_spawnp(&pid, "sh", nullptr, nullptr, arguments, environ) == 0) waitpid(pid, &status, 0);
  if (status != 0) spdlog::warn("no pictures: gnuplot failed, see {}/plot.log", directory_);
}

}  // namespace tools
