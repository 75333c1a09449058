// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <numbers>

#include "devices/motion/servo_bank.hpp"
#include "experiment/files/gnuplot.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "experiment/world_files/world_by_name.hpp"
#include "motion/analysis/motion_difference.hpp"
#include "motion/analysis/motion_file.hpp"
#include "sim/config/message_text.hpp"
#include "sim/motion/motion_frames.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tools/shoal/motion/format_options.hpp"
#include "tools/shoal/motion/motion_commands.hpp"
#include "tools/shoal/options/shared_options.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

constexpr double deg_per_rad = 180 / std::numbers::pi;
constexpr double mm_per_m = 1000;
constexpr std::size_t max_plots = 40;

struct CompareArguments {
  std::string first, second, png;
  double tolerance_deg = 0;
  motion::StageOptions stage;
};

/// Names of the joints of a motion by name and alias, from the file of its vehicle, if there is one.
std::function<std::string(const std::string&)> names_of(const sim::JointMotion& motion, const std::string& file) {
  const std::string vehicle = vehicle_file_of(motion.vehicle, file);
  if (vehicle.empty()) return [](const std::string& joint) { return joint; };
  const auto config = std::make_shared<sim::VehicleConfig>(sim::load_vehicle(vehicle, {}));
  return [config](const std::string& joint) {
    for (const devices::ServoOfVehicle& servo : devices::servos_of(*config))
      if (servo.is_called(joint)) return servo.device;
    return joint;
  };
}

std::string list(const std::vector<std::string>& joints) {
  std::string text;
  for (const std::string& joint : joints) text += " " + sim::printable(joint);
  return text;
}

/// Four decimals; of smaller values two digits.
std::string number(double value) {
  return value == 0 ? "0" : value < 0.001 ? fmt::format("{:.2g}", value) : fmt::format("{:.4f}", value);
}

void print_joints(const motion::MotionDifference& difference) {
  std::cout << fmt::format("{:<24} {:>10} {:>9} {:>10} {:>10}\n", "joint", "max deg", "at s", "rms deg", "first s");
  int equal = 0;
  for (const motion::JointDifference& joint : difference.joints) {
    // Equal joints are only counted.
    if (joint.max == 0) {
      ++equal;
      continue;
    }
    std::cout << fmt::format("{:<24} {:>10} {:>9.3f} {:>10} {:>10}\n", sim::printable(joint.joint),
                             number(joint.max * deg_per_rad), joint.max_at_s, number(joint.rms * deg_per_rad),
                             joint.first_at_s ? fmt::format("{:.3f}", *joint.first_at_s) : "-");
  }
  if (equal > 0) std::cout << fmt::format("{} joint{}: 0\n", equal, equal == 1 ? "" : "s");
  if (!difference.only_first.empty()) std::cout << "only in the first:" << list(difference.only_first) << '\n';
  if (!difference.only_second.empty()) std::cout << "only in the second:" << list(difference.only_second) << '\n';
  std::cout << fmt::format("{:.3f} s and {:.3f} s; greatest difference {} deg\n", difference.first_end_s,
                           difference.second_end_s, number(difference.max() * deg_per_rad));
}

/// Draws the joints that differ, both motions in one plot each.
void draw(const std::string& png, const sim::JointMotion& first, const sim::JointMotion& second,
          const motion::MotionDifference& difference, const std::function<std::string(const std::string&)>& name_of) {
  const experiment::ScratchDirectory scratch;
  std::vector<std::string> drawn;
  for (const motion::JointDifference& joint : difference.joints)
    if (joint.max > 0 && drawn.size() < max_plots) drawn.push_back(joint.joint);
  if (drawn.empty()) {
    std::cerr << png << ": not written, because no joint differs\n";
    return;
  }
  std::string script = fmt::format(
      "set terminal pngcairo size 900,{}\nset output {}\nset datafile separator ','\nset multiplot layout {},1\n"
      "set xlabel 's'\nset key outside\n",
      60 + 220 * drawn.size(), experiment::gnuplot_text(fs::absolute(png).string()), drawn.size());
  const double end_s = std::max(difference.first_end_s, difference.second_end_s);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    script += fmt::format("set ylabel {} noenhanced\nplot ", experiment::gnuplot_text(drawn[i] + ", deg"));
    for (const auto* motion : {&first, &second}) {
      const bool is_first = motion == &first;
      const std::string file = fmt::format("{}_{}.csv", is_first ? "first" : "second", i);
      std::ofstream out(scratch.path / file);
      for (const sim::MotionTrack& track : motion->tracks())
        if (name_of(track.joint) == drawn[i]) {
          const std::vector<sim::MotionTrack> frames = sim::sampled({track}, end_s, first.frame_s);
          for (const sim::TrackKey& key : frames.front().keys)
            out << key.at_s << ',' << key.value * deg_per_rad << '\n';
        }
      script += fmt::format("{}{} with lines title '{}'", is_first ? "" : ", ", experiment::gnuplot_text(file),
                            is_first ? "first" : "second");
    }
    script += "\n";
  }
  std::ofstream(scratch.path / "plot.gp") << script << "unset multiplot\n";
  if (experiment::run_gnuplot(scratch.path.string(), "plot.gp", std::chrono::seconds(60), [] { return false; })) return;
  std::ifstream reported(scratch.path / "plot.log");
  throw std::runtime_error("gnuplot failed: " + std::string(std::istreambuf_iterator<char>(reported), {}));
}

