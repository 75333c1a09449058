// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/nmea/sentences.hpp"
#include "shoal/helm_command_t.hpp"

namespace bridges::nmea {

/// Headings for the autopilot of a vehicle from the sentences of a chart plotter: the heading to steer of APB; while no
/// APB has come for 5 s, the bearing of the destination of RMB.  Sentences with a warning (status V) are not followed.
class Steering {
 public:
  static constexpr std::int64_t prefer_apb_us = 5'000'000;

  /// `variation_deg`: of magnetic headings to steer, positive to the east.
  explicit Steering(double variation_deg) : variation_deg_(variation_deg) {}

  /// Takes a line without its end.  Returns why it is refused; empty: it was taken, or is of no concern here.
  std::string take(std::string_view line, std::int64_t utime);
  /// Returns the command of the last sentence, once.
  std::optional<shoal::helm_command_t> take_command();

 private:
  std::string take(const Apb& apb, std::int64_t utime);
  std::string take(const Rmb& rmb, std::int64_t utime);
  void steer(double heading_deg, std::int64_t utime);

  double variation_deg_;
  std::optional<std::int64_t> apb_utime_;
  std::optional<shoal::helm_command_t> command_;
};

}  // namespace bridges::nmea
