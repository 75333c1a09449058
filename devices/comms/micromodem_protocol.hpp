// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/comms/micromodem_packet.hpp"
#include "devices/comms/micromodem_rates.hpp"
#include "devices/comms/micromodem_settings.hpp"
#include "sim/base/time.hpp"
#include "sim/nmea/nmea.hpp"

namespace devices {

/// Error numbers of $CAERR; the names are Shoal's.
inline constexpr int unknown_sentence = 1, bad_field = 3, is_busy = 4, too_long_data = 5, no_request = 6;

inline constexpr int micromodem_broadcast = 127;
inline constexpr int micromodem_beacons = 4;
inline constexpr int max_beacon_ms = 60000;
/// First firmware of a Micro-Modem-2, and first firmware whose clock mode is a bit field.
inline constexpr std::array<int, 3> micromodem_2{2, 0, 0}, micromodem_clock_bits{2, 0, 26038};
/// Turnaround time from the start of a ping to the start of its answer, s; the interrogator subtracts it.
inline constexpr double micromodem_turnaround_s = 1;

/// Interface of the protocol of a Micro-Modem to the modem.
class MicromodemSide {
 public:
  struct Sound {
    sim::Time begin{0}, end{0};
  };
  virtual ~MicromodemSide() = default;
  /// Sends a sentence to the host.  `body`: sentence without `$` and checksum.
  virtual void emit(const std::string& body) = 0;
  /// Transmits a packet at `at`, or as soon afterwards as present transmissions have ended; with `on_the_second` at a
  /// whole second of the clock.
  virtual Sound transmit(const MicromodemPacket& packet, sim::Time at, bool on_the_second) = 0;
  /// Interrogates the transponders.
  virtual Sound interrogate_beacons(sim::Time at, bool on_the_second) = 0;
  /// Cancels transmissions that have not started.  Returns the end of the transmission in progress.
  virtual sim::Time cancel_pending() = 0;
  /// Returns the time by the vehicle clock: microseconds since 1970 in UTC.
  virtual std::int64_t utc_us(sim::Time at) const = 0;
  /// Returns the interval between two times, s, measured by a counter at the rate of that clock and unaffected by steps
  /// of the clock.
  virtual double elapsed_s(sim::Time from, sim::Time to) const = 0;
};

/// Reception of a packet.
struct MicromodemArrival {
  sim::Time started{0}, ended{0};
  double level_dB = 0, snr_dB = 0, closing_mps = 0;
  double noise_dB = 0;
  bool good = true;  ///< false: it was detected, but not decoded
};

/// Operations in progress.  Defined outside of the class that uses them, because clang rejects an optional of an
/// incomplete class.
struct MicromodemPending {
  /// Cycle whose data are gathered from the host.
  struct Cycle {
    int source = 0, destination = 0, rate = 0, frames = 0;
    bool ack = false;
    bool announced = false;  ///< another modem sent the cycle init
    std::vector<MicromodemPacket::Frame> gathered;
    sim::Time deadline{0};
    void visit_state(sim::StateArchive& archive);
  };
  /// Cycle whose data are expected.
  struct Expected {
    int source = 0, destination = 0, rate = 0, frames = 0;
    sim::Time deadline{0};
    void visit_state(sim::StateArchive& archive) { archive(source, destination, rate, frames, deadline); }
  };
  /// Ping whose answer is expected.
  struct Ping {
    int destination = 0;
    sim::Time sent{0}, deadline{0};
    void visit_state(sim::StateArchive& archive) { archive(destination, sent, deadline); }
  };
  struct BeaconPing {
    sim::Time sent{0}, deadline{0};
    double turnaround_s = 0;
    std::array<bool, micromodem_beacons> is_requested{};
    std::array<std::optional<sim::Time>, micromodem_beacons> answered{};
    void visit_state(sim::StateArchive& archive) { archive(sent, deadline, turnaround_s, is_requested, answered); }
  };
  /// Time to which the clock is set at the next whole second of the vehicle clock.
  struct PulseTime {
    std::int64_t second = 0;  ///< second of the vehicle clock at the request of the host
    std::int64_t set_us = 0;
    void visit_state(sim::StateArchive& archive) { archive(second, set_us); }
  };
  struct Due {
    sim::Time at;
    std::string body;
    void visit_state(sim::StateArchive& archive) { archive(at, body); }
  };
};

/// Protocol of a Micro-Modem: sentences and packets in, sentences and packets out, no physics.
class MicromodemProtocol : private MicromodemPending {
 public:
  struct Config {
    int address = 0;
    bool psk = true;           ///< has the co-processor for rates 1 to 6
    bool synchronous = false;  ///< SNV is on at the start, and the clock is set
    std::string revision = "0.93.0.48";
    double frequency_Hz = 25000;
    double beacon_turnaround_s = 0.02;
  };

  MicromodemProtocol(const Config& config, MicromodemSide& side);

