// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "autonomy/cooperative/estimator/estimator_registry.hpp"

namespace navigation {

/// Estimator that is copied with its owner.
class OwnedEstimator {
 public:
  explicit OwnedEstimator(std::unique_ptr<Estimator> estimator) : estimator_(std::move(estimator)) {}
  OwnedEstimator(const OwnedEstimator& other) : estimator_(other.estimator_->clone()) {}
  OwnedEstimator(OwnedEstimator&&) noexcept = default;
  OwnedEstimator& operator=(const OwnedEstimator& other) {
    estimator_ = other.estimator_->clone();
    return *this;
  }
  OwnedEstimator& operator=(OwnedEstimator&&) noexcept = default;
  ~OwnedEstimator() = default;

  Estimator* operator->() { return estimator_.get(); }
  const Estimator* operator->() const { return estimator_.get(); }

 private:
  std::unique_ptr<Estimator> estimator_;
};

/// What happened to a vehicle, by its own clock.
struct NavEvent {
  enum class Kind { motion, fix, received, bearing, payload };

  Kind kind = Kind::motion;
  Time time = 0;
  Vector2 v_W = Vector2::Zero();  ///< motion
  Matrix2 q = Matrix2::Zero();    ///< motion
  Vector2 p_W = Vector2::Zero();  ///< fix
  double std_m = 1;               ///< fix
  ReceivedRange received;         ///< without its payload
  Relative seen;                  ///< without its payload
  Bytes payload;                  ///< of the frame
  std::size_t max_bytes = 0;      ///< payload
};

/// One vehicle with one algorithm.  It makes the calls of the estimator in the order of their times, although packets
/// are complete seconds after their first sound: it keeps the estimator as it was `window_s` ago and what happened
/// since, and repeats that.  Before each fix, range, bearing and transmission it moves the estimator to that time.  A
/// value: its copies are independent.
class Navigator {
 public:
  /// Events may be this much older than the newest; older ones are dropped.
  static constexpr double window_s = 20;

  /// Starts the estimator.  Throws std::invalid_argument as Estimator::start().
  Navigator(const Algorithm& algorithm, const Setup& setup);

  /// Adds an event.  Returns false, with no effect, when it is older than window_s.
  bool add(NavEvent event);
  /// Returns the payload of a frame that is transmitted at `time`.
  Bytes make_payload(Time time, std::size_t max_bytes);
  /// Returns the estimate at a time, by the last velocity if that is after the last motion.
  Estimate now(Time time);
  int dropped() const { return dropped_; }

 private:
  /// Tells one event of `recent_` to an estimator.
  void apply(OwnedEstimator& estimator, std::size_t index, Time& moved_to, Bytes* payload = nullptr) const;
  void settle();
  void catch_up();

  OwnedEstimator settled_;  ///< has all events before `recent_`
  OwnedEstimator ahead_;    ///< has the first `applied_` events of `recent_`, too
  std::deque<NavEvent> recent_;
  std::size_t applied_ = 0;
  Time settled_to_, ahead_to_;  ///< until when they moved
  NavEvent last_moved_;
  int dropped_ = 0;
};

}  // namespace navigation
