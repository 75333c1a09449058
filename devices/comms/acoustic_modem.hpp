// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/common/serial_port.hpp"
#include "devices/comms/message_modem.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Acoustic modem: transmits byte messages between vehicles under water through world.acoustics().  It is half-duplex
/// and sends one message at a time; medium access control and retransmission are left to the programs that use it.
class AcousticModem final : public sim::Sensor, public MessageModem, private sim::AcousticListener {
 public:
  static constexpr const char* meaning = "Acoustic modem: messages of bytes between vehicles under water.";
  static constexpr const char* fixed_keys[] = {"network", "serial"};
  struct Params {
    std::string preset = "micromodem_rate0";
    std::string network = "acoustic";
    double source_level_dB = 185;
    double frequency_Hz = 25000;
    double bandwidth_Hz = 4000;
    sim::Modulation modulation = sim::Modulation::fsk;
    double bit_rate_bps = 80;
    double coding_gain_dB = 0;
    int frame_bytes = 32;
    int frames = 1;
    bool whole_frames = true;
    int max_message_bytes = 0;
    double preamble_s = 0.3;
    int header_bits = 0;
    int queue_messages = 16;
    double synchronous_s = 0;
    bool listen_before_sending = false;
    bool promiscuous = false;
    double transmit_power_W = 0;
    sim::ReceiverConfig receiver;
    std::optional<SerialMessageParams> serial;
    void read(sim::ParamReader& in);
  };
  struct Packet {
    std::string source, destination;
    sim::Time sent{0}, arrived{0};  ///< start of transmission and of reception; true times
    sim::Time sent_reading{0};      ///< transmission time by the clock of the sender
    sim::Time arrived_reading{0};   ///< arrival time by the own clock
    double snr_dB = 0, level_dB = 0, closing_mps = 0;
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) {
      archive(source, destination, sent, arrived, sent_reading, arrived_reading, snr_dB, level_dB, closing_mps, data);
    }
  };

  AcousticModem(const Params& params, const sim::DeviceContext& context);
  ~AcousticModem() override;
  void change(const Params& params);

  /// Queues a message; when the queue is full the oldest is dropped and counted.  Empty destination: broadcast.
  /// Throws std::runtime_error when the message is empty or too long, or the destination names no vehicle.
  void send(sim::Time now, std::string destination, sim::Bytes data) override;
  std::size_t message_limit_bytes() const override;
  /// Starts the next transmission when it is permitted.
  void act(const sim::ActContext& context);
  double power_W() const;
  /// Returns whether nothing is to be sent, and nothing has arrived since the last sample.
  bool idle() const;

  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;
  std::optional<double> data_rate_bps() const override { return params_.bit_rate_bps; }

  /// Returns the duration of the transmission of a message of this size.
  double duration_s(std::size_t bytes) const;
  /// Returns the messages that arrived since the last sample.
  const std::vector<Packet>& received() const { return received_; }
  const sim::Transducer& transducer() const { return transducer_; }
  std::int64_t dropped_from_queue() const override { return dropped_; }

 private:
  struct Outgoing {
    std::string destination;
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(destination, data); }
  };

  bool listens_to(const sim::Signal& signal) const override;
  void receive(const sim::Reception& received) override;
  bool wants_undetected() const override { return false; }
  void transmit(sim::Time at, Outgoing message);
  /// Returns the number of transmitted bits of a message.
  std::int64_t bits(std::size_t bytes) const;
  void read_serial(sim::Time now);

  Params params_;
  const sim::World& world_;
  sim::DeviceHost& host_;
  const sim::Vehicle& vehicle_;
  sim::Transducer transducer_;
  std::deque<Outgoing> queue_;
  std::int64_t dropped_ = 0;
  std::vector<Packet> arrived_, received_;
  std::unique_ptr<SerialMessages> serial_;
  const std::shared_ptr<std::atomic<bool>> wake_flag_;
};

/// Publishes one shoal.acoustic_received_t for each message that arrived.
class AcousticModemReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.acoustic_received_t";
  explicit AcousticModemReporter(const AcousticModem& modem) : modem_(modem) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const AcousticModem& modem_;
};

/// Receives shoal.modem_send_t.
class AcousticModemController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.modem_send_t";
  explicit AcousticModemController(AcousticModem& modem) : modem_(modem) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  AcousticModem& modem_;
};

}  // namespace devices
