// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"

namespace viewer {

/// Binary frame with the poses of all movable bodies, for the live page; docs/develop/view_protocol.md has the layout.
class StateFrame {
 public:
  static constexpr std::size_t body_bytes = 20;

  struct Head {
    std::int64_t time_us = 0;
    std::int32_t branch = 0;
    std::uint32_t revision = 0;
    float speed = 1;
    bool paused = false;
    bool jump = false;  ///< the time was set: not to be interpolated from the frame before
    bool past = false;  ///< a time in the past, for the page that asked for it
  };

  /// Starts a frame; its memory is reused.
  void begin(const Head& head);
  /// Adds the next body of the scene.
  void add(const sim::Vector3d& p_W, const sim::Quaterniond& q_WB);
  /// Adds bodies as another frame has them, from bodies().
  void add(std::span<const std::byte> bodies);
  /// Adds a body whose pose is unknown: its position is not a number.
  void add_unknown();
  /// Returns the bytes of the bodies added so far, body_bytes for each.
  std::span<const std::byte> bodies() const;
  /// Completes the frame, and returns it with the next sequence number.
  std::span<const std::byte> end();

 private:
  template <typename Number>
  void put(std::size_t at, Number number);

  sim::Bytes bytes_;
  std::uint32_t sequence_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace viewer
