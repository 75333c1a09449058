// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"
#include "autonomy/cooperative/filter/own_filter.hpp"
#include "sim/random/random.hpp"

namespace navigation {

namespace {

/// Particle filter by ranges only, for a start that is not known: weights exp(-(z - h)^2 / 2 S) with S = R + u' B u,
/// and systematic resampling (Kitagawa 1996) when the effective number is below half.  The first range places the
/// particles on a ring.  When their covariance is an ellipse that an extended Kalman filter can continue (deviations
/// below `handover_m`, and no second cluster), it does, as `naive`.  With a known start it is `naive` at once.
class ParticleStart final : public OwnFilterEstimator<ParticleStart> {
 public:
  static constexpr const char* meaning = "particle filter by ranges for an unknown start, then as naive";
  static constexpr std::size_t count = 2000;
  static constexpr double unknown_start_m = 50;  ///< a larger deviation of the start needs particles
  static constexpr double handover_m = 15;

  void start(const Setup& setup) override {
    need_bytes(setup, "pf", position_bytes);
    OwnFilterEstimator::start(setup);
    random_ = sim::Random(setup.seed, setup.team[static_cast<std::size_t>(setup.own)].name + "/pf");
    if (setup.position_std_m <= unknown_start_m) return;
    for (std::size_t i = 0; i < count; ++i)
      particles_.push_back(setup.position_W + setup.position_std_m * Vector2(random_.gaussian(), random_.gaussian()));
    weights_.assign(count, 1.0 / count);
  }
  void predict(Time time, const Vector2& v_W, const Matrix2& q) override {
    const double dt_s = seconds(time - filter_.time(own));
    OwnFilterEstimator::predict(time, v_W, q);
    if (particles_.empty() || !(dt_s > 0)) return;
    const double east_m = std::sqrt(q(0, 0) * dt_s), north_m = std::sqrt(q(1, 1) * dt_s);
    for (Vector2& p_W : particles_)
      p_W += v_W * dt_s + Vector2(east_m * random_.gaussian(), north_m * random_.gaussian());
    summarize(false);
  }
  void fix(Time time, const Vector2& p_W, double std_m) override {
    if (!particles_.empty()) {
      particles_.clear();
      filter_ = JointFilter(setup_.sound_speed_mps, setup_.gate);
      filter_.add(setup_.errors(), time, p_W, std_m);
      return;
    }
    OwnFilterEstimator::fix(time, p_W, std_m);
  }
  void on_range(const ReceivedRange& received) override {
    const auto sender = position_in(received.payload);
    if (!sender) return;
    const double dz_m = received.own_z_m - received.sender_z_m;
    const double clock_m2 = sender_clock_variance_m2(setup_, received.sender, received.toa - setup_.time);
    if (particles_.empty()) {
      filter_.range(own, *sender, dz_m, received.range_m, received.std_m, clock_m2);
      return;
    }
    const double own_clock_m = setup_.sound_speed_mps * setup_.errors().clock_s;
    // Particles have no state for the clock, so its error counts as noise of the range.
    const double R = received.std_m * received.std_m + clock_m2 + own_clock_m * own_clock_m;
    if (!has_received_) place_on_ring(*sender, received.range_m, dz_m, std::sqrt(R));
    has_received_ = true;
    weigh(*sender, received.range_m, dz_m, R);
    resample();
    summarize(true);
  }
  Bytes make_payload(Time time, std::size_t) override { return payload_of(own_position(time)); }

 private:
  void place_on_ring(const Position& sender, double range_m, double dz_m, double std_m) {
    const double horizontal_m = std::sqrt(std::max(0.0, range_m * range_m - dz_m * dz_m));
    for (Vector2& p_W : particles_) {
      const double angle_rad = 2 * std::numbers::pi * random_.uniform();
      const double radius_m = horizontal_m + 2 * std_m * random_.gaussian();
      p_W = sender.p_W + radius_m * Vector2(std::cos(angle_rad), std::sin(angle_rad));
    }
  }
  void weigh(const Position& sender, double range_m, double dz_m, double R) {
    std::vector<double> exponents(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector2 d_W = particles_[i] - sender.p_W;
      const double distance_m = std::max(std::hypot(d_W.norm(), dz_m), 0.1);
      const Vector2 u = d_W / distance_m;
      const double error_m = range_m - distance_m;
      exponents[i] = -0.5 * error_m * error_m / (R + u.dot(sender.P * u));
    }
    // Shifted by the largest exponent: weights of particles far from the range would all underflow to 0.
    const double largest = *std::max_element(exponents.begin(), exponents.end());
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      weights_[i] *= std::exp(exponents[i] - largest);
      sum += weights_[i];
    }
    for (double& weight : weights_) weight = sum > 0 ? weight / sum : 1.0 / count;
  }
  void resample() {
    double squares = 0;
    for (const double weight : weights_) squares += weight * weight;
    // Effective number of particles: resampling without need loses variety.
    if (1 / squares > 0.5 * count) return;
    std::vector<Vector2> chosen;
    // Systematic resampling: one random number for all.
    const double start = random_.uniform();
    double sum = weights_[0];
    std::size_t from = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double place = (static_cast<double>(i) + start) / count;
      while (place > sum && from + 1 < count) sum += weights_[++from];
      chosen.push_back(particles_[from]);
    }
    particles_ = std::move(chosen);
    weights_.assign(count, 1.0 / count);
  }
  /// Sets the filter to mean and covariance of the particles, and ends them when it can continue alone.
  void summarize(bool may_end) {
    Vector2 mean = Vector2::Zero();
    for (std::size_t i = 0; i < count; ++i) mean += weights_[i] * particles_[i];
    Matrix2 P = 0.01 * Matrix2::Identity();
    for (std::size_t i = 0; i < count; ++i) {
      const Vector2 d = particles_[i] - mean;
      P += weights_[i] * d * d.transpose();
    }
    Eigen::VectorXd x = filter_.x();
    Eigen::MatrixXd all = filter_.P();
    x.head<2>() = mean;
    all.topRows<2>().setZero();
    all.leftCols<2>().setZero();
    all.topLeftCorner<2, 2>() = P;
    filter_.set_x(x);
    filter_.set_P(all);
    if (!may_end || P.trace() > 2 * handover_m * handover_m) return;
    // A normal distribution has 1.1 % beyond 3 sigma; a second cluster more.
    const Matrix2 inverse = P.inverse();
    double outside = 0;
    for (std::size_t i = 0; i < count; ++i)
      if ((particles_[i] - mean).dot(inverse * (particles_[i] - mean)) > 9) outside += weights_[i];
    if (outside < 0.05) particles_.clear();
  }

  sim::Random random_{1, "pf"};
  std::vector<Vector2> particles_;  ///< empty: the filter is alone
  std::vector<double> weights_;
  bool has_received_ = false;
};

SHOAL_ESTIMATOR("pf", ParticleStart);

}  // namespace

}  // namespace navigation
