// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/sound_positioning/acoustic_positioning.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Parameters of a device that interrogates transponders.
struct InterrogatorParams {
  std::string network;
  double range_max_m = 1000;
  double source_level_dB = 185;
  double frequency_Hz = 26000;
  double bandwidth_Hz = 1000;
  double ping_s = 0.01;
  sim::ReceiverConfig receiver = receiver_of_tones();
  void read(sim::ParamReader& in);
};

/// Interrogator: pings the transponders of a network and receives their answers, which may overlap on their different
/// frequencies.
class Interrogator final : public sim::AcousticListener {
 public:
  /// Answer of one transponder.
  struct Answer {
    std::string transponder;  ///< vehicle/device
    sim::Time started{0};     ///< start of the reception
    double two_way_s = 0;     ///< two-way travel time, without the turnaround
    double distance_m = 0;    ///< truth: mean of the path lengths of ping and answer
    sim::Vector3d p_ST_S =
        sim::Vector3d::Zero();  ///< position of the transponder at its answer, in the sensor frame S at `started`
    sim::Vector3d apparent_S = sim::Vector3d::Zero();  ///< the same, where it appears by the direction of the sound
    double snr = 0;                                    ///< signal over noise and other sounds, a ratio of powers
    double frequency_Hz = 0, time_bandwidth = 1;       ///< of the answer
    void visit_state(sim::StateArchive& archive) {
      archive(transponder, started, two_way_s, distance_m, p_ST_S);
      // Not hashed, since they follow from the same places and signal.
      archive.unhashed(apparent_S, snr, frequency_Hz, time_bandwidth);
    }
  };

  Interrogator(const InterrogatorParams& params, const sim::DeviceContext& context);
  void change(const InterrogatorParams& params);
  /// Sends a ping at `at`, the end of a step, to all present members of the network.  Answers to an earlier ping are
  /// then ignored.
  void ping(sim::Time at);
  /// Returns whether all interrogated transponders have answered, or none in range can still answer.
  bool done(sim::Time now) const { return waiting_for_.empty() || now >= window_end_; }
  /// Returns the names of all interrogated transponders.
  const std::vector<std::string>& requested() const { return requested_; }
  /// Returns the answers since the last call, in the order of arrival.
  std::vector<Answer> take_answers();
  /// Visits the state except the transducer, which the acoustic channel visits.
  void visit_state(sim::StateArchive& archive);

  bool listens_to(const sim::Signal& signal) const override;
  void receive(const sim::Reception& received) override;
  bool wants_undetected() const override { return false; }

 private:
  sim::Matrix3d R_WS(sim::Time at) const;

  InterrogatorParams params_;
  sim::DeviceContext context_;
  const TransponderNetwork& network_;
  sim::Transducer transducer_;
  std::int64_t number_ = 0;  // of the last ping
  sim::Time pinged_{0}, window_end_{0};
  std::vector<std::string> requested_, waiting_for_;
  std::vector<Answer> answers_;
};

}  // namespace devices
