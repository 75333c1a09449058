// SPDX-License-Identifier: BSD-3-Clause
// How well the push margin predicts falls of the robot dog ers7: random motions, margins of each at two instants, and
// other pushes between them.
//   push_prediction_bench [MOTIONS [SEED [THREADS]]]
// TRIALS=1 in the environment: prints each push too.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include "messages/yaml/message_writer.hpp"
#include "sim/world_file/vehicle_loader.hpp"
#include "tests/project_paths.hpp"
#include "verification/motions/push_prediction.hpp"

namespace {

/// The poses of the shipped motions, each name once.
std::vector<sim::MotionPose> shipped_poses() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(test_support::source_path("vehicles/motions/ers7")))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<sim::MotionPose> poses;
  for (const std::filesystem::path& file : files)
    for (const sim::MotionPose& pose : sim::load_motion(file.string()).poses)
      if (std::none_of(poses.begin(), poses.end(), [&](const auto& one) { return one.name == pose.name; }))
        poses.push_back(pose);
  return poses;
}

void print(const std::string& name, const verification::Detection& detection) {
  std::cout << fmt::format("{:<34} {:>7} {:>7} {:>7} {:>7} {:>8.3f} {:>10.3f}\n", name, detection.found,
                           detection.missed, detection.false_alarms, detection.right_passes, detection.recall(),
                           detection.precision());
}

}  // namespace

int main(int argc, char** argv) {
  verification::PredictionOptions options;
  // Standing it withstands 3.7 m/s.
  options.push.greatest_mps = 4;
  options.push.resolution_mps = 1.0 / 16;
  if (argc > 1) options.motions = std::atoi(argv[1]);
  if (argc > 2) options.seed = std::strtoull(argv[2], nullptr, 10);
  if (argc > 3) options.push.threads = std::atoi(argv[3]);
  motion::StageOptions stage;
  stage.world = test_support::source_path("worlds/ers7_studio.yaml");
  const sim::VehicleConfig vehicle = sim::load_vehicle(test_support::source_path("vehicles/ers7.yaml"), {});
  const verification::PushTrials result = verification::push_trials(stage, vehicle, shipped_poses(), options);
  std::cout << fmt::format("{} motions of seed {}, {} refused that fall by themselves; {} pushes up to {} m/s\n",
                           options.motions, options.seed, result.refused_motions, result.trials.size(),
                           options.push.greatest_mps);
  std::cout << fmt::format("{:<34} {:>7} {:>7} {:>7} {:>7} {:>8} {:>10}\n", "falls predicted by", "found", "missed",
                           "false", "passes", "recall", "precision");
  print("push margin", verification::detection_by_margin(result.trials));
  print("static check, best threshold", verification::detection_by_static_check(result.trials, false));
  print("static check x push, the same", verification::detection_by_static_check(result.trials, true));
  if (std::getenv("TRIALS") != nullptr)
    for (const verification::PushTrial& t : result.trials)
      std::cout << fmt::format("{} {:.4f} {:.4f} {:.4f} {} {:.4f} {:.4f}\n", t.motion, t.push.at_s,
                               t.push.direction_rad, t.push.mps, t.fell ? 1 : 0, t.withstood_mps,
                               t.static_displacement_m);
  return 0;
}
