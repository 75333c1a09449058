// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/transponder.hpp"

#include <algorithm>
#include <cmath>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/transponder_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Transponder::Params::read(sim::ParamReader& in) {
  in.read("network", network, "it answers pings of this network and pings without a network");
  in.read("code", code, "it answers pings with this code and pings without a code");
  in.read("turnaround_s", turnaround_s, sim::between(0, 10),
          "turnaround time, from the start of the ping to the start of the answer");
  in.read("source_level_dB", source_level_dB, sim::between(0, 260), "source level of the answer, re 1 uPa at 1 m");
  in.read("frequency_Hz", frequency_Hz, sim::between(100, 1e6), "frequency of the pings that it receives");
  in.read(
      "answer_frequency_Hz", answer_frequency_Hz, sim::between(100, 1e6),
      "frequency of its answer; unset: the lowest of 28000, 29000, ... that no other transponder of its network uses");
  in.read("bandwidth_Hz", bandwidth_Hz, sim::between(1, 1e5), "about both frequencies");
  in.read("ping_s", ping_s, sim::between(1e-4, 1), "length of the answer");
  in.read("receiver", receiver, "properties of its receiver");
}

Transponder::Transponder(const Params& params, const sim::DeviceContext& context)
    : params_(params),
      vehicle_(context.vehicle),
      network_(context.shared(transponder_network)),
      answer_Hz_(params.answer_frequency_Hz ? *params.answer_frequency_Hz
                                            : network_.free_answer_Hz(params.network, params.bandwidth_Hz)),
      transducer_(*this, params.receiver, context.sound_site()) {
  network_.join(*this);
}

Transponder::~Transponder() {
  network_.leave(*this);
}

bool Transponder::listens_to(const sim::Signal& signal) const {
  return signal.kind == sim::Signal::Kind::ping && (signal.network.empty() || signal.network == params_.network) &&
         (signal.code.empty() || signal.code == params_.code) &&
         std::abs(signal.centre_Hz - params_.frequency_Hz) < (signal.bandwidth_Hz + params_.bandwidth_Hz) / 2;
}

void Transponder::receive(const sim::Reception& received) {
  // It does not answer its own vehicle, whose interrogator it would drown.
  if (!received.understood() || received.source.starts_with(vehicle().name() + "/")) return;
  const sim::Time at = std::max(received.started + sim::from_seconds(params_.turnaround_s), received.ended);
  // One answer at a time: pings that arrive meanwhile are lost, as with real transponders.
  if (at < transducer_.busy_until()) return;
  ++answers_;
  asked_by_ = received.source;
  sim::Signal answer;
  answer.kind = sim::Signal::Kind::answer;
  answer.source_level = sim::Decibels{params_.source_level_dB};
  answer.centre_Hz = answer_Hz_;
  answer.bandwidth_Hz = params_.bandwidth_Hz;
  answer.duration = sim::from_seconds(params_.ping_s);
  answer.network = params_.network;
  answer.code = received.source;
  answer.payload = encode_answer({decode_ping(received.signal.payload), params_.turnaround_s,
                                  (received.p_started_W - received.p_sent_W).norm(), params_.code});
  transducer_.transmit(std::move(answer), at);
}

void Transponder::visit_state(sim::StateArchive& archive) {
  archive(answers_, answer_Hz_, asked_by_);
  archive.require(answer_Hz_, 1, sim::Signal::max_Hz, "a frequency of a transponder's answer");
}

void fill(const Transponder& transponder, shoal::transponder_t& message) {
  message.answers = transponder.answers();
  message.asked_by = transponder.asked_by();
}

SHOAL_SENSOR("transponder", Transponder, shoal::transponder_t);

}  // namespace devices
