// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "autonomy/cooperative/driver/nav_frame.hpp"
#include "autonomy/cooperative/driver/nav_team.hpp"
#include "autonomy/cooperative/driver/navigator.hpp"
#include "autonomy/missions/marine/motion_reports.hpp"
#include "autonomy/missions/marine/report_clock.hpp"
#include "shoal/acoustic_received_t.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/pressure_t.hpp"
#include "shoal/usbl_t.hpp"

namespace navigation {

/// Turns the reports of a vehicle's devices into events of navigation.  The navigated point is the modem, so that
/// ranges need no correction.  Times are by the vehicle's clock; when that is set, the times continue
/// (autonomy::ReportClock).
class VehicleReports {
 public:
  /// Own index in the team; `start_W`: known position of the start, with its deviation; otherwise the first fix.
  struct Start {
    std::optional<Vector2> p_W;
    double std_m = 1;
  };

  VehicleReports(std::shared_ptr<const NavTeam> team, int own, const Start& start,
                 SoundModel sound = SoundModel::straight, double period_s = 0.5);

  /// Counts a decision; there is one each `period_s`.
  void step() { clock_.step(); }
  std::vector<NavEvent> receive(const shoal::dvl_t& dvl);
  std::vector<NavEvent> receive(const shoal::ins_t& attitude);
  std::vector<NavEvent> receive(const shoal::compass_t& compass);
  std::vector<NavEvent> receive(const shoal::pressure_t& pressure);
  std::vector<NavEvent> receive(const shoal::gps_data_t& fix);
  /// A relative measurement of another vehicle, without payload.  The next frame() has it, too.
  std::vector<NavEvent> receive(const shoal::usbl_t& relative);
  /// Returns the sound of a packet whose frame is `frame`; nothing when it is not a range to its sender.  The error of
  /// the range has the stamps of both clocks and the depths of both, and is at least min_range_std_m.
  std::optional<NavEvent> range_event(const shoal::acoustic_received_t& packet, const NavFrame& frame);

  /// Returns the relative measurement of this vehicle by the sender, in a frame that it received, at the time of the
  /// relative measurement and with the payload of the frame; nothing when the frame has none that is new.
  std::optional<NavEvent> bearing_by(const shoal::acoustic_received_t& packet, const NavFrame& frame);

  /// The sender's position is that of its newest stamp before the transmission, up to some hundredths of a second
  /// before.
  static constexpr double min_range_std_m = 0.1;

  /// Set with the event from which the estimators start.
  const std::optional<Setup>& setup() const { return setup_; }
  /// Newest stamp.
  Time time() const { return clock_.time() + offset_; }
  /// Time at which a frame that is given to the modem now is transmitted.
  Time transmission() const;
  double modem_depth_m() const;
  /// Frame of this vehicle with a payload that was said for transmission(), and with its newest relative measurements.
  NavFrame frame(Time time, Bytes payload) const;
  /// Message of an estimate, for the origin of the vehicle.
  shoal::estimate_t message(const Estimate& estimate) const;

 private:
  Time note_time(std::int64_t utime);
  void begin(Time time, const Vector2& modem_W, double std_m);
  /// Position of a device relative to another point of the vehicle, in the axes of the world.
  Eigen::Vector3d lever_W(const Eigen::Vector3d& point_B) const { return attitude_.q_WB() * point_B; }
  NavEvent motion_event(Time time, const Vector2& v_W, const Matrix2& q, const Eigen::Vector3d& point_B);
  double range_std_m(int sender, double range_m, double sender_depth_m) const;
  /// Whether a frame is one that its sender transmitted when it planned to.
  bool is_from_sender(const shoal::acoustic_received_t& packet, const NavFrame& frame) const;
  /// Returns a relative measurement by a vehicle, with its white errors, of which a displacement is known.
  static Relative relative_of(const NavVehicle& observer, const Eigen::Vector3d& d_W);

  const NavVehicle& own_vehicle() const { return team_->vehicles[static_cast<std::size_t>(own_)]; }

  std::shared_ptr<const NavTeam> team_;
  int own_;
  Start start_;
  SoundModel sound_;
  std::optional<Setup> setup_;
  autonomy::ReportClock clock_;
  Time offset_ = 0;  ///< of the times from the stamps
  autonomy::AttitudeReports attitude_;
  Vector2 v_W_ = Vector2::Zero();
  bool has_velocity_ = false;
  std::optional<Time> moved_to_;
  Vector2 lever_then_W_ = Vector2::Zero();
  double depth_m_ = 0;  ///< of the origin of the vehicle
  struct RelativePosition {
    Time time = 0;
    Vector2 d_W = Vector2::Zero();  ///< between the modems
  };
  std::map<int, RelativePosition> relatives_;  ///< newest of each other vehicle
  std::map<int, Time> seen_at_;                ///< newest relative measurement by each other vehicle
};

}  // namespace navigation
