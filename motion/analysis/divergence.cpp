// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/divergence.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "devices/motion/motion_player.hpp"
#include "experiment/score/support.hpp"
#include "motion/analysis/motion_tracking.hpp"
#include "motion/analysis/perturbed_world.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/ode/physics_fault.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/standalone_world.hpp"

namespace motion {

namespace {

constexpr double longest_approach_s = 60;

/// One model of the vehicle, in its own world, and its course.
class ComparedModel {
 public:
  ComparedModel(sim::WorldConfig config, const std::string& vehicle, const sim::JointMotion& motion)
      : config_(with_motion(std::move(config), vehicle, motion)),
        world_(config_),
        vehicle_(*world_.find_vehicle(vehicle)),
        player_(player_of(vehicle_)) {
    world_.physics().watch_contacts(vehicle_.group());
  }

  /// Runs the approach, then the motion.
  void run(const DivergenceOptions& options) {
    while (player_.phase() == devices::MotionPlayer::Phase::approach && now_s() < longest_approach_s) world_.step();
    start_s_ = now_s();
    const auto rows = static_cast<std::size_t>(std::lround(options.duration_s / options.row_s)) + 1;
    while (course_W_.size() < rows) {
      if (since_start_s() >= static_cast<double>(course_W_.size()) * options.row_s - 1e-9)
        course_W_.emplace_back(vehicle_.X_WV().translation());
      else if (!step())
        course_W_.resize(rows, course_W_.back());  // it diverged: it stays where it was
    }
  }

  const std::vector<sim::Vector3d>& course_W() const { return course_W_; }
  double fell_s() const { return fell_s_; }
  double least_static_margin_m() const { return least_static_margin_m_; }

 private:
  static sim::WorldConfig with_motion(sim::WorldConfig config, const std::string& vehicle,
                                      const sim::JointMotion& motion) {
    set_played_motion(config, vehicle, motion);
    return config;
  }
  static const devices::MotionPlayer& player_of(const sim::Vehicle& vehicle) {
    for (const sim::MountedDevice* device : vehicle.devices())
      if (const auto* player = dynamic_cast<const devices::MotionPlayer*>(device->sensor())) return *player;
    throw std::logic_error("only vehicles with a motion_player can be compared");
  }

  double now_s() const { return sim::to_seconds(world_.now()); }
  double since_start_s() const { return now_s() - start_s_; }

  /// Returns false when the physics has failed.
  bool step() {
    try {
      world_.step();
    } catch (const sim::PhysicsFault&) {
      if (fell_s_ < 0) fell_s_ = since_start_s();
      return false;
    }
    if (fell_s_ >= 0) return true;
    if (tilt_rad(vehicle_) > fallen_rad || first_body_touches(world_, vehicle_)) fell_s_ = since_start_s();
    if (const auto support = experiment::support_of(world_, vehicle_))
      least_static_margin_m_ = std::fmin(least_static_margin_m_, support->static_margin_m);
    return true;
  }

  sim::WorldConfig config_;  // to which the world refers
  sim::StandaloneWorld world_;
  const sim::Vehicle& vehicle_;
  const devices::MotionPlayer& player_;
  double start_s_ = 0;
  double fell_s_ = -1;
  double least_static_margin_m_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<sim::Vector3d> course_W_;
};

struct NamedPerturbation {
  std::string name;
  Perturbation perturbation;
};

std::vector<NamedPerturbation> perturbations_of(double friction, const DivergenceOptions& options) {
  std::vector<NamedPerturbation> all(5);
  all[0].name = fmt::format("mass +{:.0f} %", 100 * options.mass);
  all[0].perturbation.mass = 1 + options.mass;
  all[1].name = fmt::format("mass -{:.0f} %", 100 * options.mass);
  all[1].perturbation.mass = 1 - options.mass;
  all[2].name = fmt::format("effort -{:.0f} %", 100 * options.effort);
  all[2].perturbation.effort = 1 - options.effort;
  all[3].name = fmt::format("friction +{:g}", options.friction);
  all[3].perturbation.friction = friction + options.friction;
  all[4].name = fmt::format("friction -{:g}", options.friction);
  all[4].perturbation.friction = std::max(0.0, friction - options.friction);
  return all;
}

}  // namespace

double Divergence::greatest_m(std::size_t row) const {
  double greatest = 0;
  for (const DivergenceCurve& curve : curves) greatest = std::max(greatest, curve.distance_m[row]);
  return greatest;
}

double Divergence::median_m(std::size_t row) const {
  std::vector<double> distances;
  for (const DivergenceCurve& curve : curves) distances.push_back(curve.distance_m[row]);
  std::nth_element(distances.begin(), distances.begin() + 2, distances.end());
  return distances[2];
}

double Divergence::greatest_until_m(std::size_t row) const {
  double greatest = 0;
  for (std::size_t i = 0; i <= row; ++i) greatest = std::max(greatest, greatest_m(i));
  return greatest;
}

Divergence divergence_of(const sim::WorldConfig& world, const std::string& vehicle, const sim::JointMotion& motion,
                         const DivergenceOptions& options) {
  const sim::WorldConfig reduced = world_for_walks(world);
  const std::vector<NamedPerturbation> perturbations = perturbations_of(friction_of(world, vehicle), options);
  // Worlds are made one after the other, and run by the threads.
  std::vector<std::unique_ptr<ComparedModel>> models;
  models.push_back(std::make_unique<ComparedModel>(reduced, vehicle, motion));
  for (const NamedPerturbation& one : perturbations)
    models.push_back(std::make_unique<ComparedModel>(perturbed(reduced, vehicle, one.perturbation), vehicle, motion));
  sim::ThreadPool(options.threads).for_each(models.size(), [&](std::size_t i) { models[i]->run(options); });
  Divergence divergence;
  divergence.row_s = options.row_s;
  divergence.fell_s = models.front()->fell_s();
  divergence.least_static_margin_m = models.front()->least_static_margin_m();
  const std::vector<sim::Vector3d>& reference_W = models.front()->course_W();
  for (std::size_t m = 0; m < perturbations.size(); ++m) {
    DivergenceCurve& curve = divergence.curves.emplace_back();
    curve.model = perturbations[m].name;
    curve.fell_s = models[m + 1]->fell_s();
    for (std::size_t i = 0; i < reference_W.size(); ++i)
      curve.distance_m.push_back((models[m + 1]->course_W()[i] - reference_W[i]).norm());
  }
  return divergence;
}

}  // namespace motion
