// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>

#include "sim/acoustics/numbered_pool.hpp"
#include "sim/acoustics/propagation/directivity.hpp"
#include "sim/acoustics/propagation/signal.hpp"
#include "sim/acoustics/signal_receiver.hpp"
#include "sim/acoustics/sound_site.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Interface for the device that receives the signals of a transducer.
class AcousticListener {
 public:
  virtual ~AcousticListener() = default;
  /// Whether the device tries to decode a signal.  Other signals are noise in its band.  Called from any thread.
  virtual bool listens_to(const Signal& signal) const = 0;
  /// Called when a signal that it receives has ended, decoded or not (not for a transducer without power or out of the
  /// water).  Called at a simulated time within the step that just ended, `received.ended`; the listener may transmit
  /// at that time or later.
  virtual void receive(const Reception& received) = 0;
  /// Whether receive() is called for signals that the receiver did not lock on to, too.  Without them, threads may
  /// handle what arrives at many receivers.
  virtual bool wants_undetected() const { return true; }
};

/// Configuration of the receiver of a transducer.
struct ReceiverConfig {
  double detection_dB = 6;        ///< minimum ratio to noise and other sounds for detection
  double capture_dB = 6;          ///< a signal stronger by this captures the receiver
  double protection_dB = 6;       ///< ratio to all other messages in its band below which bits are lost
  double doppler_limit_mps = 5;   ///< maximum closing or opening speed
  DirectivityConfig directivity;  ///< for sending and receiving; the axis is x of the device
  void read(ParamReader& in);
};

/// Reference to a transducer that may be removed meanwhile, whereupon its number is used again.
struct TransducerRef {
  int number = -1;                 ///< negative: none
  std::uint32_t registration = 0;  ///< serial number, from 1
  bool operator==(const TransducerRef&) const = default;
};

/// Acoustic transducer: the point at which sound enters and leaves the water.  Owned by a device; registered with the
/// channel, which hashes and saves its state, so that the device does not visit it.
class Transducer {
 public:
  /// Counts of messages sent, and of messages addressed to it by result.
  struct Counts {
    std::int64_t sent = 0, sent_bytes = 0;
    std::int64_t understood = 0, understood_bytes = 0;
    std::int64_t unsent = 0;                         ///< not sent: no power, silenced by a fault, or out of the water
    std::array<std::int64_t, signal_losses> lost{};  ///< by SignalLoss
    void visit_state(StateArchive& archive) {
      archive(sent, sent_bytes, understood, understood_bytes, unsent);
      // Without shadows the hash is that of straight lines.
      for (std::int64_t& count : lost) {
        const bool of_shadow = &count == &lost[static_cast<std::size_t>(SignalLoss::shadow)];
        of_shadow&& count == 0 ? archive.unhashed(count) : archive(count);
      }
    }
  };

  Transducer(AcousticListener& listener, const ReceiverConfig& config, SoundSite site);
  ~Transducer();
  Transducer(const Transducer&) = delete;
  Transducer& operator=(const Transducer&) = delete;

  /// Transmits a signal from `at` on, which is not before now (the start of the step in act(), `Reception::ended` in
  /// receive()).  The caller must not let signals overlap.
  void transmit(Signal signal, Time at);
  /// Cancels the transmissions that have not started.
  void cancel_pending();
  /// Sets its address; it has none before the first call.
  void set_address(const Audience& own);
  /// Whether set_address() was called, so that messages can be sent to it, as for a modem.
  bool has_address() const { return !own_.group.empty(); }
  /// End of all present and scheduled transmissions.
  Time busy_until() const { return busy_until_; }
  /// Whether a reception is in progress.
  bool receiving() const { return receiver_.taking(); }
  /// Whether it has power and is not silenced by a fault.
  bool works() const;

  /// Position at a time within or near the step that just ended, extrapolated by its velocity.
  Vector3d p_W(Time at) const;
  Vector3d v_W() const { return motion().v_W; }
  Matrix3d R_WS() const;
  const std::string& full_name() const { return site_.full_name; }
  /// Group whose bodies do not block its sound; see SoundSite.
  int group() const { return site_.group; }
  int number() const { return ref_.number; }
  const TransducerRef& ref() const { return ref_; }
  /// Whether a message is for its address, or for its whole group.
  bool is_addressee_of(const Signal& signal) const {
    return signal.to.group == own_.group && (signal.to.address.empty() || signal.to.address == own_.address);
  }
  const ReceiverConfig& config() const { return config_; }
  void change(const ReceiverConfig& config);
  /// Directivity index: reduction of isotropic noise.
  Decibels noise_reduction(double frequency_Hz) const;
  Counts counts() const;
  void visit_state(StateArchive& archive) {
    archive(busy_until_, transmitting_until_, transmission_, signals_, receiver_, counts_);
    archive.unhashed(own_, addressed_before_, addressed_in_range_);
  }
  /// Adds its content to a hash: see SignalReceiver::add_content().
  void add_content(StateArchive& hash) {
    hash(busy_until_, transmitting_until_, transmission_, signals_, counts_);
    receiver_.add_content(hash);
  }

 private:
  friend class AcousticChannel;
  friend class Receptions;
  friend class Transducers;

  /// Position at the end of the step, and velocity.
  struct Motion {
    Vector3d p_W, v_W;
    Vector3d drift_W;  // velocity used by p_W(Time): equals v_W except for rounding
  };
  const Motion& motion() const;
  /// Number of messages addressed to it that were sent out of its range.
  std::int64_t out_of_range() const;

  AcousticListener& listener_;
  ReceiverConfig config_;
  const SoundSite site_;
  TransducerRef ref_;            // set by Transducers
  Time busy_until_{0};           // of all requested transmissions
  Time transmitting_until_{0};   // end of the present or last transmission
  TransmissionId transmission_;  // the present one
  std::int64_t signals_ = 0;
  SignalReceiver receiver_;
  Counts counts_;  // without messages lost out of range
  Audience own_;
  std::int64_t addressed_before_ = 0;    // messages to its address, sent before it had this address
  std::int64_t addressed_in_range_ = 0;  // since then: messages in flight to it now or before, and its own
  // Cached directivity index of one frequency; NaN: none.
  mutable double index_of_Hz_ = std::numeric_limits<double>::quiet_NaN();
  mutable Decibels index_;
  mutable Motion motion_;
  mutable std::int64_t motion_of_ = -1;  // MotionClock::serial() at which it was computed
};

/// Continuous sound source, such as an engine, a pile driver or a jammer.  Owned by a device; registered with the
/// channel, which hashes and saves its state, so that the device does not visit it.
class ContinuousSound {
 public:
  /// Makes a source with constant spectral density over its band.
  ContinuousSound(Decibels source_level, double centre_Hz, double bandwidth_Hz, SoundSite site);
  ~ContinuousSound();
  ContinuousSound(const ContinuousSound&) = delete;
  ContinuousSound& operator=(const ContinuousSound&) = delete;

  /// Switches the sound; initially on.  It is also silent without power, by a fault and out of the water.
  void set_on(bool on);
  bool on() const { return on_; }
  /// Sets the source level, re 1 uPa at 1 m, over its band.
  void set_level(Decibels source_level);
  void visit_state(StateArchive& archive) { archive(on_, source_level_); }

 private:
  friend class SonarEquation;

  const SoundSite site_;
  Decibels source_level_;
  double center_Hz_, bandwidth_Hz_;
  bool on_ = true;
};

}  // namespace sim
