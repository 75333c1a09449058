// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/team_bound.hpp"

#include <algorithm>
#include <cmath>

namespace experiment {

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::Vector2d;

/// Smallest standard deviation of a fix or relative position, squared: 1 mm, so that the innovation is never singular.
constexpr double min_variance_m2 = 1e-6;
/// A vehicle that moves faster was placed elsewhere: it has not traveled the distance.
constexpr double max_speed_mps = 200;

Vector2d left_of(const Vector2d& v) {
  return {-v.y(), v.x()};
}

Matrix2d rotation2(double angle_rad) {
  Matrix2d R;
  R << std::cos(angle_rad), -std::sin(angle_rad), std::sin(angle_rad), std::cos(angle_rad);
  return R;
}

double square_of(double value) {
  return value * value;
}

TeamBound::Pose between(const TeamBound::Pose& from, const TeamBound::Pose& to, double share) {
  return {from.p_W + share * (to.p_W - from.p_W), from.yaw_rad + share * sim::wrap_angle(to.yaw_rad - from.yaw_rad)};
}

}  // namespace

TeamBound::TeamBound(std::vector<VehicleErrors> team, int scored, const Options& options)
    : team_(std::move(team)), scored_(scored), options_(options), fixed_at_(team_.size(), sim::Time{0}) {
  // One joint state of the team: sharing measurements correlates the errors of its members.
  std::vector<double> variances;
  for (const VehicleErrors& errors : team_)
    layouts_.push_back(make_layout(errors, static_cast<int>(variances.size()), variances));
  if (options_.sound_speed_std > 0) {
    sound_speed_index_ = static_cast<int>(variances.size());
    variances.push_back(square_of(options_.sound_speed_std));
  }
  base_size_ = static_cast<Eigen::Index>(variances.size());
  covariance_ = ErrorCovariance(Eigen::Map<Eigen::VectorXd>(variances.data(), base_size_).asDiagonal());
}

TeamBound::Layout TeamBound::make_layout(const VehicleErrors& errors, int first, std::vector<double>& variances) const {
  Layout layout;
  layout.first = first;
  const auto add = [&](double std) {
    variances.push_back(square_of(std));
    return layout.count++;
  };
  const auto add_if = [&](double std, Known known) { return std > 0 && !knows(known) ? add(std) : -1; };
  const auto add_slow = [&](const QuantityErrors& quantity, int axis, Known constant, Known drift,
                            std::vector<SlowState>& states) {
    for (const SlowError& slow : quantity.slow)
      if (!knows(slow.walk_std == 0 && slow.time_s == 0 ? constant : drift))
        states.push_back({add(slow.initial_std), axis, slow});
  };
  add(options_.start_std_m);
  add(options_.start_std_m);
  const bool wheels = errors.motion == VehicleErrors::Motion::wheels;
  if (wheels) layout.heading = add(options_.start_heading_std_rad);
  if (errors.motion != VehicleErrors::Motion::unknown)
    layout.scale = add_if(errors.speed_scale_std, Known::speed_scale);
  if (wheels) layout.turn_scale = add_if(errors.turn_scale_std, Known::speed_scale);
  if (errors.motion == VehicleErrors::Motion::measured_velocity) {
    add_slow(errors.heading, 0, Known::heading_bias, Known::heading_drift, layout.headings);
    for (const int axis : {0, 1})
      add_slow(errors.velocity, axis, Known::velocity_drift, Known::velocity_drift, layout.velocities);
  }
  for (const int axis : {0, 1})
    if (errors.gps) add_slow(errors.gps->position, axis, Known::gps_drift, Known::gps_drift, layout.fixes);
  const bool drifts = errors.clock_drift_std > 0 || errors.clock_random_walk_fm > 0;
  const bool errs = errors.clock_offset_std_s > 0 || errors.clock_white_fm > 0 || drifts;
  // The remaining error of a disciplined clock is white and counts as noise of its stamps.
  if (errs && !errors.disciplined() && !knows(Known::clock)) {
    layout.clock = add(errors.clock_offset_std_s);
    if (drifts) layout.frequency = add(errors.clock_drift_std);
  }
  return layout;
}

