// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/localizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

#include "sim/base/math.hpp"

namespace autonomy {

namespace {

/// Fewer points than this say too little about the place.
constexpr std::size_t min_points = 10;
/// Likelihood of what the map does not have.
constexpr double other_likelihood = 0.05;

/// Draws as many indices as wanted, each with the probability of its weight: by one random number (low variance
/// sampling, Thrun, Burgard and Fox 2005, table 4.4).  `sums`: of the weights up to each.
template <class Take>
void draw_evenly(const std::vector<double>& sums, std::size_t count, double random, Take take) {
  std::size_t index = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + random) / static_cast<double>(count) * sums.back();
    while (index + 1 < sums.size() && sums[index] < at) ++index;
    take(index);
  }
}

/// Number of particles for which the error of a distribution over `bins` bins is below 0.05 with probability 0.99 (Fox
/// 2003; Thrun, Burgard and Fox 2005, table 8.4).
double needed_particles(std::size_t bins) {
  constexpr double epsilon = 0.05, quantile_99 = 2.3263;
  if (bins < 2) return 0;
  const double k = static_cast<double>(bins) - 1, a = 2 / (9 * k), b = 1 - a + std::sqrt(a) * quantile_99;
  return k / (2 * epsilon) * b * b * b;
}

}  // namespace

LikelihoodField::LikelihoodField(const shoal::occupancy_grid_t& map) : frame_(frame_of(map)) {
  // Errors of lidar, map and pose; and ends where the map knows nothing.
  constexpr double fine_m = 0.1, wide_m = 0.3, unknown_likelihood = 0.2, beside_m = 0.3;
  std::vector<char> occupied(frame_.size());
  known_.resize(frame_.size());
  for (std::size_t i = 0; i < frame_.size(); ++i) {
    occupied[i] = map.cells[i] >= occupied_percent ? 1 : 0;
    known_[i] = occupied[i] != 0 ? 2 : map.cells[i] >= 0 && map.cells[i] <= free_percent ? 1 : 0;
  }
  const std::vector<float> distances = distances_m(frame_, occupied);
  for (const Width width : {Width::fine, Width::wide}) {
    const double std_m = width == Width::fine ? fine_m : wide_m;
    for (std::size_t i = 0; i < frame_.size(); ++i) {
      const double z = static_cast<double>(distances[i]) / std_m,
                   near = other_likelihood + (1 - other_likelihood) * std::exp(-0.5 * z * z);
      log_likelihood_[static_cast<std::size_t>(width)].push_back(
          static_cast<float>(std::log(known_[i] != 0 ? near : std::max(near, unknown_likelihood))));
    }
  }
  for (std::size_t i = 0; i < frame_.size(); ++i)
    if (known_[i] != 0 && static_cast<double>(distances[i]) > beside_m)
      places_.push_back(static_cast<std::uint32_t>(i));
  unknown_ = static_cast<float>(std::log(unknown_likelihood));
  if (places_.empty()) throw std::invalid_argument("the map has no free place");
}

float LikelihoodField::log_likelihood(Width width, const Vector2d& p_W) const {
  const int column = frame_.column_of(p_W.x()), row = frame_.row_of(p_W.y());
  if (!frame_.contains(column, row)) return unknown_;
  return log_likelihood_[static_cast<std::size_t>(width)][frame_.index(column, row)];
}

LikelihoodField::End LikelihoodField::end_of(const Vector2d& sensor_W, const Vector2d& end_W) const {
  constexpr double before_end_m = 0.3;
  const auto known_at = [&](const Vector2d& p_W) {
    const int column = frame_.column_of(p_W.x()), row = frame_.row_of(p_W.y());
    return frame_.contains(column, row) ? known_[frame_.index(column, row)] : 0;
  };
  // An end in a known cell can be judged by the likelihood field.
  if (known_at(end_W) != 0) return End::known;
  const Vector2d ray_W = end_W - sensor_W;
  const double length_m = ray_W.norm();
  // A beam that passes through a known wall contradicts the pose, except near its end, where the wall may be drawn
  // thick.
  for (double at_m = 0; at_m < length_m - before_end_m; at_m += frame_.cell_m)
    if (known_at(sensor_W + at_m / length_m * ray_W) == 2) return End::behind;
  return End::nowhere;
}

Localizer::Localizer(std::shared_ptr<const LikelihoodField> field, const Params& params)
    : field_(std::move(field)), params_(params), random_(params.seed, "localizer") {
  random_.begin_step(scans_);
  particles_.resize(static_cast<std::size_t>(params_.max_particles));
  for (Particle& each : particles_) {
    each.pose = any_pose();
    // Without a start the particles are spread over the whole free space (global localization).
    if (!params_.start) continue;
    each.pose = *params_.start;
    for (double* x : {&each.pose.p_W.x(), &each.pose.p_W.y()}) *x += params_.start_std_m * random_.gaussian();
    each.pose.yaw_rad += params_.start_std_rad * random_.gaussian();
  }
}

