// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/log_import/mrclam_record.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "experiment/results/run_record.hpp"
#include "experiment/run/run_parts.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "messages/yaml/message_writer.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/swarm_position_t.hpp"
#include "sim/base/math.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

namespace {

/// Step of the world, in which the truth is interpolated: robots move at most some centimeters.
constexpr double mrclam_step_s = 0.05;

std::string robot_name(std::size_t index) {
  return fmt::format("robot{}", index + 1);
}

std::string subject_name(const MrclamData& data, int subject) {
  const bool is_robot = subject <= static_cast<int>(data.robots.size());
  return is_robot ? robot_name(static_cast<std::size_t>(subject - 1)) : fmt::format("landmark{}", subject);
}

/// Returns the whole second in which the truth of the last robot begins: from then on the places of all are known.
double start_of_data(const MrclamData& data) {
  double start_s = 0;
  for (const MrclamData::Robot& robot : data.robots) start_s = std::max(start_s, robot.truth.front().time_s);
  return std::floor(start_s);
}

double end_of_data(const MrclamData& data) {
  double end_s = 0;
  for (const MrclamData::Robot& robot : data.robots) end_s = std::max(end_s, robot.truth.back().time_s);
  return end_s;
}

/// Returns the last step with a true pose of a robot, since the start.
double end_of_truth(const MrclamData::Robot& robot, double start_s) {
  return std::floor((robot.truth.back().time_s - start_s) / mrclam_step_s) * mrclam_step_s;
}

/// Returns the true pose at a time, the first or last one outside of the data.
MrclamData::Pose pose_in(const std::vector<MrclamData::Pose>& truth, double time_s) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), time_s,
                                      [](const MrclamData::Pose& pose, double at_s) { return pose.time_s < at_s; });
  if (after == truth.begin()) return truth.front();
  if (after == truth.end()) return truth.back();
  const MrclamData::Pose& before = *std::prev(after);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return {time_s, before.x_m + share * (after->x_m - before.x_m), before.y_m + share * (after->y_m - before.y_m),
          before.yaw_rad + share * sim::wrap_angle(after->yaw_rad - before.yaw_rad)};
}

/// Run without programs that is recorded as `shoal run --record` does.
class ImportedRun {
 public:
  ImportedRun(const MrclamData& data, const std::string& log, bool overwrite)
      // The record is written by the same parts as that of a run, so that every command reads it.
      : data_(data),
        start_s_(start_of_data(data)),
        loaded_(load(mrclam_world(data), log)),
        parts_(loaded_, options(log, overwrite), {.files = files_text(loaded_.resolved)}),
        sources_(data.robots.size()) {}

  MrclamRecord go() {
    parts_.service.publish_info();
    parts_.journal.start();
    parts_.service.publish_step();
    parts_.journal.after_step();
    const auto steps = static_cast<std::int64_t>(std::llround(loaded_.config.run.duration_s / mrclam_step_s));
    for (std::int64_t i = 0; i < steps; ++i) {
      parts_.buses.set_time(world().now());
      publish();
      move();
      parts_.journal.admitted("", parts_.buses.gate().admit());
      world().step();
      parts_.service.publish_step();
      parts_.journal.after_step();
    }
    parts_.journal.finish();
    parts_.buses.close_record();
    if (const auto error = parts_.buses.record_error()) throw std::runtime_error(*error);
    record_.duration_s = sim::to_seconds(world().now());
    return record_;
  }

 private:
  /// Reader of the messages of a robot.
  struct Source {
    std::size_t odometry = 0, measurement = 0;
    double time_s = 0, x_m = 0, y_m = 0, theta_rad = 0;  ///< of dead reckoning
  };

  static sim::LoadedWorld load(const std::string& world, const std::string& log) {
    sim::LoadOptions options;
    options.encode_message = shoal::encode_own_message;
    return sim::load_world_text(world, log + ": world", options);
  }

  static RunOptions options(const std::string& log, bool overwrite) {
    RunOptions run;
    run.bus = "none";
    run.record = log;
    run.overwrite = overwrite;
    run.special_files = true;
    run.serial_ports = false;
    return run;
  }

  sim::World& world() { return parts_.world; }
  std::int64_t utime(double time_s) const { return std::llround(time_s * 1e6); }