void TeamBound::move(sim::Time at, std::vector<Pose> poses, bool scores) {
  if (motions_.empty()) {
    now_ = at;
    std::fill(fixed_at_.begin(), fixed_at_.end(), at);
  } else if (at <= motions_.back().at) {
    return;
  }
  motions_.push_back({at, std::move(poses), scores});
}

void TeamBound::add_event(sim::Time at, Event event) {
  events_.emplace(std::pair(at.count(), next_event_++), std::move(event));
}

void TeamBound::add_fix(sim::Time at, int vehicle) {
  if (is_late(at) || !errors(vehicle).gps) return;
  Event event;
  event.what = What::fix;
  event.site = {vehicle, errors(vehicle).gps->antenna_V};
  add_event(at, event);
}

void TeamBound::add_range(sim::Time sent, const Site& sender, sim::Time arrived, const Site& receiver, sim::Time known,
                          double more_variance_m2) {
  if (is_late(sent) || arrived <= sent || known < arrived) return;
  const auto point_W = [&](const Site& site, sim::Time at) -> sim::Vector3d {
    const Pose pose = pose_at(site.vehicle, at);
    const Vector2d lever_W = rotation2(pose.yaw_rad) * site.at_V.head<2>();
    return pose.p_W + sim::Vector3d(lever_W.x(), lever_W.y(), site.at_V.z());
  };
  const sim::Vector3d d = point_W(receiver, arrived) - point_W(sender, sent);
  Event event;
  event.packet = next_packet_++;
  event.range_m = d.norm();
  if (!(event.range_m > 0)) return;
  event.toward = d.head<2>() / event.range_m;
  event.sound_speed_mps = event.range_m / sim::to_seconds(arrived - sent);
  const double stamps_s2 =
      square_of(errors(sender.vehicle).stamp_std_s()) + square_of(errors(receiver.vehicle).stamp_std_s());
  event.variance_m2 = square_of(event.sound_speed_mps) * stamps_s2 + more_variance_m2;
  // The sound leaves, arrives and is known at different times: the errors of both vehicles enter when it leaves and
  // arrives, but only the last event adds information.
  event.what = What::sending;
  event.site = sender;
  add_event(sent, event);
  event.what = What::arrival;
  event.site = receiver;
  add_event(arrived, event);
  event.what = What::range;
  add_event(known, event);
}

void TeamBound::add_sighting(sim::Time at, int observer, int other) {
  if (is_late(at) || !errors(observer).sightings) return;
  Event event;
  event.what = What::sighting;
  event.site = {observer, errors(observer).sightings->sensor.at_V};
  event.other = other;
  add_event(at, event);
}

void TeamBound::add_usbl(sim::Time at, int observer, int other) {
  if (is_late(at) || !errors(observer).usbl) return;
  Event event;
  event.what = What::usbl;
  event.site = {observer, errors(observer).usbl->sensor.at_V};
  event.other = other;
  add_event(at, event);
}

TeamBound::Pose TeamBound::pose_at(int vehicle, sim::Time at) const {
  const auto v = static_cast<std::size_t>(vehicle);
  const auto after = std::lower_bound(motions_.begin(), motions_.end(), at,
                                      [](const Motion& motion, sim::Time time) { return motion.at < time; });
  if (after == motions_.end()) return motions_.back().poses[v];
  if (after == motions_.begin()) return after->poses[v];
  const Motion& before = *std::prev(after);
  const double share = sim::to_seconds(at - before.at) / sim::to_seconds(after->at - before.at);
  return between(before.poses[v], after->poses[v], share);
}

void TeamBound::advance(sim::Time until) {
  while (motions_.size() > 1 && motions_[1].at <= until) {
    const sim::Time end = motions_[1].at;
    while (!events_.empty() && events_.begin()->first.first <= end.count()) {
      const sim::Time at{events_.begin()->first.first};
      predict(at);
      handle(events_.begin()->second, at);
      events_.erase(events_.begin());
    }
    predict(end);
    motions_.pop_front();
    if (!motions_.front().scores || sim::to_seconds(end) < options_.from_s) continue;
    const Eigen::Index p = layouts_[static_cast<std::size_t>(scored_)].first;
    const MatrixXd& P = covariance_.matrix();
    result_.last_m2 = P(p, p) + P(p + 1, p + 1);
    result_.max_m2 = std::max(result_.max_m2, result_.last_m2);
    result_.sum_m2 += result_.last_m2;
    ++result_.samples;
  }
}

