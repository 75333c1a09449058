// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "experiment/score/bound/error_covariance.hpp"
#include "experiment/score/bound/vehicle_errors.hpp"
#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/state/state_archive.hpp"

namespace experiment {

/// Posterior Cramer-Rao bound of the horizontal positions of a team along their true tracks, from the errors of their
/// devices and the measurements that happened.  It is joint over the team: every measurement of every vehicle counts,
/// with all correlations.
///
/// The errors of a vehicle, in this order, omitting those that it does not have: east and north of its frame (m),
/// heading (rad, of wheels), speed scale, turn scale, slow errors of heading and velocity, slow errors of GPS (m),
/// clock (s) and frequency.  docs/guides/navigation_bound.md has the equations.
///
/// A range refers to the positions at transmission and at arrival, and counts from the time at which it is known.  So
/// the recursion runs behind: measurements may be added in any order until advance() has passed their times.
class TeamBound {
 public:
  /// Errors that may be taken as known, to see what they cost.
  enum class Known { clock, heading_bias, heading_drift, speed_scale, velocity_drift, gps_drift };
  struct Options {
    double start_std_m = 1000;                                  ///< of east and north at the start
    double start_heading_std_rad = sim::degrees_to_radians(5);  ///< of the heading of vehicles with wheels
    double sound_speed_std = 0;  ///< relative error of the speed of sound, one for all ranges
    std::set<Known> known;
    double from_s = 0;  ///< start of the scoring
  };
  struct Pose {
    sim::Vector3d p_W = sim::Vector3d::Zero();
    double yaw_rad = 0;
    void visit_state(sim::StateArchive& archive) { archive(p_W, yaw_rad); }
  };
  /// Place of a device: a vehicle, and a point in its frame.
  struct Site {
    int vehicle = 0;
    sim::Vector3d at_V = sim::Vector3d::Zero();
    void visit_state(sim::StateArchive& archive) { archive(vehicle, at_V); }
  };
  struct Result {
    std::int64_t samples = 0;
    double sum_m2 = 0;  ///< of the variances of east and north, over the samples
    double max_m2 = 0, last_m2 = 0;
    std::int64_t ranges = 0, fixes = 0, sightings = 0;
    void visit_state(sim::StateArchive& archive) {
      archive(samples, sum_m2, max_m2, last_m2, ranges, fixes, sightings);
    }
  };

  /// `scored`: index of the vehicle whose position is bounded.
  TeamBound(std::vector<VehicleErrors> team, int scored, const Options& options);

  int size() const { return static_cast<int>(team_.size()); }
  const VehicleErrors& errors(int vehicle) const { return team_[static_cast<std::size_t>(vehicle)]; }

  /// Sets the true poses at a time later than the last one.  `scores`: the bound at this time counts in the result.
  void move(sim::Time at, std::vector<Pose> poses, bool scores);
  // Measurements.  Those that refer to a time before the present one of the recursion, or before the first pose, have
  // no effect.
  void add_fix(sim::Time at, int vehicle);
  /// `known`: when the receiver has the measurement.  `more_variance_m2`: in addition to the resolution of the stamps.
  void add_range(sim::Time sent, const Site& sender, sim::Time arrived, const Site& receiver, sim::Time known,
                 double more_variance_m2);
  void add_sighting(sim::Time at, int observer, int other);
  /// Relative position by USBL, at the arrival of the sound.
  void add_usbl(sim::Time at, int observer, int other);
  /// Processes everything before a time, which must not be later than the last poses.
  void advance(sim::Time until);
  /// Processes a copy of everything that was added, and returns the result.
  Result result() const;
  /// Covariance of all errors at the present time of the recursion.
  const Eigen::MatrixXd& covariance() const { return covariance_.matrix(); }
  /// Index of the east error of a vehicle in the covariance; north follows.
  int position_index(int vehicle) const { return layouts_[static_cast<std::size_t>(vehicle)].first; }

  void visit_state(sim::StateArchive& archive);

 private:
  struct SlowState {
    int index = 0;  ///< relative to the first error of the vehicle
    int axis = 0;
    SlowError error;
  };
  /// Places of the errors of a vehicle; relative to the first one, -1: it has none.
  struct Layout {
    int first = 0, count = 0;
    int heading = -1, scale = -1, turn_scale = -1, clock = -1, frequency = -1;
    std::vector<SlowState> headings, velocities, fixes;
  };
  struct Motion {
    sim::Time at{0};
    std::vector<Pose> poses;
    bool scores = false;
    void visit_state(sim::StateArchive& archive) { archive(at, poses, scores); }
  };
  enum class What { fix, sending, arrival, range, sighting, usbl };
  struct Event {
    What what = What::fix;
    Site site;      ///< receiver of the fix, sender or receiver of the sound, observer
    int other = 0;  ///< relative position, USBL: vehicle that is observed
    std::int64_t packet = 0;
    Eigen::Vector2d toward = Eigen::Vector2d::Zero();  ///< horizontal part of the unit vector from sender to receiver
    double range_m = 0, sound_speed_mps = 0, variance_m2 = 0;
    void visit_state(sim::StateArchive& archive) {
      archive(what, site, other, packet, toward, range_m, sound_speed_mps, variance_m2);
    }
  };

  Layout make_layout(const VehicleErrors& errors, int first, std::vector<double>& variances) const;
  bool knows(Known what) const { return options_.known.contains(what); }
  bool is_late(sim::Time at) const { return motions_.empty() || at < now_; }
  void add_event(sim::Time at, Event event);
  Pose pose_at(int vehicle, sim::Time at) const;
  void predict(sim::Time until);
  void predict_vehicle(int vehicle, const Pose& from, const Pose& to, double dt_s, sim::Time until);
  void handle(const Event& event, sim::Time at);
  void use_fix(const Event& event, sim::Time at);
  void use_sighting(const Event& event, sim::Time at);
  /// Returns the error covariance of a relative position in the axes of the observer, for a displacement in these axes.
  Eigen::Matrix2d sight_covariance(const Event& event, const sim::Vector3d& d_V) const;
  /// Returns the row of the displacement of a point along `direction`.
  Eigen::RowVectorXd point_row(const Site& site, sim::Time at, const Eigen::Vector2d& direction) const;
  Eigen::RowVectorXd clock_row(int vehicle, double sound_speed_mps) const;
  /// Index of the pending displacement of a packet in the covariance; -1: it has none.
  Eigen::Index pending_index(std::int64_t packet) const;
  void check_restored(const sim::StateArchive& archive) const;

  std::vector<VehicleErrors> team_;
  int scored_;
  Options options_;
  std::vector<Layout> layouts_;
  int sound_speed_index_ = -1;
  Eigen::Index base_size_ = 0;

  ErrorCovariance covariance_;  ///< of all errors, then a displacement for each packet under way
  sim::Time now_{0};            ///< of the recursion
  std::deque<Motion> motions_;  ///< the first one is at or before `now_`
  std::map<std::pair<std::int64_t, std::int64_t>, Event> events_;  ///< by time, us, and order of arrival
  std::vector<std::int64_t> pending_;                              ///< packets under way
  std::vector<sim::Time> fixed_at_;                                ///< time of the last fix by vehicle
  std::int64_t next_event_ = 0, next_packet_ = 0;
  Result result_;
};

}  // namespace experiment