  /// Puts the robots where they are at the end of the step.
  void move() {
    const double time_s = start_s_ + sim::to_seconds(world().now() + world().step_time());
    shoal::sim_control_request_t request{};
    request.client = "import";
    request.command = "do";
    for (std::size_t i = 0; i < data_.robots.size(); ++i) {
      const MrclamData::Pose pose = pose_in(data_.robots[i].truth, time_s);
      request.text +=
          fmt::format("- {{move: {{name: {}, position_m: [{:.6f}, {:.6f}, 0], rpy_deg: [0, 0, {:.6f}]}}}}\n",
                      robot_name(i), pose.x_m, pose.y_m, sim::radians_to_degrees(sim::wrap_angle(pose.yaw_rad)));
    }
    parts_.service.execute_local(request, nullptr);
  }

  /// Publishes what the robots had measured by now.
  void publish() {
    const double now_s = start_s_ + sim::to_seconds(world().now());
    for (std::size_t i = 0; i < data_.robots.size(); ++i) {
      const MrclamData::Robot& robot = data_.robots[i];
      Source& source = sources_[i];
      for (; source.odometry < robot.odometry.size() && robot.odometry[source.odometry].time_s <= now_s;
           ++source.odometry)
        if (robot.odometry[source.odometry].time_s >= start_s_)
          publish_odometry(i, source, robot.odometry[source.odometry]);
      for (; source.measurement < robot.measurements.size() && robot.measurements[source.measurement].time_s <= now_s;
           ++source.measurement)
        publish_measurement(i, robot.measurements[source.measurement]);
    }
  }

  /// The velocities hold until the next ones.  Dead reckoning begins at the start.
  void publish_odometry(std::size_t robot, Source& source, const MrclamData::Odometry& odometry) {
    const MrclamData::Odometry& before = data_.robots[robot].odometry[source.odometry == 0 ? 0 : source.odometry - 1];
    const double dt_s = odometry.time_s - std::max(before.time_s, start_s_);
    const double middle_rad = source.theta_rad + 0.5 * dt_s * before.turn_radps;
    source.x_m += dt_s * before.forward_mps * std::cos(middle_rad);
    source.y_m += dt_s * before.forward_mps * std::sin(middle_rad);
    source.theta_rad += dt_s * before.turn_radps;
    shoal::odometry_t message{};
    message.utime = utime(odometry.time_s);
    message.x_m = source.x_m;
    message.y_m = source.y_m;
    message.theta_rad = source.theta_rad;
    message.forward_mps = odometry.forward_mps;
    message.turn_radps = odometry.turn_radps;
    parts_.buses.outer().publish(robot_name(robot) + ".odometry", shoal::encode(message), world().now());
    ++record_.odometries;
  }

  void publish_measurement(std::size_t robot, const MrclamData::Measurement& measurement) {
    shoal::swarm_position_t message{};
    message.utime = utime(measurement.time_s);
    message.count = 1;
    message.vehicle.push_back(subject_name(data_, measurement.subject));
    message.relative_m.push_back({measurement.range_m * std::cos(measurement.bearing_rad),
                                  measurement.range_m * std::sin(measurement.bearing_rad), 0});
    message.absolute_m.push_back({std::nan(""), std::nan(""), std::nan("")});
    parts_.buses.outer().publish(robot_name(robot) + ".swarm_position", shoal::encode(message), world().now());
    ++record_.measurements;
  }

  const MrclamData& data_;
  const double start_s_;
  sim::LoadedWorld loaded_;
  RunParts parts_;
  std::vector<Source> sources_;
  MrclamRecord record_;
};

}  // namespace

namespace {

/// The greatest N of the files RobotN_... of a data set, at least 1.
int count_of_robots(const std::string& directory) {
  int count = 1;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    const std::string name = entry.path().filename().string();
    int number = 0, end = 0;
    if (std::sscanf(name.c_str(), "Robot%4d_%n", &number, &end) != 1 || end == 0) continue;
    for (const char* file : {"Groundtruth.dat", "Odometry.dat", "Measurement.dat"})
      if (name.substr(static_cast<std::size_t>(end)) == file) count = std::max(count, number);
  }
  return count;
}

}  // namespace

