// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/common/nmea.hpp"
#include "devices/comms/micromodem_packet.hpp"
#include "devices/comms/micromodem_rates.hpp"
#include "devices/comms/micromodem_settings.hpp"
#include "sim/base/time.hpp"

namespace devices {

/// Numbers of $CAERR; the words are ours.
inline constexpr int unknown_sentence = 1, bad_field = 3, is_busy = 4, too_long_data = 5, no_request = 6;

inline constexpr int micromodem_broadcast = 127;
inline constexpr int micromodem_beacons = 4;
inline constexpr int max_beacon_ms = 60000;
/// The first firmware of a Micro-Modem-2, and the first whose clock mode is a bit field.
inline constexpr std::array<int, 3> micromodem_2{2, 0, 0}, micromodem_clock_bits{2, 0, 26038};
/// Time from the start of a ping to the start of its answer, s; the interrogator subtracts it.
inline constexpr double micromodem_turnaround_s = 1;

/// What the protocol of a Micro-Modem needs of the modem around it.
class MicromodemSide {
 public:
  struct Sound {
    sim::Time begin{0}, end{0};
  };
  virtual ~MicromodemSide() = default;
  /// To the host.  `body`: a sentence without `$` and checksum.
  virtual void emit(const std::string& body) = 0;
  /// Sends at `at`, or as soon after it as what it sends already has ended; at a whole second of the clock if asked to.
  virtual Sound transmit(const MicromodemPacket& packet, sim::Time at, bool on_the_second) = 0;
  /// Asks the transponders.
  virtual Sound interrogate_beacons(sim::Time at, bool on_the_second) = 0;
  /// What it was to send and has not begun is not sent.  Until when it continues sending.
  virtual sim::Time call_back() = 0;
  /// By the clock of the vehicle: microseconds since 1970 in UTC.
  virtual std::int64_t utc_us(sim::Time at) const = 0;
  /// Interval between two times by a counter at the rate of that clock, unaffected by its steps, s.
  virtual double elapsed_s(sim::Time from, sim::Time to) const = 0;
};

/// How a packet came.
struct MicromodemArrival {
  sim::Time started{0}, ended{0};
  double level_dB = 0, snr_dB = 0, closing_mps = 0;
  double noise_dB = 0;
  bool good = true;  ///< false: it was noticed, but not understood
};

/// What is in progress.  Outside of the class that uses it: clang rejects an optional of an incomplete class.
struct MicromodemPending {
  /// A cycle whose data it gathers from the host.
  struct Cycle {
    int source = 0, destination = 0, rate = 0, frames = 0;
    bool ack = false;
    bool announced = false;  ///< its cycle init was sent by another
    std::vector<MicromodemPacket::Frame> gathered;
    sim::Time deadline{0};
    void visit_state(sim::StateArchive& archive);
  };
  /// A cycle whose data it expects.
  struct Expected {
    int source = 0, destination = 0, rate = 0, frames = 0;
    sim::Time deadline{0};
    void visit_state(sim::StateArchive& archive) { archive(source, destination, rate, frames, deadline); }
  };
  /// A ping whose answer it expects.
  struct Ping {
    int destination = 0;
    sim::Time sent{0}, deadline{0};
    void visit_state(sim::StateArchive& archive) { archive(destination, sent, deadline); }
  };
  struct BeaconPing {
    sim::Time sent{0}, deadline{0};
    double turnaround_s = 0;
    std::array<bool, micromodem_beacons> desired{};
    std::array<std::optional<sim::Time>, micromodem_beacons> answered{};
    void visit_state(sim::StateArchive& archive) { archive(sent, deadline, turnaround_s, desired, answered); }
  };
  /// A time that the clock is set to when the next second of the vehicle's clock begins.
  struct PulseTime {
    std::int64_t second = 0;  ///< of the vehicle's clock, when the host said so
    std::int64_t set_us = 0;
    void visit_state(sim::StateArchive& archive) { archive(second, set_us); }
  };
  struct Due {
    sim::Time at;
    std::string body;
    void visit_state(sim::StateArchive& archive) { archive(at, body); }
  };
};

/// What a Micro-Modem says and sends: sentences and packets in, sentences and packets out, no physics.
class MicromodemProtocol : private MicromodemPending {
 public:
  struct Config {
    int address = 0;
    bool psk = true;           ///< has the co-processor for rates 1 to 6
    bool synchronous = false;  ///< SNV is on at the start, and the clock is good
    std::string revision = "0.93.0.48";
    double frequency_Hz = 25000;
    double beacon_turnaround_s = 0.02;
  };

  MicromodemProtocol(const Config& config, MicromodemSide& side);

