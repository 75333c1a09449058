// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/sound_reports.hpp"

namespace sim {

void SoundReports::transmitted(const Transmission& transmission, double range_m) const {
  if (observer_ == nullptr) return;
  observer_->sound_sent({transmission.signal, transmission.source, transmission.sequence, transmission.sent,
                         transmission.p_W, medium_.sound_speed_mps(transmission.p_W)});
  if (transmission.signal.kind != Signal::Kind::message) return;
  transducers_.for_each([&](const Transducer& to) {
    if (&to == transmission.from || !to.is_addressee_of(transmission.signal)) return;
    const Vector3d p_W = to.p_W(transmission.sent);
    if ((p_W - transmission.p_W).norm() <= range_m) return;
    observer_->sound_arrived({transmission.source, transmission.sequence, to.full_name(), true, transmission.sent,
                              transmission.sent, 0, p_W, 0, SignalLoss::range});
  });
}

void SoundReports::arrived(const Flight& flight, const Transmission& transmission, const Transducer& to) {
  const bool beyond = flight.loss == SignalLoss::range && flight.addressed;
  if (!flight.listened && !beyond) return;
  if (flight.addressed && flight.loss == SignalLoss::shadow && shadow_losses_.size() < max_shadow_losses)
    shadow_losses_.push_back(
        {transmission.sent, transmission.source, to.full_name(), (flight.p_started_W - transmission.p_W).norm()});
  if (observer_ != nullptr)
    observer_->sound_arrived({transmission.source, transmission.sequence, to.full_name(), flight.addressed,
                              flight.started, flight.ended, flight.travel_time_s, flight.p_started_W, flight.snr.dB(),
                              flight.loss});
}

}  // namespace sim
