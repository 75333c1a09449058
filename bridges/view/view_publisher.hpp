// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bridges/view/scene_assets.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_current_t.hpp"
#include "shoal/sim_event_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/sim_scores_t.hpp"
#include "shoal/sim_sound_arrival_t.hpp"
#include "shoal/sim_sound_t.hpp"
#include "sim/bus/bus.hpp"
#include "sim/director/world_observer.hpp"
#include "sim/world/world.hpp"

namespace bridges {

/// Publishes on the bus what viewers need: the scene with its assets, the poses of all bodies, sounds with their
/// outcomes, occurrences and scores (`view:` of the world).  Results of a run do not depend on it.
class ViewPublisher final : public sim::WorldObserver {
 public:
  /// Fills in figures and rules.
  using FillScores = std::function<void(shoal::sim_scores_t&)>;
  /// Bodies above this number lower the rate of `sim.bodies` in proportion, so that the cost is bounded.
  static constexpr std::size_t max_bodies_at_full_rate = 2000;
  /// The scene comes again after this time, for viewers and loggers that start later, and a large one after a longer
  /// time: with its assets it takes this many bytes per simulated second on average.
  static constexpr sim::Time repeat_interval{10'000'000};
  static constexpr double repeated_bytes_per_s = 2000;
  /// Maximum number of messages of one kind in a step; further ones are left out and counted.
  static constexpr std::size_t max_per_step = 1000;

  /// `is_observed`: returns whether a subscriber or a record may exist; while it returns false nothing is made.  All
  /// must outlive this, which observes the world until its end.
  ViewPublisher(sim::Bus& bus, sim::World& world, FillScores fill_scores, std::function<bool()> is_observed);
  ~ViewPublisher() override;
  ViewPublisher(const ViewPublisher&) = delete;
  ViewPublisher& operator=(const ViewPublisher&) = delete;

  /// Publishes what is due after the present step.
  void after_step();
  /// Publishes the scene and its assets again with the next step, for a viewer that starts later.
  void request_scene() { scene_requested_ = true; }
  /// Sets the branch of the run, after a rewind.
  void set_branch(std::int32_t branch) {
    branch_ = branch;
    scene_is_old_ = true;  // fixed objects may be elsewhere
  }
  /// Discards what was observed while a part of the run was computed again.
  void discard();
  /// Returns the revision of the scene to which the movable bodies belong.
  std::int32_t revision() const { return revision_; }
  /// Calls `use` with the pose of each movable body, in the order of the scene.
  template <typename Use>
  void for_each_movable(Use&& use) const {
    for (const Movable& each : movables_) use(each.body->X_WB());
  }
  /// Returns the poses of all movable bodies at the present step.
  shoal::sim_bodies_t bodies() const;
  /// Returns how many messages were left out because a step had too many.
  std::int64_t left_out() const { return left_out_; }

  void sound_sent(const sim::SoundSent& sent) override;
  void sound_arrived(const sim::SoundArrived& arrived) override;
  void happened(const sim::Occurrence& occurrence) override;

 private:
  /// Body that can move, with its number in the scene.
  struct Movable {
    const sim::Body* body;
    std::int32_t number;
  };

  void update_structure();
  void publish_scene();
  void repeat_scene();
  void publish_stamped_scene();
  bool repeat_is_due() const;
  void publish_bodies();
  void fill_in_bodies(shoal::sim_bodies_t& bodies) const;
  void publish_current();
  void publish_scores();
  bool due(double rate_hz) const;
  bool scores_are_due();
  std::int64_t utime(sim::Time at) const { return world_.epoch_us() + at.count(); }
  template <typename Message>
  void publish(const char* channel, const Message& message);
  template <typename Message>
  void publish_all(const char* channel, std::vector<Message>& messages);
  template <typename Message>
  Message* add(bool enabled, std::vector<Message>& messages);

  sim::Bus& bus_;
  sim::World& world_;
  const FillScores fill_scores_;
  const std::function<bool()> is_observed_;
  SceneAssets assets_;
  std::set<std::string> published_assets_;
  std::int32_t branch_ = 0;
  std::int32_t revision_ = 0;
  std::uint64_t generation_ = 0;  // of the world at revision_
  bool scene_is_old_ = false;     // since the last revision no scene was published
  bool scene_requested_ = false;
  sim::Time scene_time_{0};                   // of the last scene
  shoal::sim_scene_t scene_{};                // the last one
  sim::Time repeated_{0};                     // when it came last
  sim::Time repeat_after_ = repeat_interval;  // by its size
  sim::Time next_scores_{0};
  std::vector<Movable> movables_;  // at revision_
  std::vector<shoal::sim_sound_t> sounds_;
  std::vector<shoal::sim_sound_arrival_t> arrivals_;
  std::vector<shoal::sim_event_t> events_;
  shoal::sim_bodies_t bodies_{};
  shoal::sim_current_t current_{};
  shoal::sim_scores_t scores_{};
  std::int64_t left_out_ = 0;
  sim::Bytes buffer_;
};

}  // namespace bridges
