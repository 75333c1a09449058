// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "autonomy/cooperative/driver/vehicle_reports.hpp"
#include "autonomy/filters/chi_square.hpp"

namespace navigation {

/// Parameters of a vehicle's navigation beside its vehicle file, those of the live program by default.
struct NavOptions {
  VehicleReports::Start start;
  SoundModel sound = SoundModel::straight;
  std::size_t frame_bytes = 32;
  double gate = autonomy::chi_square_999_1;  ///< squared innovation over its variance
  std::int64_t period_us = 500'000;          ///< between two decisions
};

/// A vehicle that navigates by an algorithm.  A value, whose state is a function of the reports and the calls in their
/// order: the same live and from a record.
class VehicleNavigation {
 public:
  /// Throws std::invalid_argument when the algorithm cannot work with these frames, or runs from a record only.
  VehicleNavigation(std::shared_ptr<const NavTeam> team, int own, const Algorithm& algorithm,
                    const NavOptions& options);

  /// Processes a report of a device.
  template <class Message>
  void receive(const Message& message) {
    const std::vector<NavEvent> events = reports_.receive(message);
    if (!navigator_ && reports_.setup()) navigator_.emplace(*algorithm_, setup());
    for (const NavEvent& event : events) navigator_->add(event);
  }
  /// Processes a packet with a frame, which in a record differs from that in the packet.
  void on_range(const shoal::acoustic_received_t& packet, const Bytes& frame);
  /// Counts a decision.
  void step() { reports_.step(); }
  /// Returns the frame to transmit now; nothing before the start.
  std::optional<Bytes> make_payload();
  /// Returns the estimate of the modem's position; nothing before the start.
  std::optional<Estimate> estimate();
  /// Returns the message of an estimate, for the origin of the vehicle.
  shoal::estimate_t message(const Estimate& estimate) const { return reports_.message(estimate); }

  const VehicleReports& reports() const { return reports_; }
  int ranges() const { return ranges_; }  ///< given to the estimator

 private:
  Setup setup() const;

  VehicleReports reports_;
  const Algorithm* algorithm_;
  NavOptions options_;
  std::optional<Navigator> navigator_;
  int ranges_ = 0;
};

/// Completes the set-up of a vehicle by its options.
Setup completed(Setup setup, const NavOptions& options);

}  // namespace navigation
