// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "autonomy/cooperative/driver/nav_record.hpp"
#include "autonomy/cooperative/driver/navigator.hpp"

namespace navigation {

/// Motion of a vehicle by its odometry, as it measured it: the heading begins with that of the start pose.
class OdometryTrack {
 public:
  /// Motion between two reports.
  struct Segment {
    Time from = 0, to = 0;
    Vector2 v_W = Vector2::Zero();
    Matrix2 q = Matrix2::Zero();
    double from_heading_rad = 0, to_heading_rad = 0;
  };

  explicit OdometryTrack(const LandVehicle& vehicle) : vehicle_(&vehicle) {}

  /// Adds a report; one that is not later than the last has no effect.
  void add(Time time, const shoal::odometry_t& odometry);
  const std::vector<Segment>& segments() const { return segments_; }
  /// Heading at a time, between two reports; that of the first or last one outside of them.
  double heading_rad(Time time) const;

 private:
  const LandVehicle* vehicle_;
  std::optional<Time> time_;
  shoal::odometry_t last_{};
  std::vector<Segment> segments_;
};

/// What happened to the vehicles of a record on land.  Times are simulated ones; the clocks of the vehicles are taken
/// as right.
struct LandEvents {
  struct Event {
    int vehicle = 0;
    /// A fix of the vehicle's origin, a bearing, or a message by radio: at its transmission of kind `payload`, and at
    /// its reception of kind `received`, whose `payload_time` is that of its transmission.
    NavEvent event;
  };
  std::vector<OdometryTrack> tracks;  ///< by vehicle
  std::vector<Event> events;          ///< in the order of time
};

/// Turns the messages of a record into events.  A vehicle that is seen but not in the team, such as a landmark, is left
/// out.  `record` must outlive the result.
LandEvents land_events_of(const NavRecord& record);

}  // namespace navigation