int compare(CompareArguments arguments) {
  const sim::JointMotion first = motion_of(arguments.first);
  if (!arguments.png.empty()) check_writable(arguments.png);
  try {
    const sim::JointMotion second =
        arguments.second.empty() ? motion::MotionHistory(arguments.first).previous() : motion_of(arguments.second);
    const auto name_of = names_of(first, arguments.first);
    const double tolerance = arguments.tolerance_deg / deg_per_rad;
    const motion::MotionDifference difference = motion::difference_of(first, second, tolerance, name_of);
    print_joints(difference);
    if (!arguments.stage.world.empty()) {
      arguments.stage.world = experiment::file_by_name({experiment::ShippedKind::world}, arguments.stage.world);
      const motion::CourseDifference body =
          motion::difference_of(motion::course_of(arguments.stage, first), motion::course_of(arguments.stage, second));
      std::cout << fmt::format(
          "vehicle: greatest distance {:.2f} mm at {:.3f} s, rms {:.2f} mm, {:.2f} mm at the end at {:.3f} s\n",
          body.max_m * mm_per_m, body.max_at_s, body.rms_m * mm_per_m, body.end_m * mm_per_m, body.end_at_s);
    }
    if (!arguments.png.empty()) draw(arguments.png, first, second, difference, name_of);
    // Ends are sums of frames, so they may differ by rounding.
    const bool is_equal = difference.max() <= tolerance && difference.only_first.empty() &&
                          difference.only_second.empty() &&
                          std::abs(difference.first_end_s - difference.second_end_s) <= 1e-9;
    if (!is_equal)
      std::cout << "they differ\n";
    else if (arguments.tolerance_deg > 0)
      std::cout << "equal within " << sim::number_text(arguments.tolerance_deg) << " deg\n";
    else
      std::cout << "equal\n";
    return is_equal ? exit_ok : exit_failed;
  } catch (const sim::ConfigError&) {
    throw;
  } catch (const std::runtime_error& error) {
    std::cerr << "shoal: " << error.what() << '\n';
    return exit_bus;
  }
}

}  // namespace

void add_motion_compare_command(CLI::App& motion, int& exit_code) {
  CLI::App* command =
      motion.add_subcommand("compare", "Compare two motions joint by joint, and the paths they produce");
  const auto arguments = std::make_shared<CompareArguments>();
  add_log_level_option(*command, "warn");
  command->add_option("FILE", arguments->first, "motion file")->required();
  command->add_option("OTHER", arguments->second, "other motion file; unset: FILE before its last edit or recording");
  command->add_option("--tolerance", arguments->tolerance_deg, "tolerated difference, degrees; default 0")
      ->type_name("DEG")
      ->check(number_from(0, 360));
  command
      ->add_option("--world", arguments->stage.world, "play both in this world, and compare the paths of the vehicle")
      ->type_name("WORLD");
  command
      ->add_option("--vehicle", arguments->stage.vehicle,
                   "name of the vehicle; required if several have a motion_player")
      ->type_name("NAME");
  command->add_option("--png", arguments->png, "plot of the joints that differ, by gnuplot")->type_name("FILE");
  add_set_option(*command, arguments->stage.load.sets);
  add_allow_path_option(*command, arguments->stage.load);
  command_line::set_help_end(*command,
                             {{"shoal motion compare wave.yaml wave_take.yaml --tolerance 0.25",
                               "shoal motion compare wave.yaml --world ers7_studio --png wave.png"},
                              {{0, "equal within the tolerance, of equal length, with the same joints"},
                               {1, "they differ"},
                               {2, "wrong usage, or mistakes in a file"},
                               {4, "there is no earlier version, or the plot cannot be written"}},
                              {"The frames of the first motion are compared, up to the end of the longer one."}});
  command->callback([arguments, &exit_code] { exit_code = compare(*arguments); });
}

}  // namespace tools