  /// Handles a line from the host, with any content.
  void take_line(const sim::NmeaLines::Line& line, sim::Time now);
  void tick(sim::Time now);
  /// Resets the state, and sends the start-up sentences again at `up`.  Settings are kept; the time set by the host is
  /// not.
  void restart(sim::Time up);
  void receive(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  /// Handles the reply of a transponder, counted from 0.
  void beacon_answered(int beacon, sim::Time started);

  int address() const { return settings_.get("SRC"); }
  const MicromodemSettings& settings() const { return settings_; }
  /// Returns the number of sentences answered with an error.
  std::int64_t errors() const { return errors_; }
  void visit_state(sim::StateArchive& archive);

 private:
  using Command = void (MicromodemProtocol::*)(const sim::NmeaSentence&, sim::Time);

  // micromodem_commands.cpp
  void configure(const sim::NmeaSentence& in, sim::Time now);
  void query(const sim::NmeaSentence& in, sim::Time now);
  void reset(const sim::NmeaSentence& in, sim::Time now);
  void start_cycle(const sim::NmeaSentence& in, sim::Time now);
  void take_data(const sim::NmeaSentence& in, sim::Time now);
  void send_ping(const sim::NmeaSentence& in, sim::Time now);
  void send_mini(const sim::NmeaSentence& in, sim::Time now);
  void interrogate_remus_beacons(const sim::NmeaSentence& in, sim::Time now);
  void interrogate_narrowband_beacons(const sim::NmeaSentence& in, sim::Time now);
  void interrogate_generic_beacons(const sim::NmeaSentence& in, sim::Time now);
  void interrogate_beacons(const sim::NmeaSentence& in, bool good, std::optional<int> timeout_ms, BeaconPing ping,
                           bool on_the_second, sim::Time now);
  /// Returns the handler of a sentence; null when this modem does not support it.
  Command command_of(const std::string& name) const;
  /// Returns the fields of the sentence under another name.
  static std::string echo(const sim::NmeaSentence& in, const std::string& name);

  // micromodem_clock.cpp
  void set_clock(const sim::NmeaSentence& in, sim::Time now);
  void set_time(const sim::NmeaSentence& in, sim::Time now);
  void query_time(const sim::NmeaSentence& in, sim::Time now);
  /// Sets the time of the clock, requested by the host.
  void set_utc(std::int64_t set_us, sim::Time now);
  /// Checks whether a whole second of the vehicle clock has begun since the last call.
  void detect_pulse(sim::Time now);
  /// Returns the clock mode of $CACST and $CAXST: 0 to 3; bit 1: packets are aligned to the second of the vehicle
  /// clock; bit 0: the time was set.  From firmware 2.0.26038 on: bits 0 and 1 give the source of the time, bits 2 to 4
  /// that of the pulse.
  int clock_mode() const;

  /// Returns whether a restart is pending.
  bool is_down(sim::Time now) const { return starting_ && now < next_revision_; }
  void emit_later(sim::Time at, std::string body);
  void error(const std::string& module, int number, const std::string& text, sim::Time now);
  /// Returns whether the modem is busy, and reports an error then.
  bool busy(const char* module, sim::Time now);
  /// Returns source and destination; reports an error and returns std::nullopt if they are invalid.
  std::optional<std::pair<int, int>> addresses(const sim::NmeaSentence& in, std::size_t first, sim::Time now);

  void gather(Cycle cycle, sim::Time now);
  void request_frame(sim::Time now);
  void send_cycle(sim::Time now);
  /// Transmits a packet, and reports start and end to the host.
  MicromodemSide::Sound send(const MicromodemPacket& packet, sim::Time at, bool on_the_second);
  void report_beacons(sim::Time now);

  void received_cycle(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void received_data(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void received_ping(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void received_reply(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void emit_statistics(const MicromodemPacket& packet, const MicromodemArrival& arrival, int bad_frames);

  /// Returns the time of the clock of the modem, which the host may have set.
  std::int64_t utc_us(sim::Time at) const { return side_.utc_us(at) + clock_offset_us_; }
  std::string time_of_day(sim::Time at, int digits = 0) const;

  Config config_;
  std::array<int, 3> generation_;  // of the firmware
  MicromodemSide& side_;
  MicromodemSettings settings_;
  std::int64_t clock_offset_us_ = 0;
  bool clock_set_ = false;
  std::optional<PulseTime> pulse_time_;
  std::vector<Due> due_;
  sim::Time sending_until_{0};
  sim::Time next_revision_{0};
  bool starting_ = true;  // it sends INIT then
  std::optional<Cycle> cycle_;
  std::optional<Expected> expected_;
  std::optional<Ping> ping_;
  std::optional<BeaconPing> beacon_ping_;
  std::int64_t errors_ = 0;
};

/// Returns major, minor and patch of `2.0.26038`; the first three numbers of `0.93.0.48`; 0 for a part that is not a
/// number.
std::array<int, 3> micromodem_generation(const std::string& revision);
/// Returns the UTC time of day as hhmmss, with `digits` > 0 followed by a point and the truncated decimals of the
/// second.
std::string nmea_time_of_day(std::int64_t utc_us, int digits);
/// Returns the UTC date as yyyymmdd.
std::string nmea_date(std::int64_t utc_us);

}  // namespace devices
