// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/common/serial_port.hpp"
#include "devices/comms/message_modem.hpp"
#include "devices/sound_positioning/signal_carrier.hpp"
#include "sim/acoustics/propagation/signal.hpp"
#include "sim/base/time.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Radio modem: transmits byte messages between vehicles.  It sends one message at a time, for a duration of size /
/// data rate.  The message arrives after the propagation delay, distance / propagation speed, at every modem of the
/// same network that was in range when the transmission started, with both ends in the medium of the signal. (`through:
/// acoustic` gives a simple acoustic modem without noise, collisions and Doppler; see acoustic_modem.)
class Modem final : public sim::Sensor, public MessageModem {
 public:
  static constexpr const char* meaning = "Radio or acoustic modem: messages of bytes between vehicles.";
  struct Params {
    std::string network = "radio";
    SignalCarrier through = SignalCarrier::radio;
    double range_m = 100;
    double data_rate_bps = 9600;
    std::optional<double> propagation_mps;  ///< unset: speed of light, or speed of sound at the sender
    double loss_probability = 0;
    bool line_of_sight = false;
    int queue_messages = 16;
    int max_message_bytes = 1024;
    std::optional<SerialMessageParams> serial;
    void read(sim::ParamReader& in);
  };
  /// Counts of sent messages, and of the delivery of messages of its network addressed to it or broadcast.
  struct Counts {
    std::int64_t sent = 0, sent_bytes = 0, received = 0;
    /// By SignalLoss: `range` out of range, `noise` in a zone without radio, `blocked` by obstacles or by an antenna
    /// where the signal does not propagate, `link` by `loss_probability`.
    std::array<std::int64_t, sim::signal_losses> lost{};
    void visit_state(sim::StateArchive& archive) { archive(sent, sent_bytes, received, lost); }
  };
  struct Packet {
    std::string source, destination;
    sim::Time sent{0}, arrived{0};
    sim::Time sent_reading{0};  ///< transmission time by the clock of the sender
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(source, destination, sent, arrived, sent_reading, data); }
  };

  Modem(const Params& params, const sim::DeviceContext& context);
  ~Modem() override;

  /// Queues a message; when the queue is full the oldest is dropped and counted.  Empty destination: broadcast.
  /// Throws std::runtime_error when the message is empty or too long, or the destination has no modem here.
  void send(sim::Time now, std::string destination, sim::Bytes data) override;
  std::size_t message_limit_bytes() const override { return static_cast<std::size_t>(params_.max_message_bytes); }
  /// Starts the next transmission when the last one has ended.
  void act(const sim::ActContext& context);

  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  void arrive(sim::Time at, std::span<const std::byte> payload) override;
  void visit_state(sim::StateArchive& archive) override;

  /// Returns the messages that arrived since the last sample.
  const std::vector<Packet>& received() const { return received_; }
  std::int64_t dropped_from_queue() const override { return dropped_; }
  const Counts& counts() const { return counts_; }
  const std::string& vehicle_name() const { return vehicle_; }
  const std::string& full_name() const { return full_name_; }

 private:
  struct Outgoing {
    std::string destination;
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(destination, data); }
  };
  class Network;
  static const sim::SharedKind<Network> network_of_world;

  void transmit(sim::Time now, const Outgoing& message);
  double propagation_mps() const;
  /// Returns why a message is not delivered to a modem that it is addressed to; none when it is delivered.
  sim::SignalLoss loss_to(const Modem& receiver) const;
  bool lost_in_transit_to(const Modem& receiver) const;
  /// Returns whether an obstacle is between the two antennas; the hulls of the two vehicles are ignored.
  bool hidden_from(const Modem& receiver) const;
  sim::Vector3d p_WS() const;
  void read_serial(sim::Time now);

  Params params_;
  const sim::World& world_;
  sim::DeviceHost& host_;
  Network& network_;
  std::string vehicle_;
  const sim::VehicleClock& clock_;
  std::string full_name_;
  std::uint64_t seed_;
  int device_;
  int group_;
  const sim::Body& body_;
  sim::Vector3d p_BS_;
  std::deque<Outgoing> queue_;
  sim::Time busy_until_{0};
  std::int64_t sent_ = 0;
  std::int64_t dropped_ = 0;
  Counts counts_;
  std::vector<Packet> arrived_, received_;
  std::unique_ptr<SerialMessages> serial_;
};

/// Publishes one shoal.modem_received_t for each message that arrived.
class ModemReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.modem_received_t";
  explicit ModemReporter(const Modem& modem) : modem_(modem) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Modem& modem_;
};

/// Receives shoal.modem_send_t.
class ModemController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.modem_send_t";
  explicit ModemController(Modem& modem) : modem_(modem) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  Modem& modem_;
};

/// Returns the first true time, not before `from`, at which the vehicle clock shows a whole multiple of `period` (in
/// UTC, including the epoch of the run).
inline sim::Time next_whole(const sim::Vehicle& vehicle, std::int64_t epoch_us, sim::Time from, sim::Time period) {
  // Use the clock error, not the reading: the resolution of the clock may be coarser than the period.
  const std::int64_t utc_us = epoch_us + (from + sim::from_seconds(vehicle.clock().error_s(from))).count();
  std::int64_t over_us = utc_us % period.count();
  if (over_us < 0) over_us += period.count();
  if (over_us == 0) return from;
  const sim::Time at = vehicle.clock().true_time(sim::Time{utc_us + period.count() - over_us - epoch_us});
  return at < from ? from : at;
}

}  // namespace devices
