// SPDX-License-Identifier: BSD-3-Clause
// UberSim's test client: adds its robot, which stands on two wheels, to a run in lockstep, balances it, and leaves.
//   shoal run empty.yaml --await cmu &
//   ubersim_client segway.xml
// docs/guides/spawn_vehicles.md has the world.  ubersim_client.py is the same program in Python.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "shoal/client.hpp"
#include "shoal/image_t.hpp"
#include "shoal/inclination_t.hpp"
#include "shoal/joint_settings_t.hpp"
#include "ubersim_robot.hpp"

namespace {

constexpr double period_s = 0.01;

struct Options {
  std::string file, name;
  double east_m = 0, north_m = 0;
  double seconds = 12;   ///< of simulated time, after which it leaves
  double added_deg = 0;  ///< to its tilt, from 2 to 5 s; to the other side to 8 s
  int width = 320;       ///< of its images, in pixels
};

constexpr const char* usage =
    "usage: ubersim_client FILE [--name NAME] [--position EAST NORTH] [--seconds S] [--tilt DEG] [--width PIXELS]\n";

double number(const char* text) {
  const std::string_view digits = text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), value);
  if (error != std::errc() || end != digits.end() || !(std::abs(value) < 1e6)) throw std::invalid_argument(text);
  return value;
}

Options parse(const std::vector<const char*>& arguments) {
  Options options;
  std::size_t at = 0;
  const auto next = [&] { return at < arguments.size() ? arguments[at++] : throw std::invalid_argument("the end"); };
  while (at < arguments.size()) {
    const std::string_view word = next();
    if (word == "--name") {
      options.name = next();
    } else if (word == "--position") {
      options.east_m = number(next());
      options.north_m = number(next());
    } else if (word == "--seconds") {
      options.seconds = number(next());
    } else if (word == "--tilt") {
      options.added_deg = number(next());
    } else if (word == "--width") {
      options.width = static_cast<int>(number(next()));
    } else if (options.file.empty() && !word.starts_with("-")) {
      options.file = word;
    } else {
      throw std::invalid_argument(std::string(word));
    }
  }
  if (options.file.empty()) throw std::invalid_argument("the end");
  return options;
}

/// UberSim's law: tilt, its rate, position and speed give the velocity of both wheels.
class Balance {
 public:
  Balance(double balanced_rad, double radius_m) : balanced_rad_(balanced_rad), radius_m_(radius_m) {}

  double velocity_radps(double tilt_rad, double added_rad) {
    const double rate = is_first_ ? 0 : (tilt_rad - tilt_rad_) / period_s;
    is_first_ = false;
    const double error = tilt_rad - balanced_rad_ - added_rad;
    tilt_rad_ = tilt_rad;
    x_m_ += v_mps_ * period_s;
    v_mps_ += 0.05 * (18 * error + 4.5 * rate + 0.4 * x_m_ + 1.0 * v_mps_);
    return v_mps_ / radius_m_;
  }
  double x_m() const { return x_m_; }

 private:
  double balanced_rad_, radius_m_;
  bool is_first_ = true;
  double tilt_rad_ = 0, x_m_ = 0, v_mps_ = 0;
};

/// Latest observations of the robot.
struct Seen {
  std::optional<double> tilt_rad;
  int images = 0, width = 0, height = 0;
};

double added_deg_at(const Options& options, double elapsed_s) {
  if (elapsed_s >= 2 && elapsed_s < 5) return options.added_deg;
  return elapsed_s >= 5 && elapsed_s < 8 ? -options.added_deg : 0;
}

int run(const Options& options, const ubersim::Robot& robot) {
  shoal::Client client(robot.name);
  client.join(period_s);
  Seen seen;
  std::vector<std::string> motors;
  for (const auto& [name, device] : client.spawn(robot.entry())) {  // the world waits
    if (device.type == "inclinometer")
      client.subscribe<shoal::inclination_t>(device.reports, [&](const auto& tilt) { seen.tilt_rad = tilt.pitch_rad; });
    if (device.type == "camera")
      client.subscribe<shoal::image_t>(device.reports, [&](const auto& image) {
        ++seen.images;
        seen.width = image.width;
        seen.height = image.height;
      });
    if (device.type == "joint_drive") motors.push_back(device.commands);
  }
  Balance balance(robot.tilt_rad, robot.radius_m);
  std::optional<std::int64_t> start;
  while (const auto now = client.next_tick()) {
    if (!start) start = now;
    const double elapsed_s = static_cast<double>(*now - *start) / 1e6;
    if (elapsed_s >= options.seconds) {
      client.leave();
      break;
    }
    if (!seen.tilt_rad) continue;
    shoal::joint_settings_t command{};
    command.utime = *now;
    command.axis = 1;
    const double added_rad = added_deg_at(options, elapsed_s) * (std::numbers::pi / 180);
    command.velocity = balance.velocity_radps(*seen.tilt_rad, added_rad);
    command.max_force = ubersim::max_torque_Nm;
    command.low_stop = command.high_stop = std::numeric_limits<double>::quiet_NaN();
    for (const std::string& motor : motors) client.publish(motor, command);
  }
  if (!seen.tilt_rad || seen.images == 0) {
    std::cerr << robot.name << ": the run was over before it had a report of an inclinometer and a camera\n";
    return 1;
  }
  const bool has_left = client.end() == shoal::Client::End::left;
  std::printf("%s: tilt %.2f deg, balanced at %.2f deg, %.2f m from its start, %d images of %dx%d, end: %s\n",
              robot.name.c_str(), *seen.tilt_rad * (180 / std::numbers::pi), robot.tilt_rad * (180 / std::numbers::pi),
              balance.x_m(), seen.images, seen.width, seen.height, has_left ? "left" : "not by itself");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  try {
    options = parse(std::vector<const char*>(argv + 1, argv + argc));
    ubersim::Robot robot = ubersim::read_robot(options.file, options.width);
    if (!options.name.empty()) robot.name = options.name;
    robot.position_m[0] += options.east_m;
    robot.position_m[1] += options.north_m;
    return run(options, robot);
  } catch (const std::invalid_argument& error) {
    std::cerr << usage << "at '" << error.what() << "'\n";
    return 2;
  } catch (const ubersim::Refused& error) {
    std::cerr << options.file << ": " << error.what() << '\n';
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "ubersim_client: " << error.what() << '\n';
    return 1;
  }
}