TeamBound::Result TeamBound::result() const {
  TeamBound copy = *this;
  if (!motions_.empty()) copy.advance(motions_.back().at);
  return copy.result_;
}

void TeamBound::predict(sim::Time until) {
  const double dt_s = sim::to_seconds(until - now_);
  if (dt_s <= 0) return;
  for (int vehicle = 0; vehicle < size(); ++vehicle)
    predict_vehicle(vehicle, pose_at(vehicle, now_), pose_at(vehicle, until), dt_s, until);
  now_ = until;
}

void TeamBound::predict_vehicle(int vehicle, const Pose& from, const Pose& to, double dt_s, sim::Time until) {
  const Layout& layout = layouts_[static_cast<std::size_t>(vehicle)];
  const VehicleErrors& own = errors(vehicle);
  MatrixXd F = MatrixXd::Identity(layout.count, layout.count);
  MatrixXd Q = MatrixXd::Zero(layout.count, layout.count);
  Vector2d moved = (to.p_W - from.p_W).head<2>();
  if (moved.norm() > max_speed_mps * dt_s) moved.setZero();
  const double turned_rad = sim::wrap_angle(to.yaw_rad - from.yaw_rad);
  // Errors of the motion.
  const auto effect = [&](int index, const Vector2d& change) {
    if (index >= 0) F.col(index).head<2>() += change;
  };
  effect(layout.scale, moved);
  switch (own.motion) {
    case VehicleErrors::Motion::unknown: {
      // The speed of the last fix: its error grows with the time since then.
      const double before_s = sim::to_seconds(now_ - fixed_at_[static_cast<std::size_t>(vehicle)]);
      const double after_s = sim::to_seconds(until - fixed_at_[static_cast<std::size_t>(vehicle)]);
      const double std_mps = own.gps ? own.gps->velocity_std_mps : 0;
      Q.topLeftCorner<2, 2>().diagonal().array() += square_of(std_mps) * (square_of(after_s) - square_of(before_s));
      break;
    }
    case VehicleErrors::Motion::measured_velocity: {
      for (const SlowState& state : layout.headings) effect(state.index, left_of(moved));
      const Matrix2d R = rotation2(from.yaw_rad + 0.5 * turned_rad + own.sensor_yaw_rad);
      for (const SlowState& state : layout.velocities) effect(state.index, dt_s * R.col(state.axis));
      // White errors of the samples in this time.
      const double velocity_mps =
          std::hypot(own.velocity.white_std, own.beam_std_mps + own.beam_std_per_mps * moved.norm() / dt_s);
      Q.topLeftCorner<2, 2>().diagonal().array() += square_of(velocity_mps) * own.velocity_period_s * dt_s;
      Q.topLeftCorner<2, 2>() +=
          square_of(own.heading.white_std) * own.heading_period_s / dt_s * left_of(moved) * left_of(moved).transpose();
      break;
    }
    case VehicleErrors::Motion::wheels: {
      effect(layout.heading, left_of(moved));
      if (layout.turn_scale >= 0) F(layout.heading, layout.turn_scale) += turned_rad;
      const Vector2d along = rotation2(from.yaw_rad + 0.5 * turned_rad).col(0);
      Q.topLeftCorner<2, 2>() += square_of(own.along_noise_mprts) * dt_s * along * along.transpose();
      Q(layout.heading, layout.heading) += square_of(own.turn_noise_radprts) * dt_s;
      break;
    }
  }
  // Slow errors.
  for (const auto* states : {&layout.headings, &layout.velocities, &layout.fixes})
    for (const SlowState& state : *states) {
      Q(state.index, state.index) += square_of(state.error.walk_std) * dt_s;
      if (state.error.time_s <= 0) continue;
      F(state.index, state.index) = std::exp(-dt_s / state.error.time_s);
      Q(state.index, state.index) -= square_of(state.error.initial_std) * std::expm1(-2 * dt_s / state.error.time_s);
    }
  // The clock; the walk of the frequency and its integral have the covariance q^2 [dt^3/3, dt^2/2; dt^2/2, dt].
  if (layout.clock >= 0) Q(layout.clock, layout.clock) += square_of(own.clock_white_fm) * dt_s;
  if (layout.frequency >= 0) {
    F(layout.clock, layout.frequency) = dt_s;
    const double q2 = square_of(own.clock_random_walk_fm);
    Q(layout.clock, layout.clock) += q2 * dt_s * dt_s * dt_s / 3;
    Q(layout.clock, layout.frequency) += q2 * dt_s * dt_s / 2;
    Q(layout.frequency, layout.clock) += q2 * dt_s * dt_s / 2;
    Q(layout.frequency, layout.frequency) += q2 * dt_s;
  }
  covariance_.predict(layout.first, F, Q);
}