  /// A line from the host, whatever it holds.
  void take_line(const NmeaLines::Line& line, sim::Time now);
  void tick(sim::Time now);
  /// Resets its state, and sends its greeting again at `up`.  Settings stay; the time that the host set does not.
  void restart(sim::Time up);
  void receive(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  /// A transponder (0: the first) answered.
  void beacon_answered(int beacon, sim::Time started);

  int address() const { return settings_.get("SRC"); }
  const MicromodemSettings& settings() const { return settings_; }
  /// Sentences that were answered by an error.
  std::int64_t errors() const { return errors_; }
  void visit_state(sim::StateArchive& archive);

 private:
  using Command = void (MicromodemProtocol::*)(const NmeaSentence&, sim::Time);

  // micromodem_commands.cpp
  void configure(const NmeaSentence& in, sim::Time now);
  void query(const NmeaSentence& in, sim::Time now);
  void reset(const NmeaSentence& in, sim::Time now);
  void start_cycle(const NmeaSentence& in, sim::Time now);
  void take_data(const NmeaSentence& in, sim::Time now);
  void send_ping(const NmeaSentence& in, sim::Time now);
  void send_mini(const NmeaSentence& in, sim::Time now);
  void interrogate_remus_beacons(const NmeaSentence& in, sim::Time now);
  void interrogate_narrowband_beacons(const NmeaSentence& in, sim::Time now);
  void interrogate_generic_beacons(const NmeaSentence& in, sim::Time now);
  void interrogate_beacons(const NmeaSentence& in, bool good, std::optional<int> timeout_ms, BeaconPing ping,
                           bool on_the_second, sim::Time now);
  /// Null: this modem does not know the sentence.
  Command command_of(const std::string& name) const;
  /// The fields of the sentence under another name.
  static std::string echo(const NmeaSentence& in, const std::string& name);

  // micromodem_clock.cpp
  void set_clock(const NmeaSentence& in, sim::Time now);
  void set_time(const NmeaSentence& in, sim::Time now);
  void query_time(const NmeaSentence& in, sim::Time now);
  /// The host set the time of its clock to this.
  void set_utc(std::int64_t set_us, sim::Time now);
  /// A whole second of the vehicle's clock may have begun since.
  void detect_pulse(sim::Time now);
  /// $CACST and $CAXST: 0 to 3, bit 1: packets keep the second of the vehicle's clock; bit 0: the time was set.  From
  /// firmware 2.0.26038 on: bits 0 and 1 give the source of the time, bits 2 to 4 that of the pulse.
  int clock_mode() const;

  /// A restart was requested and is pending.
  bool is_down(sim::Time now) const { return starting_ && now < next_revision_; }
  void emit_later(sim::Time at, std::string body);
  void error(const std::string& module, int number, const std::string& text, sim::Time now);
  /// Says so when it is.
  bool busy(const char* module, sim::Time now);
  /// Says so when they are wrong.
  std::optional<std::pair<int, int>> addresses(const NmeaSentence& in, std::size_t first, sim::Time now);

  void gather(Cycle cycle, sim::Time now);
  void request_frame(sim::Time now);
  void send_cycle(sim::Time now);
  /// Sends, and reports the start and end to the host.
  MicromodemSide::Sound send(const MicromodemPacket& packet, sim::Time at, bool on_the_second);
  void report_beacons(sim::Time now);

  void received_cycle(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void received_data(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void received_ping(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void received_reply(const MicromodemPacket& packet, const MicromodemArrival& arrival);
  void emit_statistics(const MicromodemPacket& packet, const MicromodemArrival& arrival, int bad_frames);

  /// The modem's own clock, which the host may have set.
  std::int64_t utc_us(sim::Time at) const { return side_.utc_us(at) + clock_offset_us_; }
  std::string time_of_day(sim::Time at, int digits = 0) const;

  Config config_;
  std::array<int, 3> generation_;  // of its software
  MicromodemSide& side_;
  MicromodemSettings settings_;
  std::int64_t clock_offset_us_ = 0;
  bool clock_set_ = false;
  std::optional<PulseTime> pulse_time_;
  std::vector<Due> due_;
  sim::Time sending_until_{0};
  sim::Time next_revision_{0};
  bool starting_ = true;  // it will say INIT then
  std::optional<Cycle> cycle_;
  std::optional<Expected> expected_;
  std::optional<Ping> ping_;
  std::optional<BeaconPing> beacon_ping_;
  std::int64_t errors_ = 0;
};

/// Major, minor, patch of `2.0.26038`; of `0.93.0.48` the first three; 0 for what cannot be read.
std::array<int, 3> micromodem_generation(const std::string& revision);
/// Time of day of UTC: hhmmss, and with digits of the second a point and those, cut off.
std::string nmea_time_of_day(std::int64_t utc_us, int digits);
/// yyyymmdd.
std::string nmea_date(std::int64_t utc_us);

}  // namespace devices
