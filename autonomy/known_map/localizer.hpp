// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "autonomy/known_map/distance_field.hpp"
#include "autonomy/mapping/lidar_odometry.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "sim/random/random.hpp"

namespace autonomy {

/// Likelihood of the ends of beams in a map (likelihood field: Thrun, Burgard and Fox, Probabilistic Robotics, 2005,
/// section 6.4), and the places where a vehicle can be.  Shared by the copies of a localizer.
class LikelihoodField {
 public:
  /// Throws as frame_of().
  explicit LikelihoodField(const shoal::occupancy_grid_t& map);

  enum class Width { fine, wide };  ///< wide: a pose that is wrong by some decimeters still fits somewhat
  /// Returns the logarithm of the likelihood at a point, at max 0.
  float log_likelihood(Width width, const Vector2d& p_W) const;
  enum class End {
    known,
    nowhere,
    behind
  };  ///< nowhere: unknown; behind: unknown, and the beam passes through something
  End end_of(const Vector2d& sensor_W, const Vector2d& end_W) const;
  const GridFrame& frame() const { return frame_; }
  /// Cells that are free and not beside something.
  const std::vector<std::uint32_t>& places() const { return places_; }

 private:
  GridFrame frame_;
  float unknown_ = 0;                                 ///< outside of the map
  std::array<std::vector<float>, 2> log_likelihood_;  ///< by width
  std::vector<char> known_;                           ///< 1: free, 2: occupied
  std::vector<std::uint32_t> places_;
};

/// Monte Carlo localization in a given map by a planar lidar and odometry (Thrun, Burgard and Fox 2005, sections 8.3.1
/// to 8.3.7): a particle filter with the odometry motion model and the likelihood field.  The number of particles
/// follows from the cells of pose space that they occupy (KLD sampling, Fox 2003).  While the scans fit clearly worse
/// than they did (augmented MCL, with the threshold of Gutmann and Fox 2002), as after the vehicle was carried, a share
/// of the particles is drawn again: from the whole map, by the likelihood of the scan.  How a scan fits is judged at
/// the estimate, by the beams that end in what the map knows: ground that is not in the map says nothing about it. A
/// pure function of the messages in their order, independent of clock and bus.  Its copy is its whole state.
class Localizer {
 public:
  struct Params {
    std::optional<Pose2> start;  ///< unset: it can be anywhere in the map
    double start_std_m = 0.3;
    double start_std_rad = 0.1;
    LidarMount lidar;
    double rest_mps = 0.003;   ///< odometry below both is noise at rest
    double rest_radps = 0.01;  ///< and does not move the particles
    int min_particles = 400, max_particles = 6000;
    int tried_places = 40000;    ///< poses of the whole map that are compared when particles are drawn again
    double slow = 0.02;          ///< share of a scan in the mean of how well scans usually fit
    double fast = 0.3;           ///< share of a scan in the mean of how well they fit now
    double lost_below = 0.67;    ///< ratio of the two below which particles are drawn again
    double independent = 0.25;   ///< share of the beams that count as independent
    std::size_t max_beams = 60;  ///< used of a scan
    std::uint64_t seed = 1;
  };

  Localizer(std::shared_ptr<const LikelihoodField> field, const Params& params);

  /// Throws shoal::MessageError for numbers that no vehicle reaches.
  void receive(const shoal::odometry_t& odometry);
  /// Takes a scan; of several before a tick the last counts.
  void receive(const shoal::planar_lidar_t& scan);
  /// Processes the last scan.  Returns the pose of its time; none without a new scan and odometry.
  std::optional<shoal::estimate_t> step();

  const Pose2& pose() const { return pose_; }
  std::size_t particles() const { return particles_.size(); }
  /// Returns whether the standard deviation of its position is above 1 m.
  bool is_lost() const { return covariance_m2_.trace() > 2; }

 private:
  struct Particle {
    Pose2 pose;
    double weight = 1;
  };
  /// Returns the sum of the logarithms of the likelihoods, of each `every`-th beam.
  double log_likelihood(const Pose2& pose, LikelihoodField::Width width, std::size_t every) const;
  /// Returns the mean likelihood, at the present pose, of the beams that end in what is known; none: they are few.
  /// Where nearly all beams pass through something into the unknown it is that of what the map does not have.
  std::optional<double> fit() const;
  double share_lost() const;
  Pose2 any_pose();
  void move(const Increment& by);
  void weigh();
  void estimate();
  /// Follows how well the scans fit.
  void judge();
  void resample();
  /// Draws poses of the whole map by the likelihood of the scan.
  std::vector<Pose2> poses_of_scan(std::size_t count);

  std::shared_ptr<const LikelihoodField> field_;
  Params params_;
  std::vector<Particle> particles_;
  std::vector<Vector2d> points_B_;  ///< of the present scan
  std::optional<shoal::odometry_t> odometry_;
  std::optional<shoal::planar_lidar_t> scan_;
  Odometer odometer_{Pose2{}};
  std::int64_t utime_ = 0;
  Pose2 postponed_{};                   ///< motion too slow to differ from noise, since the particles were moved
  double slow_fit_ = 0, fast_fit_ = 0;  ///< means of how well the scans fit, 0 to 1
  std::int64_t judged_scans_ = 0;
  Pose2 pose_;
  Eigen::Matrix2d covariance_m2_ = Eigen::Matrix2d::Zero();
  sim::Random random_;
  std::int64_t scans_ = 0;
};

}  // namespace autonomy