RowVectorXd TeamBound::point_row(const Site& site, sim::Time at, const Vector2d& direction) const {
  const Layout& layout = layouts_[static_cast<std::size_t>(site.vehicle)];
  RowVectorXd row = RowVectorXd::Zero(covariance_.size());
  row.segment<2>(layout.first) = direction.transpose();
  // An error of the heading turns the lever arm.
  const Vector2d lever_W = rotation2(pose_at(site.vehicle, at).yaw_rad) * site.at_V.head<2>();
  const double turn_m = direction.dot(left_of(lever_W));
  if (layout.heading >= 0) row[layout.first + layout.heading] += turn_m;
  for (const SlowState& state : layout.headings) row[layout.first + state.index] += turn_m;
  return row;
}

RowVectorXd TeamBound::clock_row(int vehicle, double sound_speed_mps) const {
  const Layout& layout = layouts_[static_cast<std::size_t>(vehicle)];
  RowVectorXd row = RowVectorXd::Zero(covariance_.size());
  if (layout.clock >= 0) row[layout.first + layout.clock] = sound_speed_mps;
  return row;
}

Eigen::Index TeamBound::pending_index(std::int64_t packet) const {
  const auto found = std::find(pending_.begin(), pending_.end(), packet);
  return found == pending_.end() ? -1 : base_size_ + (found - pending_.begin());
}

void TeamBound::handle(const Event& event, sim::Time at) {
  switch (event.what) {
    case What::fix:
      use_fix(event, at);
      return;
    case What::sighting:
    case What::usbl:
      use_sighting(event, at);
      return;
    case What::sending:
      // The error at the time of sending becomes its own state, which keeps its correlations until the range is
      // used.
      covariance_.append(-point_row(event.site, at, event.toward) -
                         clock_row(event.site.vehicle, event.sound_speed_mps));
      pending_.push_back(event.packet);
      return;
    case What::arrival: {
      const Eigen::Index index = pending_index(event.packet);
      if (index < 0) return;
      // Now the state is the whole error of the range: that of the arrival less that of the sending.
      RowVectorXd row = point_row(event.site, at, event.toward) + clock_row(event.site.vehicle, event.sound_speed_mps);
      if (sound_speed_index_ >= 0) row[sound_speed_index_] = event.range_m;
      covariance_.add(index, row);
      return;
    }
    case What::range: {
      const Eigen::Index index = pending_index(event.packet);
      if (index < 0) return;
      RowVectorXd row = RowVectorXd::Zero(covariance_.size());
      row[index] = 1;
      covariance_.update(row, MatrixXd::Constant(1, 1, event.variance_m2));
      covariance_.remove(index, 1);
      pending_.erase(pending_.begin() + (index - base_size_));
      ++result_.ranges;
      return;
    }
  }
}