void Localizer::receive(const shoal::odometry_t& odometry) {
  check_reachable(odometry);
  odometry_ = odometry;
}

void Localizer::receive(const shoal::planar_lidar_t& scan) {
  scan_ = scan;
}

std::optional<shoal::estimate_t> Localizer::step() {
  if (!scan_ || !odometry_) return std::nullopt;
  random_.begin_step(++scans_);
  constexpr double max_gap_s = 2;
  const double dt_s = std::min(seconds(scan_->utime - utime_), max_gap_s);
  Increment by = moved_until(scan_->utime, *odometry_, odometer_);
  if (scans_ == 1) by = {};
  const bool is_slow = scans_ > 1 && std::hypot(by.forward_m, by.left_m) < params_.rest_mps * dt_s &&
                       std::abs(by.turn_rad) < params_.rest_radps * dt_s;
  // Slow motion is postponed, not lost.
  constexpr double postponed_m = 0.02, postponed_rad = 0.03;
  postponed_ = moved(postponed_, by);
  const bool rests =
      is_slow && postponed_.p_W.norm() < postponed_m && std::abs(sim::wrap_angle(postponed_.yaw_rad)) < postponed_rad;
  by = {};
  if (!rests) {
    by = {postponed_.p_W.x(), postponed_.p_W.y(), sim::wrap_angle(postponed_.yaw_rad)};
    postponed_ = {};
  }
  const Beams beams = beams_of(*scan_, params_.lidar);
  utime_ = scan_->utime;
  scan_.reset();
  points_B_.clear();
  const std::size_t every =
      std::max<std::size_t>(1, (beams.points_B.size() + params_.max_beams - 1) / params_.max_beams);
  for (std::size_t i = 0; i < beams.points_B.size(); i += every) points_B_.push_back(beams.points_B[i]);
  // Further scans of one place have the errors of the first: they would only make the filter overconfident.
  const std::optional<double> here = fit();
  if (scans_ == 1 && !params_.start)
    for (std::size_t i = 0; const Pose2& pose : poses_of_scan(particles_.size())) particles_[i++].pose = pose;
  if (!rests || (here && *here < params_.lost_below * slow_fit_)) {
    move(by);  // at rest it only spreads them
    if (points_B_.size() >= min_points) {
      weigh();
      estimate();
      judge();
      resample();
    } else {
      estimate();
    }
  }
  // That of the map, besides that of the particles.
  constexpr double map_std_m = 0.01;
  return planar_estimate(utime_, pose_, covariance_m2_ + squared(map_std_m) * Eigen::Matrix2d::Identity());
}

