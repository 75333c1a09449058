// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/director/world_observer.hpp"
#include "sim/world/world.hpp"
#include "viewer/film/overlay.hpp"

namespace viewer {

/// Observer that gives the sounds of a world to an overlay.
class PingObserver final : public sim::WorldObserver {
 public:
  /// Observes while it exists.  Both must outlive it.
  PingObserver(sim::World& world, Overlay& overlay) : world_(world), overlay_(overlay) { world_.set_observer(this); }
  ~PingObserver() override { world_.set_observer(nullptr); }
  PingObserver(const PingObserver&) = delete;
  PingObserver& operator=(const PingObserver&) = delete;

  void sound_sent(const sim::SoundSent& sent) override {
    overlay_.add({sent.p_W, sim::to_seconds(sent.sent), sim::to_seconds(sent.signal.duration), sent.sound_speed_mps});
  }
  void sound_arrived(const sim::SoundArrived&) override {}
  void happened(const sim::Occurrence&) override {}

 private:
  sim::World& world_;
  Overlay& overlay_;
};

}  // namespace viewer
