// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/sound_positioning/acoustic_positioning.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Keys of a device that asks transponders.
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

/// Pings the transponders of a network and listens for their answers, which may come side by side on their frequencies.
class Interrogator final : public sim::AcousticListener {
 public:
  /// What came back from one transponder.
  struct Answer {
    std::string transponder;                       ///< vehicle/device
    sim::Time started{0};                          ///< when it came
    double two_way_s = 0;                          ///< of the sound there and back, without the turnaround
    double distance_m = 0;                         ///< the mean of the ways there and back: the truth
    sim::Vector3d p_ST_S = sim::Vector3d::Zero();  ///< where it answered, from where and how the sensor was at `begun`
    void visit_state(sim::StateArchive& archive) { archive(transponder, started, two_way_s, distance_m, p_ST_S); }
  };

  Interrogator(const InterrogatorParams& params, const sim::DeviceContext& context);
  void change(const InterrogatorParams& params);
  /// Sends a ping at `at`, the end of a step, to all that are in the network now.  Answers to an earlier one no longer
  /// count.
  void ping(sim::Time at);
  /// Whether all interrogated transponders have answered, or none in range can still answer.
  bool done(sim::Time now) const { return waiting_for_.empty() || now >= window_end_; }
  /// Names of all that were asked.
  const std::vector<std::string>& requested() const { return requested_; }
  /// What came since the last call, in the order of its arrival.
  std::vector<Answer> take_answers();
  /// All but its transducer, which the acoustic channel knows.
  void visit_state(sim::StateArchive& archive);

  bool listens_to(const sim::Signal& signal) const override;
  void receive(const sim::Reception& received) override;

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
