// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "verification/bench/bench_scene.hpp"

namespace verification {

/// Sends 32 bytes by the acoustic modem of each vehicle that has one, every 10 s; of N modems number k at k / N of the
/// period, so that messages overlap at the receivers.
class Talkers final : public ScenePrograms {
 public:
  Talkers(const sim::World& world, sim::Bus& bus);
  void think(sim::Time now) override;

 private:
  sim::Bus& bus_;
  std::vector<std::string> channels_;
  sim::Bytes payload_;
  std::int64_t next_ = 0;  ///< number of the next message
};

}  // namespace verification