void TeamBound::use_fix(const Event& event, sim::Time at) {
  const Layout& layout = layouts_[static_cast<std::size_t>(event.site.vehicle)];
  const VehicleErrors::Gps& gps = *errors(event.site.vehicle).gps;
  const double variance_m2 = std::max(square_of(gps.position.white_std), min_variance_m2);
  ++result_.fixes;
  if (errors(event.site.vehicle).motion == VehicleErrors::Motion::unknown) {
    // The fix is all that is known: its errors become those of the position.
    MatrixXd F = MatrixXd::Identity(layout.count, layout.count);
    F.topLeftCorner<2, 2>().setZero();
    for (const SlowState& state : layout.fixes) F(state.axis, state.index) = -1;
    MatrixXd Q = MatrixXd::Zero(layout.count, layout.count);
    Q.topLeftCorner<2, 2>().diagonal().setConstant(variance_m2);
    covariance_.predict(layout.first, F, Q);
    fixed_at_[static_cast<std::size_t>(event.site.vehicle)] = at;
    return;
  }
  MatrixXd H(2, covariance_.size());
  H.row(0) = point_row(event.site, at, Vector2d::UnitX());
  H.row(1) = point_row(event.site, at, Vector2d::UnitY());
  for (const SlowState& state : layout.fixes) H(state.axis, layout.first + state.index) = 1;
  covariance_.update(H, variance_m2 * Matrix2d::Identity());
}

void TeamBound::use_sighting(const Event& event, sim::Time at) {
  const Layout& own = layouts_[static_cast<std::size_t>(event.site.vehicle)];
  const Layout& other = layouts_[static_cast<std::size_t>(event.other)];
  const Pose observer = pose_at(event.site.vehicle, at);
  // z = R^T (p_other - p_own) - lever: the heading turns the whole vector.
  const sim::Vector3d d_W = pose_at(event.other, at).p_W - observer.p_W;
  const Vector2d d = d_W.head<2>();
  const Matrix2d Rt = rotation2(observer.yaw_rad).transpose();
  MatrixXd H = MatrixXd::Zero(2, covariance_.size());
  H.middleCols<2>(own.first) = -Rt;
  H.middleCols<2>(other.first) = Rt;
  const Vector2d turn = -Rt * left_of(d);
  if (own.heading >= 0) H.col(own.first + own.heading) = turn;
  for (const SlowState& state : own.headings) H.col(own.first + state.index) = turn;
  sim::Vector3d d_V = d_W;
  d_V.head<2>() = Rt * d;
  covariance_.update(H, sight_covariance(event, d_V));
  ++result_.sightings;
}

Matrix2d TeamBound::sight_covariance(const Event& event, const sim::Vector3d& d_V) const {
  const VehicleErrors& own = errors(event.site.vehicle);
  if (event.what == What::sighting)
    return std::max(square_of(own.sightings->white_std_m), min_variance_m2) * Matrix2d::Identity();
  const double level_m = d_V.head<2>().norm();
  const Vector2d u = level_m > 0 ? Vector2d(d_V.head<2>() / level_m) : Vector2d::UnitX();
  const UsblErrors::Plane variances = own.usbl->errors.at(d_V);
  return std::max(variances.along_m2, min_variance_m2) * u * u.transpose() +
         std::max(variances.across_m2, min_variance_m2) * left_of(u) * left_of(u).transpose();
}

void TeamBound::visit_state(sim::StateArchive& archive) {
  archive(covariance_, now_, motions_, events_, pending_, fixed_at_, next_event_, next_packet_, result_);
  if (archive.restoring()) check_restored(archive);
}

void TeamBound::check_restored(const sim::StateArchive& archive) const {
  // A snapshot may be of another build, or damaged: its indices are used without further checks.
  if (covariance_.size() != base_size_ + static_cast<Eigen::Index>(pending_.size()))
    archive.fail("errors of another team");
  if (fixed_at_.size() != team_.size()) archive.fail("fixes of another team");
  sim::Time before = motions_.empty() ? now_ : motions_.front().at;
  for (const Motion& motion : motions_) {
    if (motion.poses.size() != team_.size() || motion.at < before) archive.fail("poses of another team");
    before = motion.at;
  }
  for (const auto& [place, event] : events_) {
    archive.require(event.site.vehicle, 0, size() - 1, "a vehicle");
    archive.require(event.other, 0, size() - 1, "a vehicle");
    const VehicleErrors& own = errors(event.site.vehicle);
    if ((event.what == What::fix && !own.gps) || (event.what == What::sighting && !own.sightings) ||
        (event.what == What::usbl && !own.usbl))
      archive.fail("a measurement that its vehicle cannot take");
  }
}

}  // namespace experiment
