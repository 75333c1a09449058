// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/interrogator.hpp"

#include <algorithm>

#include "devices/sound_positioning/transponder.hpp"
#include "sim/physics/body.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

/// Lower bound of the speed of sound in water.
constexpr double slowest_mps = 1400;

}  // namespace

void InterrogatorParams::read(sim::ParamReader& in) {
  in.read("network", network, "transponders of this network answer");
  in.read("range_max_m", range_max_m, sim::above_to(0, 20000), "maximum range to a transponder");
  in.read("source_level_dB", source_level_dB, sim::between(0, 260), "source level of the ping, re 1 uPa at 1 m");
  in.read("frequency_Hz", frequency_Hz, sim::between(100, 1e6), "frequency of the ping");
  in.read("bandwidth_Hz", bandwidth_Hz, sim::between(1, 1e5), "bandwidth of the ping");
  in.read("ping_s", ping_s, sim::between(1e-4, 1), "length of the ping");
  in.read("receiver", receiver, "properties of its receiver");
}

Interrogator::Interrogator(const InterrogatorParams& params, const sim::DeviceContext& context)
    : params_(params),
      context_(context),
      network_(context.shared(transponder_network)),
      transducer_(*this, params.receiver, context.sound_site()) {}

void Interrogator::change(const InterrogatorParams& params) {
  params_ = params;
  transducer_.change(params.receiver);
}

bool Interrogator::listens_to(const sim::Signal& signal) const {
  return signal.kind == sim::Signal::Kind::answer && signal.network == params_.network;
}

void Interrogator::ping(sim::Time at) {
  requested_.clear();
  answers_.clear();
  // List the transponders of the network on other vehicles.
  double slowest_turnaround_s = params_.ping_s, max_answer_s = 0;
  for (const Transponder* transponder : network_.members()) {
    if (transponder->params().network != params_.network || &transponder->vehicle() == &context_.vehicle) continue;
    requested_.push_back(transponder->full_name());
    slowest_turnaround_s = std::max(slowest_turnaround_s, transponder->params().turnaround_s);
    max_answer_s = std::max(max_answer_s, transponder->params().ping_s);
  }
  // Set the reception window: two-way travel time, turnaround and answer.
  waiting_for_ = requested_;
  pinged_ = at;
  window_end_ = at + sim::from_seconds(2 * params_.range_max_m / slowest_mps + slowest_turnaround_s + max_answer_s);
  // Transmit the ping.
  sim::Signal signal;
  signal.kind = sim::Signal::Kind::ping;
  signal.source_level = sim::Decibels{params_.source_level_dB};
  signal.centre_Hz = params_.frequency_Hz;
  signal.bandwidth_Hz = params_.bandwidth_Hz;
  signal.duration = sim::from_seconds(params_.ping_s);
  signal.network = params_.network;
  signal.payload = encode_ping(++number_);
  transducer_.transmit(std::move(signal), at);
}

void Interrogator::receive(const sim::Reception& received) {
  if (!received.understood() || received.signal.code != context_.full_name()) return;
  const auto answer = decode_answer(received.signal.payload);
  // A late answer to an earlier ping would give a wrong range.
  if (!answer || answer->ping != number_) return;
  // The answer begins after the ping has ended, however short the turnaround.
  const double turnaround_s = std::max(answer->turnaround_s, params_.ping_s);
  // Where the transponder was when it answered, from where the ship is when it receives it: both move meanwhile.
  const sim::Vector3d p_ST_W = received.p_sent_W - received.p_started_W;
  const double distance_m = (answer->out_m + p_ST_W.norm()) / 2;
  std::erase(waiting_for_, received.source);
  if (distance_m > params_.range_max_m) return;
  const sim::Matrix3d R_SW = R_WS(received.started).transpose();
  answers_.push_back({received.source, received.started, sim::to_seconds(received.started - pinged_) - turnaround_s,
                      distance_m, R_SW * p_ST_W, R_SW * received.apparent_W, sim::to_power(received.sinr).linear(),
                      received.signal.centre_Hz,
                      received.signal.bandwidth_Hz * sim::to_seconds(received.signal.duration)});
}

sim::Matrix3d Interrogator::R_WS(sim::Time at) const {
  // The body is in its pose at the end of the step, slightly after the arrival of the sound.
  const sim::Vector3d turn_rad = context_.body.motion().w_WB_W * sim::to_seconds(at - context_.world.now());
  const double angle_rad = turn_rad.norm();
  if (angle_rad == 0) return transducer_.R_WS();
  return Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad).toRotationMatrix() * transducer_.R_WS();
}

std::vector<Interrogator::Answer> Interrogator::take_answers() {
  std::vector<Answer> taken;
  std::swap(taken, answers_);
  return taken;
}

void Interrogator::visit_state(sim::StateArchive& archive) {
  archive(number_, pinged_, window_end_, requested_, waiting_for_, answers_);
}

}  // namespace devices
