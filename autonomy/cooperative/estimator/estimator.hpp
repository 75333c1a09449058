// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "autonomy/cooperative/estimator/setup.hpp"

namespace navigation {

using Bytes = std::vector<std::uint8_t>;

/// A mistake of an algorithm while it works, in contrast to one that cannot work with its set-up.
class EstimatorFailure : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Frame that arrived by sound, with its one-way range.
struct ReceivedRange {
  Time toa = 0;           ///< arrival, by the own clock
  Time tol = 0;           ///< transmission, by the clock of the sender
  int sender = 0;         ///< index in Setup::team
  double range_m = 0;     ///< (toa - tol) times the speed of sound: with the difference of the clocks; may be below 0
  double std_m = 1;       ///< white error of the range
  double own_z_m = 0;     ///< height of the own modem, from pressure; 0 at the surface
  double sender_z_m = 0;  ///< of the sender's modem
  Time payload_time = 0;  ///< time for which the sender's make_payload() was called, near `tol`
  std::span<const std::uint8_t> payload;  ///< what make_payload() of the sender returned
};

/// Measurement of another vehicle by a sensor on the own one, or of the own one by a sensor on the other.
struct Relative {
  Time time = 0;           ///< by the own clock
  int other = 0;           ///< index in Setup::team
  double range_m = 0;      ///< horizontal
  double bearing_rad = 0;  ///< of the other vehicle, counter-clockwise from east, by the measured heading of the sensor
  bool by_other = false;   ///< the sensor is on the other vehicle: errors of the own heading have no part in it
  double range_std_m = 1;
  double bearing_std_rad = 1;
  Time payload_time = 0;                  ///< time of the payload
  std::span<const std::uint8_t> payload;  ///< newest of the other vehicle; empty: none, or used before
};

/// Estimate of a vehicle's horizontal position.
struct Estimate {
  Vector2 p_W = Vector2::Zero();
  Matrix2 P = Matrix2::Identity();  ///< covariance, m^2
  Vector2 v_W = Vector2::Zero();
  double heading_bias_rad = 0;  ///< true heading minus measured heading
  double clock_error_s = 0;     ///< own clock minus true time
};

/// Algorithm of cooperative navigation, for one vehicle.  It uses no bus and no clock: its state is a value, which is a
/// function of the calls.  The driver makes the calls in the order of their times: a sound comes at its
/// arrival, although its packet is complete only seconds later, for which the driver goes back to a copy.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Starts; called once, before all others.  Throws std::invalid_argument with the reason when the algorithm cannot
  /// work with this set-up, for example with so few bytes.
  virtual void start(const Setup& setup) = 0;
  /// The vehicle moved with this measured velocity since the last call, until `time`.  `q`: white noise of the
  /// displacement, m^2/s.  Both are in east and north by the measured heading: an error of the heading turns both.
  virtual void predict(Time time, const Vector2& v_W, const Matrix2& q) = 0;
  /// Satellite position; `std_m`: white error of each coordinate.
  virtual void fix(Time time, const Vector2& p_W, double std_m) = 0;
  /// A frame arrived.  predict() was called for its time of arrival.  The payload may be that of any program.
  virtual void on_range(const ReceivedRange& received) = 0;
  /// A sensor measured another vehicle, or that one the own vehicle.  An algorithm without it does not work on land.
  virtual void on_bearing(const Relative&) {}
  /// Returns the payload of a frame that is transmitted at `time`, for which predict() was called: at most `max_bytes`.
  virtual Bytes make_payload(Time time, std::size_t max_bytes) = 0;
  /// Returns the estimate at a time shortly after the last call, by the last velocity.
  virtual Estimate now(Time time) const = 0;

  virtual std::unique_ptr<Estimator> clone() const = 0;
};

/// Base of an estimator that is copied by its copy constructor.
template <class Own>
class EstimatorOf : public Estimator {
 public:
  std::unique_ptr<Estimator> clone() const override { return std::make_unique<Own>(static_cast<const Own&>(*this)); }
};

/// Algorithm that has the measurements of all vehicles, as a reference: it runs from a record only.  Its calls are
/// those of Estimator, with the index of the vehicle, in the order of true time.
class TeamEstimator {
 public:
  virtual ~TeamEstimator() = default;
  /// A vehicle starts, some time after others did.
  virtual void start(int vehicle, const Setup& setup) = 0;
  virtual void predict(int vehicle, Time time, const Vector2& v_W, const Matrix2& q) = 0;
  virtual void fix(int vehicle, Time time, const Vector2& p_W, double std_m) = 0;
  /// A vehicle transmits a frame, which others may receive later.
  virtual void sent(int vehicle, Time time) = 0;
  /// ReceivedRange::payload_time is that of the sender; the payload is empty.
  virtual void on_range(int vehicle, const ReceivedRange& received) = 0;
  virtual void on_bearing(int vehicle, const Relative& relative) = 0;
  virtual Estimate now(int vehicle, Time time) const = 0;
};

}  // namespace navigation
