// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <string>

#include "sim/acoustics/directivity.hpp"
#include "sim/acoustics/signal.hpp"
#include "sim/acoustics/signal_receiver.hpp"
#include "sim/acoustics/sound_site.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Receiver of the signals of a transducer.
class AcousticListener {
 public:
  virtual ~AcousticListener() = default;
  /// Tries to understand it.  What it does not listen to is noise in its band.
  virtual bool listens_to(const Signal& signal) const = 0;
  /// Called when a signal that it receives has ended, decoded or not (not for a transducer without power or out of
  /// the water).  Called at a simulated time within the step that just ended, `received.ended`; the
  /// listener may transmit at that time or later.
  virtual void receive(const Reception& received) = 0;
};

/// The receiver of a transducer.
struct ReceiverConfig {
  double detection_dB = 6;        ///< signal over noise and other sounds that it needs to notice a signal
  double capture_dB = 6;          ///< a signal stronger by this takes it from the one it is taking
  double protection_dB = 6;       ///< over all other messages in its band that one needs while it is taken
  double doppler_limit_mps = 5;   ///< closing or parting speed it follows
  DirectivityConfig directivity;  ///< for sending and receiving; the axis is x of the device
  void read(ParamReader& in);
};

/// Point where sound enters and leaves the water.  Owned by a device; in the channel while it exists, which hashes and
/// saves its state: the device does not visit it.
class Transducer {
 public:
  /// Messages: what it sent, and what became of those that were for it.
  struct Counts {
    std::int64_t sent = 0, sent_bytes = 0;
    std::int64_t understood = 0, understood_bytes = 0;
    std::int64_t unsent = 0;  ///< asked for without power, silent by a fault, or out of the water
    std::array<std::int64_t, signal_losses> lost{};  ///< by SignalLoss
    void visit_state(StateArchive& archive) { archive(sent, sent_bytes, understood, understood_bytes, unsent, lost); }
  };

  Transducer(AcousticListener& listener, const ReceiverConfig& config, SoundSite site);
  ~Transducer();
  Transducer(const Transducer&) = delete;
  Transducer& operator=(const Transducer&) = delete;

  /// From `at` on, which is not before now (the start of the step in act(), `Reception::ended` in receive()).  The
  /// caller lets one signal end before the next begins.
  void transmit(Signal signal, Time at);
  /// Cancels queued transmissions that have not started.
  void call_back();
  /// Sets its identity; anonymous before the first call.
  void belong_to(const Audience& own);
  /// It was called: messages may be for this one, as for that of a modem.
  bool has_owner() const { return !own_.group.empty(); }
  /// It sends now, or has something scheduled, until this time.
  Time busy_until() const { return busy_until_; }
  /// It is taking a signal now.
  bool receiving() const { return receiver_.taking(); }
  /// Has power, and no fault keeps it silent.
  bool works() const;

  /// At a time within or near the step that just ended: by its velocity from where it is.
  Vector3d p_W(Time at) const;
  Vector3d v_W() const { return motion().v_W; }
  Matrix3d R_WS() const;
  const std::string& full_name() const { return site_.full_name; }
  /// See SoundSite.
  int group() const { return site_.group; }
  int number() const { return number_; }
  const ReceiverConfig& config() const { return config_; }
  void change(const ReceiverConfig& config);
  /// Directivity index: reduction of isotropic noise: the directivity index.
  Decibels noise_reduction(double frequency_Hz) const;
  Counts counts() const;
  void visit_state(StateArchive& archive) {
    archive(busy_until_, sending_until_, sending_, signals_, receiver_, counts_);
    archive.unhashed(own_, meant_before_, meant_near_);
  }

 private:
  friend class AcousticChannel;

  /// Where it is at the end of the step, and how it moves.
  struct Motion {
    Vector3d p_W, v_W;
    Vector3d drift_W;  // v_W as p_W(Time) has it: the same except for rounding
  };
  const Motion& motion() const;
  bool is_meant_by(const Signal& signal) const {
    return signal.to.group == own_.group && (signal.to.address.empty() || signal.to.address == own_.address);
  }
  /// Messages for it that were sent out of its range.
  std::int64_t out_of_range() const;

  AcousticListener& listener_;
  ReceiverConfig config_;
  const SoundSite site_;
  int number_ = -1;
  std::uint32_t join_ = 0;  // of the joins of all transducers, from 1: others may have had its number before
  Time busy_until_{0};      // of all it was asked to send
  Time sending_until_{0};   // of what it sends or sent last
  int sending_ = -1;        // what it sends, in the channel; -1: nothing
  std::int64_t signals_ = 0;
  SignalReceiver receiver_;
  Counts counts_;  // without those that are out of range
  Audience own_;
  std::int64_t meant_before_ = 0;  // messages for who it is, sent before it was
  std::int64_t meant_near_ = 0;    // since then: those that are or were in flight to it, and its own
  // The directivity index of a frequency, computed before; NaN: none.
  mutable double index_of_Hz_ = std::numeric_limits<double>::quiet_NaN();
  mutable Decibels index_;
  mutable Motion motion_;
  mutable std::int64_t motion_of_ = -1;  // AcousticChannel::look() that it is of
};

/// A sound that continues and on: an engine, a pile driver, a jammer.  Owned by a device; in the channel while it
/// exists, which hashes and saves its state: the device does not visit it.
class ContinuousSound {
 public:
  /// Even over its band.
  ContinuousSound(Decibels source_level, double centre_Hz, double bandwidth_Hz, SoundSite site);
  ~ContinuousSound();
  ContinuousSound(const ContinuousSound&) = delete;
  ContinuousSound& operator=(const ContinuousSound&) = delete;

  /// On at first.  Silent as well without power, by a fault and out of the water.
  void set_on(bool on);
  bool on() const { return on_; }
  /// Re 1 uPa at 1 m, over its band.
  void set_level(Decibels source_level);
  void visit_state(StateArchive& archive) { archive(on_, source_level_); }

 private:
  friend class AcousticChannel;

  const SoundSite site_;
  Decibels source_level_;
  double centre_Hz_, bandwidth_Hz_;
  bool on_ = true;
};

}  // namespace sim
