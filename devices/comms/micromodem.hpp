// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/common/serial_port.hpp"
#include "devices/comms/micromodem_protocol.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Parameters of the transponders interrogated by $CCPDT, $CCPNT and $CCPGT.
struct MicromodemBeaconParams {
  std::string network = "usbl";
  std::vector<std::string> transponders;
  double turnaround_s = 0.02;
  double ping_s = 0.005;
  double frequency_Hz = 26000;
  double bandwidth_Hz = 1000;
  void read(sim::ParamReader& in);
};

/// Acoustic modem of the WHOI Micro-Modem class: NMEA sentences through a pseudo-terminal and the bus, packets through
/// the water.  MicromodemProtocol implements the protocol.
class Micromodem final : public sim::Sensor, private sim::AcousticListener, private MicromodemSide {
 public:
  static constexpr const char* meaning = "Acoustic modem of the WHOI Micro-Modem class, with its NMEA sentences.";
  struct Params {
    int address = 0;
    bool psk = true;
    bool synchronous = false;
    std::string network = "micromodem";
    std::string revision = "0.93.0.48";
    double source_level_dB = 185;
    double frequency_Hz = 25000;
    double coding_gain_dB = 0;
    double transmit_power_W = 0;
    sim::ReceiverConfig receiver;
    std::optional<MicromodemBeaconParams> lbl;
    std::optional<SerialParams> serial;
    void read(sim::ParamReader& in);
  };
  struct Sentence {
    sim::Time at;       ///< true time
    sim::Time reading;  ///< time by the vehicle clock
    std::string sentence;
    void visit_state(sim::StateArchive& archive) { archive(at, reading, sentence); }
  };

  /// Throws ConfigError when the world has no water, or `lbl` names no transponder of the world.
  Micromodem(const Params& params, const sim::DeviceContext& context);
  ~Micromodem() override;

  /// Receives a sentence from the host over the bus; a line end is not required.
  void take(const std::string& sentence, sim::Time now);
  void act(const sim::ActContext& context);
  double power_W() const;

  void measure(const sim::SenseContext& context) override;
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;

  /// Returns the sentences sent to the host since the last sample.
  const std::vector<Sentence>& sentences() const { return sentences_; }
  const MicromodemProtocol& protocol() const { return protocol_; }
  const sim::Transducer& transducer() const { return transducer_; }

 private:
  struct Addresses;
  static const sim::SharedKind<Addresses> addresses_of_world;
  static constexpr std::size_t max_sentences = 4096;  // between two samples

  void check_beacons(const sim::DeviceContext& context) const;
  void warn_of_address() const;
  /// Registers an address in the world.
  void list(int address);
  void unlist();
  bool listens_to(const sim::Signal& signal) const override;
  void receive(const sim::Reception& received) override;
  void received_beacon(const sim::Reception& received);
  void emit(const std::string& body) override;
  Sound transmit(const MicromodemPacket& packet, sim::Time at, bool on_the_second) override;
  Sound interrogate_beacons(sim::Time at, bool on_the_second) override;
  sim::Time cancel_pending() override;
  std::int64_t utc_us(sim::Time at) const override;
  double elapsed_s(sim::Time from, sim::Time to) const override;
  /// Applies an address that the host may have changed.
  void take_address();
  void take_line(const sim::NmeaLines::Line& line, sim::Time now);
  std::string group() const { return "micromodem " + params_.network; }
  Sound send(sim::Signal signal, sim::Time at, bool on_the_second);

  Params params_;
  const sim::World& world_;
  const sim::Vehicle& vehicle_;
  std::int64_t epoch_us_;
  Addresses& addresses_;
  sim::Transducer transducer_;
  MicromodemProtocol protocol_;
  sim::NmeaLines lines_;
  std::deque<Sentence> saying_;
  std::vector<Sentence> sentences_;
  std::unique_ptr<SerialPort> serial_;
  sim::Time now_{0};
  int address_ = -1;  // registered address; -1: none yet
  bool off_ = false;  // without power, or silent by a fault
};

/// Publishes one shoal.nmea_sentence_t for each sentence to the host.
class MicromodemReporter final : public sim::Reporter {
 public:
  static constexpr const char* report_message = "shoal.nmea_sentence_t";
  explicit MicromodemReporter(const Micromodem& modem) : modem_(modem) {}
  void report(sim::Time sampled_at, sim::Publisher& out) const override;

 private:
  const Micromodem& modem_;
};

/// Receives shoal.nmea_sentence_t.
class MicromodemController final : public sim::Controller {
 public:
  static constexpr const char* command_messages = "shoal.nmea_sentence_t";
  explicit MicromodemController(Micromodem& modem) : modem_(modem) {}
  void receive(sim::Time now, std::span<const std::byte> payload) override;

 private:
  Micromodem& modem_;
};

}  // namespace devices