MrclamData read_mrclam(const std::string& directory) {
  const auto path = [&](const std::string& file) { return directory + "/" + file; };
  const auto read = [&](const std::string& file) { return read_whole_file(path(file)); };
  MrclamData data;
  const std::map<int, int> subjects = parse_mrclam_barcodes(read("Barcodes.dat"), path("Barcodes.dat"));
  data.landmarks = parse_mrclam_landmarks(read("Landmark_Groundtruth.dat"), path("Landmark_Groundtruth.dat"));
  const int count = count_of_robots(directory);
  for (int number = 1; number <= count; ++number) {
    const std::string stem = fmt::format("Robot{}_", number);
    MrclamData::Robot robot;
    robot.truth = parse_mrclam_truth(read(stem + "Groundtruth.dat"), path(stem + "Groundtruth.dat"));
    robot.odometry = parse_mrclam_odometry(read(stem + "Odometry.dat"), path(stem + "Odometry.dat"));
    parse_mrclam_measurements(read(stem + "Measurement.dat"), path(stem + "Measurement.dat"), subjects, robot);
    data.robots.push_back(std::move(robot));
  }
  // The record begins with the last robot, so that all have a true pose from the start.
  const double start_s = start_of_data(data);
  for (std::size_t i = 0; i < data.robots.size(); ++i)
    if (end_of_truth(data.robots[i], start_s) <= 0)
      sim::throw_config_error(
          {sim::intern_file_name(path(fmt::format("Robot{}_Groundtruth.dat", i + 1)))}, "",
          fmt::format("must have poses after {:.0f} s, when the last robot begins, the last one is of {:.3f} s",
                      start_s, data.robots[i].truth.back().time_s));
  return data;
}

std::string mrclam_world(const MrclamData& data) {
  const double start_s = start_of_data(data);
  const double duration_s = std::ceil((end_of_data(data) - start_s) / mrclam_step_s) * mrclam_step_s;
  const auto seconds = static_cast<std::time_t>(start_s);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char epoch[32] = {};
  std::strftime(epoch, sizeof epoch, "%Y-%m-%dT%H:%M:%SZ", &utc);
  std::string yaml = fmt::format(
      "shoal: 1\nname: mrclam\ndescription: A data set of the UTIAS MR.CLAM collection, along its true tracks.\n"
      "epoch: \"{}\"\nrun: {{duration_s: {:.2f}, speed: max}}\nphysics: {{step_s: {}}}\n",
      epoch, duration_s, mrclam_step_s);
  if (!data.landmarks.empty()) yaml += "objects:\n";
  for (const MrclamData::Landmark& landmark : data.landmarks)
    yaml += fmt::format(
        "  - {{name: {}, fixed: true, position_m: [{:.6f}, {:.6f}, 0.3], parts: [{{shape: cylinder, radius_m: 0.05, "
        "length_m: 0.6}}]}}\n",
        subject_name(data, landmark.subject), landmark.x_m, landmark.y_m);
  yaml += "vehicles:\n";
  // The robots of the data set are iRobot Create. They are kinematic: the record moves them along their true tracks.
  for (std::size_t i = 0; i < data.robots.size(); ++i) {
    const MrclamData::Pose pose = pose_in(data.robots[i].truth, start_s);
    yaml += fmt::format(
        "  - {{name: {}, position_m: [{:.6f}, {:.6f}, 0], rpy_deg: [0, 0, {:.6f}], model: {{shoal: 1, vehicle: create, "
        "bodies: [{{name: base, kinematic: true, parts: [{{shape: cylinder, radius_m: 0.17, length_m: 0.1, position_m: "
        "[0, 0, 0.05]}}]}}]}}}}\n",
        robot_name(i), pose.x_m, pose.y_m, sim::radians_to_degrees(sim::wrap_angle(pose.yaw_rad)));
  }
  yaml += "metrics:\n";
  for (std::size_t i = 0; i < data.robots.size(); ++i) {
    const double until_s = end_of_truth(data.robots[i], start_s);
    yaml +=
        fmt::format("  - {{name: {0}, type: position_error, vehicle: {0}, channel: {0}.estimate{1}}}\n", robot_name(i),
                    until_s < duration_s - mrclam_step_s ? fmt::format(", until_s: {:.2f}", until_s) : "");
  }
  return yaml;
}

MrclamRecord write_mrclam_record(const MrclamData& data, const std::string& log, bool overwrite) {
  return ImportedRun(data, log, overwrite).go();
}

}  // namespace experiment
