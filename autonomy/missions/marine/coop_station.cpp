// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/coop_station.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "autonomy/acomms/state_packet.hpp"

namespace autonomy {

namespace {

constexpr std::size_t max_orders = 255;

std::string decimal(double number) {
  return fmt::format("{:g}", number);
}

shoal::estimate_t estimate_of(const AcousticState& state) {
  const Motion motion = motion_of(state);
  // A covariance with a correlation of 1 is invalid.
  AcousticState uncertain = state;
  uncertain.correlation = std::clamp(state.correlation, -0.99, 0.99);
  shoal::estimate_t estimate = estimate_message(state.utime, motion.p_W, motion.v_W, covariance_of(uncertain));
  set_depth(estimate, state.depth_m);
  estimate.yaw_rad = state.course_rad;
  estimate.clock_error_s = unknown;
  return estimate;
}

}  // namespace

CoopStation::CoopStation(const Params& params) : params_(params), access_(params.access, params.name) {
  const auto& orders = params_.orders;
  if (orders.size() > max_orders) throw std::invalid_argument("there may be up to 255 orders");
  for (std::size_t i = 0; i < orders.size(); ++i) {
    if (!(orders[i].at_s >= (i == 0 ? 0 : orders[i - 1].at_s)))
      throw std::invalid_argument("the times of the orders must be >= 0 and must not decrease");
    if (!acoustic_frame::encode(order(static_cast<int>(i + 1))))
      throw std::invalid_argument("order " + std::to_string(i + 1) +
                                  " does not fit into a frame: depth >= 0 m, speed 0.01 to 655 m/s, ids 0 to 255");
  }
}

void CoopStation::note_time(std::int64_t utime) {
  if (!first_utime_) first_utime_ = utime;
  utime_ = utime;
}

void CoopStation::receive(const shoal::gps_data_t& fix) {
  note_time(fix.utime);  // only for its clock: the position of the station is known
}

void CoopStation::receive(const shoal::modem_received_t& packet) {
  note_time(packet.utime);
  const auto state = state_in(packet);
  if (!state) {
    ++counts_.bad_frames;
    return;
  }
  if (state->sender != params_.to_id || (state_ && state->utime <= state_->utime)) return;
  ++counts_.states;
  state_ = state;
  has_update_ = true;
  note_answer(*state);
}

void CoopStation::note_answer(const AcousticState& state) {
  answered_ = std::max(state.order, state.refused_order);
  last_executed_ = std::max(last_executed_, state.order);
  if (state.refused_order <= (refused_.empty() ? 0 : refused_.back())) return;
  refused_.push_back(state.refused_order);
  ++counts_.refused;
  status_ = "order " + std::to_string(state.refused_order) + " was refused: " + to_text(state.refusal);
  if (static_cast<std::size_t>(state.refused_order) > params_.orders.size()) return;
  const TimedOrder& refused = params_.orders[static_cast<std::size_t>(state.refused_order) - 1];
  if (state.refusal == OrderRefusal::too_deep) status_ += ", " + decimal(refused.depth_m) + " m";
  if (state.refusal == OrderRefusal::too_fast) status_ += ", " + decimal(refused.speed_mps) + " m/s";
}

AcousticOrder CoopStation::order(int number) const {
  const TimedOrder& timed = params_.orders[static_cast<std::size_t>(number - 1)];
  return {params_.id, params_.to_id, number, utime_, timed.p_W.x(), timed.p_W.y(), timed.depth_m, timed.speed_mps};
}

CoopStation::Decision CoopStation::step() {
  Decision decision;
  if (!first_utime_) return decision;
  const double since_s = static_cast<double>(utime_ - *first_utime_) * 1e-6;
  const auto& orders = params_.orders;
  counts_.orders = static_cast<int>(
      std::count_if(orders.begin(), orders.end(), [&](const TimedOrder& each) { return each.at_s <= since_s; }));
  const auto refused_before = std::upper_bound(refused_.begin(), refused_.end(), last_executed_) - refused_.begin();
  counts_.executed =
      std::max(counts_.executed, std::min(last_executed_, counts_.orders) - static_cast<int>(refused_before));
  std::swap(decision.status, status_);
  if (has_update_) decision.knowledge = estimate_of(*state_);
  has_update_ = false;
  if (access_.take_turn(utime_) && counts_.orders > answered_) {
    decision.send = to_everybody(order(counts_.orders));
    if (decision.send) ++counts_.sent;
  }
  return decision;
}

}  // namespace autonomy
