// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/acomms/acoustic_frame.hpp"
#include "autonomy/acomms/channel_access.hpp"
#include "autonomy/filters/pose2.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"

namespace autonomy {

/// Station that sends a vehicle beyond its direct reception to positions, by radio and through relays of its messages.
/// It sends an order in each of its turns until a state of the vehicle confirms or refuses it, or the next one is due.
/// A pure function of its reports in their order; its time is that of their stamps, the station's own clock.
class CoopStation {
 public:
  struct TimedOrder {
    double at_s = 0;  ///< after the first report
    Vector2d p_W = Vector2d::Zero();
    double depth_m = 0;
    double speed_mps = 1.5;
  };
  struct Params {
    std::string name;
    int id = 200;   ///< in its frames
    int to_id = 0;  ///< of the vehicle that receives the orders
    std::vector<TimedOrder> orders;
    ChannelAccess::Params access;
  };
  struct Decision {
    std::optional<shoal::estimate_t> knowledge;  ///< for NAME.knowledge: position of the vehicle by its newest state
    std::optional<shoal::modem_send_t> send;     ///< for NAME.radio.cmd
    std::string status;                          ///< text for the user; empty: none
  };
  struct Counts {
    int sent = 0;
    int states = 0;  ///< of its vehicle
    int bad_frames = 0;
    int orders = 0;  ///< that were due
    int executed = 0;
    int refused = 0;
  };

  /// Throws std::invalid_argument when there are more than 255 orders, they are not in the order of their times, or one
  /// cannot be encoded in a frame.
  explicit CoopStation(const Params& params);

  void receive(const shoal::gps_data_t& fix);
  void receive(const shoal::modem_received_t& packet);
  /// Computes the commands after all reports up to now.
  Decision step();

  const Counts& counts() const { return counts_; }

 private:
  void note_time(std::int64_t utime);
  AcousticOrder order(int number) const;
  void note_answer(const AcousticState& state);

  Params params_;
  ChannelAccess access_;
  std::int64_t utime_ = 0;  ///< newest stamp
  std::optional<std::int64_t> first_utime_;
  std::optional<AcousticState> state_;  ///< newest
  bool has_update_ = false;
  int answered_ = 0;          ///< number of the order that the vehicle executed or refused last
  int last_executed_ = 0;     ///< largest executed number
  std::vector<int> refused_;  ///< numbers, ascending
  std::string status_;
  Counts counts_;
};

}  // namespace autonomy
