// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "viewer/log/log_index.hpp"
#include "viewer/log/state_frame.hpp"

namespace viewer {

/// Reader of the poses of a log at any time, with the names of the bodies.
class LogPoses {
 public:
  struct Poses {
    std::int64_t time_us = 0;
    const std::vector<std::string>* names = nullptr;  ///< of the bodies, by the scene of this time
    shoal::sim_bodies_t message{};
    std::span<const std::byte> bodies;  ///< as in StateFrame::bodies()
  };

  /// `index` is that of the file and must outlive this.  Throws BusError.
  LogPoses(const std::string& path, const LogIndex& index) : index_(index), reader_(path) {}

  /// Returns the poses at a time or the last ones before it, valid until the next call; null: they cannot be read.
  const Poses* at(std::int64_t time_us);

 private:
  bool read_names(std::uint64_t offset);

  const LogIndex& index_;
  bridges::EventLogReader reader_;
  std::optional<std::uint64_t> scene_at_, bodies_at_;  // what was read last
  std::vector<std::string> names_;
  Poses poses_;
  StateFrame frame_;
};

}  // namespace viewer
