// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/moos/vehicle_commands.hpp"
#include "bridges/moos/vehicle_navigation.hpp"

namespace bridges {

/// Vehicle with a front seat: a program on board, the back seat, steers it over lines of text.
class FrontSeat {
 public:
  /// Answer to a line, and the commands to the vehicle.
  struct Reply {
    std::string lines;  ///< each ends in CRLF; empty: none
    std::vector<ChannelPayload> commands;
  };
  virtual ~FrontSeat() = default;
  /// Takes a line of the back seat, without its end.
  virtual Reply take(std::string_view line, std::int64_t utime) = 0;
  /// Returns the lines about the present state; empty while the position is unknown.
  virtual std::string state(const VehicleNavigation& navigation, std::int64_t utime) const = 0;
  /// Another back seat has connected.
  virtual void begin() {}
  /// Lines that had no meaning.
  std::uint64_t refused() const { return refused_; }

 protected:
  Reply refuse(std::string lines = {}) {
    ++refused_;
    return {std::move(lines), {}};
  }

 private:
  std::uint64_t refused_ = 0;
};

/// The lines of Goby's basic_simulator: the back seat sends START, gets CTRL and NAV, and steers by CMD with heading,
/// speed and depth.  The place and the dynamics in START are those of the run, and not used.
class GobyFrontSeat final : public FrontSeat {
 public:
  explicit GobyFrontSeat(std::string autopilot) : autopilot_(std::move(autopilot)) {}
  Reply take(std::string_view line, std::int64_t utime) override;
  std::string state(const VehicleNavigation& navigation, std::int64_t utime) const override;
  void begin() override { started_ = false; }

 private:
  const std::string autopilot_;  ///< channel of its commands
  bool started_ = false;
};

/// The sentences of Clearpath's Heron M300, as iM300 speaks them: $PYDIR sets both propellers in percent; $CPNVG is the
/// position and attitude, $CPNVR the velocity, $CPRCM the compass.
class HeronFrontSeat final : public FrontSeat {
 public:
  explicit HeronFrontSeat(ThrusterPair thrusters) : thrusters_(std::move(thrusters)) {}
  Reply take(std::string_view line, std::int64_t utime) override;
  std::string state(const VehicleNavigation& navigation, std::int64_t utime) const override;

 private:
  const ThrusterPair thrusters_;
};

/// Splitter of a stream into lines that end in LF or CRLF.  A longer line than `longest` is dropped.
class LineReader {
 public:
  static constexpr std::size_t longest = 1024;
  std::vector<std::string> add(std::string_view bytes);

 private:
  std::string line_;
  bool too_long_ = false;
};

}  // namespace bridges
