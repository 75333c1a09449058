// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// Within the process, and keeps all that is published.
class TapBus final : public sim::Bus {
 public:
  struct Sent {
    std::string channel;
    sim::Bytes payload;
    bool operator==(const Sent&) const = default;
  };

  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override {
    sent_.push_back({std::string(channel), sim::Bytes(payload.begin(), payload.end())});
    bus_.publish(channel, payload, at);
  }
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override {
    return bus_.open_mailbox(channel, capacity);
  }
  sim::BusCounts counts() const override { return bus_.counts(); }
  /// Since the last call, in order.
  std::vector<Sent> take() { return std::exchange(sent_, {}); }

 private:
  sim::InProcessBus bus_;
  std::vector<Sent> sent_;
};

struct TappedWorld {
  explicit TappedWorld(sim::LoadedWorld from) : loaded(std::move(from)), world(loaded.config, bus) {}
  explicit TappedWorld(const std::string& yaml)
      : TappedWorld(sim::load_world_text(yaml, "worlds/test.yaml", LoadedTestWorld::with_messages({}))) {}

  template <typename Message>
  void send(const std::string& channel, const Message& message) {
    bus.publish(channel, shoal::encode(message), world.now());
  }

  sim::LoadedWorld loaded;
  TapBus bus;
  sim::World world;
};

/// A world that is saved on its way, and what it did.
class SavedRun {
 public:
  using Load = std::function<sim::LoadedWorld()>;
  /// What comes from outside before a step of this number, counted from 0.
  using Delivery = std::function<void(TappedWorld&, int step)>;

  explicit SavedRun(Load load, Delivery inputs = {}) : load_(std::move(load)), messages_(std::move(inputs)) {}
  /// A world from YAML text.
  explicit SavedRun(const std::string& yaml, Delivery inputs = {})
      : SavedRun([yaml] { return sim::load_world_text(yaml, "worlds/test.yaml", LoadedTestWorld::with_messages({})); },
                 std::move(inputs)) {}

  /// Saves the world after each number of steps in `at`.  A fresh world that each is restored in, and one that has gone
  /// elsewhere, must publish the same for `more` steps, byte for byte, and must be in the same state then.
  void expect_restored_worlds_go_on_alike(const std::vector<int>& at, int more) {
    TappedWorld original(load_());
    std::map<int, sim::Bytes> snapshots;
    std::map<int, std::vector<sim::PartHash>> ends;
    std::vector<std::vector<TapBus::Sent>> sent;
    const int last = *std::max_element(at.begin(), at.end()) + more;
    for (int step = 0; step <= last; ++step) {
      if (std::find(at.begin(), at.end(), step) != at.end()) snapshots[step] = original.world.state().snapshot();
      if (std::find(at.begin(), at.end(), step - more) != at.end()) ends[step] = original.world.state().part_hashes();
      sent.push_back(run_step(original, step));
    }
    EXPECT_EQ(original.world.counts().bad_messages, 0u);
    for (const int step : at) {
      const auto first = sent.begin() + step;
      EXPECT_FALSE(std::all_of(first, first + more, [](const auto& all) { return all.empty(); }))
          << "nothing to compare";
      TappedWorld fresh(load_());
      for (TappedWorld* world : {&fresh, &original}) {
        SCOPED_TRACE("saved after " + std::to_string(step) + " steps, restored in " +
                     (world == &fresh ? "a fresh world" : "the world that continued"));
        world->world.state().restore(snapshots[step]);
        EXPECT_EQ(world->world.state().snapshot(), snapshots[step]);
        if (!goes_on_alike(*world, step, more, sent)) continue;
        EXPECT_EQ(names_of_differing(world->world.state().part_hashes(), ends[step + more]), "");
      }
    }
  }

 private:
  std::vector<TapBus::Sent> run_step(TappedWorld& world, int step) const {
    if (messages_) messages_(world, step);
    world.world.step();
    return world.bus.take();
  }

  bool goes_on_alike(TappedWorld& world, int from, int more, const std::vector<std::vector<TapBus::Sent>>& sent) const {
    world.bus.take();
    for (int step = from; step < from + more; ++step) {
      const auto now = run_step(world, step);
      const auto& then = sent[static_cast<std::size_t>(step)];
      if (now == then) continue;
      const auto differing = std::mismatch(now.begin(), now.end(), then.begin(), then.end());
      ADD_FAILURE() << "in step " << step << ": "
                    << (differing.first == now.end() ? std::string("nothing") : differing.first->channel)
                    << " instead of what was on "
                    << (differing.second == then.end() ? std::string("no channel") : differing.second->channel);
      return false;
    }
    return true;
  }

  static std::string names_of_differing(const std::vector<sim::PartHash>& a, const std::vector<sim::PartHash>& b) {
    if (a.size() != b.size()) return "their number";
    std::string names;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(a[i] == b[i])) names += a[i].part + " ";
    return names;
  }

  Load load_;
  Delivery messages_;
};

}  // namespace test