double Localizer::log_likelihood(const Pose2& pose, LikelihoodField::Width width, std::size_t every) const {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  double sum = 0;
  for (std::size_t i = 0; i < points_B_.size(); i += every) {
    const Vector2d& p = points_B_[i];
    const Vector2d end_W = pose.p_W + Vector2d(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    sum += static_cast<double>(field_->log_likelihood(width, end_W));
  }
  return sum;
}

std::optional<double> Localizer::fit() const {
  constexpr double enough_known = 1.0 / 3, nearly_all = 0.8;
  const Vector2d sensor_W = placed(pose_, params_.lidar.pose.p_W);
  double sum = 0, known = 0, behind = 0;
  for (const Vector2d& point_B : points_B_) {
    const Vector2d end_W = placed(pose_, point_B);
    const LikelihoodField::End end = field_->end_of(sensor_W, end_W);
    behind += end == LikelihoodField::End::behind ? 1 : 0;
    if (end != LikelihoodField::End::known) continue;
    sum += std::exp(static_cast<double>(field_->log_likelihood(LikelihoodField::Width::fine, end_W)));
    ++known;
  }
  const auto all = static_cast<double>(points_B_.size());
  if (behind > nearly_all * all) return other_likelihood;
  // Too few beams end in the known part of the map to judge the pose.
  if (points_B_.size() < min_points || known < enough_known * all) return std::nullopt;
  return sum / known;
}

double Localizer::share_lost() const {
  return slow_fit_ > 0 ? std::max(0.0, 1 - fast_fit_ / (params_.lost_below * slow_fit_)) : 0;
}

Pose2 Localizer::any_pose() {
  const std::vector<std::uint32_t>& places = field_->places();
  const auto cell = static_cast<int>(places[random_.integer_below(static_cast<std::uint32_t>(places.size()))]);
  const GridFrame& frame = field_->frame();
  const Vector2d p_W = frame.center_W(cell % frame.columns, cell / frame.columns);
  return {p_W, 2 * std::numbers::pi * random_.uniform()};
}

void Localizer::move(const Increment& by) {
  constexpr double min_m = 0.01, share_m = 0.05, min_rad = 0.01, share_rad = 0.05, rad_per_m = 0.02;
  const double distance_m = std::hypot(by.forward_m, by.left_m);
  const double std_m = min_m + share_m * distance_m,
               std_rad = min_rad + share_rad * std::abs(by.turn_rad) + rad_per_m * distance_m;
  for (Particle& each : particles_)
    each.pose =
        moved(each.pose, {by.forward_m + std_m * random_.gaussian(), by.left_m + 0.5 * std_m * random_.gaussian(),
                          by.turn_rad + std_rad * random_.gaussian()});
}

void Localizer::weigh() {
  double best = -1e300;
  for (Particle& each : particles_) {
    each.weight = params_.independent * log_likelihood(each.pose, LikelihoodField::Width::fine, 1);
    best = std::max(best, each.weight);
  }
  for (Particle& each : particles_) each.weight = std::exp(each.weight - best);
}

void Localizer::judge() {
  const std::optional<double> now = fit();
  if (!now) {
    fast_fit_ += params_.fast * (slow_fit_ - fast_fit_);
    return;
  }
  // The mean of the first ones, of which a bad one is none.
  const bool is_bad = judged_scans_ > 0 && *now < params_.lost_below * slow_fit_;
  const double first = is_bad ? 0 : 1 / static_cast<double>(++judged_scans_);
  slow_fit_ += std::max(params_.slow, first) * (*now - slow_fit_);
  fast_fit_ += std::max(params_.fast, first) * (*now - fast_fit_);
}

void Localizer::estimate() {
  // The mean of the particles near the best one; the covariance of all about it.
  constexpr double near_m = 1, near_rad = 0.5;
  const Pose2 best = std::max_element(particles_.begin(), particles_.end(), [](const Particle& a, const Particle& b) {
                       return a.weight < b.weight;
                     })->pose;
  Vector2d sum_W = Vector2d::Zero();
  double weights = 0, near_weights = 0, turns_rad = 0;
  for (const Particle& each : particles_) {
    weights += each.weight;
    const double turn_rad = sim::wrap_angle(each.pose.yaw_rad - best.yaw_rad);
    if ((each.pose.p_W - best.p_W).norm() > near_m || std::abs(turn_rad) > near_rad) continue;
    near_weights += each.weight;
    sum_W += each.weight * each.pose.p_W;
    turns_rad += each.weight * turn_rad;
  }
  pose_ = {sum_W / near_weights, sim::wrap_angle(best.yaw_rad + turns_rad / near_weights)};
  covariance_m2_.setZero();
  for (const Particle& each : particles_) {
    const Vector2d off = each.pose.p_W - pose_.p_W;
    covariance_m2_ += each.weight / weights * off * off.transpose();
  }
}

void Localizer::resample() {
  std::vector<double> sums(particles_.size());
  double sum = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sum += particles_[i].weight;
  // Until there are enough for the bins that they are in: 0.5 m, 15 degrees.
  constexpr double bin_m = 0.5, bin_rad = std::numbers::pi / 12;
  const auto max = static_cast<std::size_t>(params_.max_particles);
  std::set<std::array<int, 3>> bins;
  std::vector<Particle> drawn;
  const double share = share_lost();
  while (drawn.size() < max && (static_cast<int>(drawn.size()) < params_.min_particles ||
                                static_cast<double>(drawn.size()) < needed_particles(bins.size()))) {
    const auto found = std::lower_bound(sums.begin(), sums.end(), random_.uniform() * sum);
    const auto index = std::min<std::size_t>(static_cast<std::size_t>(found - sums.begin()), sums.size() - 1);
    const Pose2& pose = particles_[index].pose;
    bins.insert({static_cast<int>(std::floor(pose.p_W.x() / bin_m)), static_cast<int>(std::floor(pose.p_W.y() / bin_m)),
                 static_cast<int>(std::floor(sim::wrap_angle(pose.yaw_rad) / bin_rad))});
    drawn.push_back({pose});
  }
  // Particles from the whole map are added, up to the maximum number.
  if (share > 0) {
    const auto count = static_cast<std::size_t>(share * static_cast<double>(max));
    drawn.resize(std::min(drawn.size(), max - count));
    for (const Pose2& pose : poses_of_scan(count)) drawn.push_back({pose});
  }
  particles_ = std::move(drawn);
}

std::vector<Pose2> Localizer::poses_of_scan(std::size_t count) {
  // Some of the beams suffice to leave out many places, and the weight is flat: the next scans decide.
  constexpr std::size_t every = 4;
  constexpr double flat = 0.5, spread_m = 0.15, spread_rad = 0.06;
  std::vector<Pose2> tried(static_cast<std::size_t>(params_.tried_places));
  std::vector<double> sums(tried.size());
  double sum = 0;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    tried[i] = any_pose();
    sums[i] = sum += std::exp(flat * log_likelihood(tried[i], LikelihoodField::Width::wide, every));
  }
  std::vector<Pose2> poses;
  draw_evenly(sums, count, random_.uniform(), [&](std::size_t index) {
    const Increment by{spread_m * random_.gaussian(), spread_m * random_.gaussian(), spread_rad * random_.gaussian()};
    poses.push_back(moved(tried[index], by));
  });
  return poses;
}

}  // namespace autonomy
