// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/driver.hpp"
#include "experiment/run/run_page.hpp"
#include "sim/world/world.hpp"

namespace viewer {

/// Vehicles that pages drive by hand: one driver each, with its dead-man switch and watchdog (docs/guides/drive.md).
/// The wall time is passed in.
class PageDrive {
 public:
  using Clock = experiment::Driver::Clock;
  using Publish = experiment::RunPage::Publish;

  explicit PageDrive(experiment::DriveProfile profile) : profile_(std::move(profile)) {}

  /// Positions of the controls that a page sends.
  struct Request {
    std::string vehicle, kind;       ///< kind: empty for the most fitting
    experiment::DriveValues values;  ///< empty: the driver has let go
  };
  /// Reads the text of a message `drive`.  Throws DriveError with the reason.
  static Request read(std::string_view text);
  /// Takes the request of a page.  Throws DriveError with the reason if it is refused.
  void take(int client, const Request& request, const sim::World& world, Clock::time_point now);
  /// Releases the vehicles of a page that has left.
  void left(int client);
  /// Publishes the commands that are due.  While the run is paused the drivers count as having let go.
  void run(const sim::World& world, Clock::time_point now, bool paused, const Publish& publish);

  const experiment::DriveProfile& profile() const { return profile_; }

 private:
  struct Seat {
    int client;
    std::string kind;  ///< as requested
    experiment::Driver driver;
  };

  experiment::DriveProfile profile_;
  std::map<std::string, Seat, std::less<>> seats_;  // by vehicle
};

/// Returns the text `forms` for a page (docs/develop/view_protocol.md): the actions of `shoal control do` with their
/// keys, the faults that each type of device takes, the events, objects and actors of the world, and how its vehicles
/// can be driven.
std::string forms_text(const sim::World& world, const experiment::DriveProfile& profile);

}  // namespace viewer
