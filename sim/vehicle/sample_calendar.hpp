// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace sim {

/// Sensors by the step of their next sample, so that a step finds those that are due without visiting the others: a
/// ring of lists, one for each of the next steps, and a list for later ones.
class SampleCalendar {
 public:
  SampleCalendar() : ring_(steps) {}
  /// Removes all sensors.  `step`: the first one that take() will be asked for.
  void clear(std::int64_t step);
  /// Adds a sensor that is due at a step; a step in the past is the next one.
  void add(std::uint32_t sensor, std::int64_t due_step);
  /// Removes a sensor that was added with this step.
  void remove(std::uint32_t sensor, std::int64_t due_step);
  /// Appends the sensors that are due up to a step, in any order, and removes them.
  void take(std::int64_t step, std::vector<std::uint32_t>& due);

 private:
  static constexpr std::int64_t steps = 1024;
  struct Later {
    std::uint32_t sensor;
    std::int64_t due_step;
  };
  std::vector<std::uint32_t>& at(std::int64_t step) { return ring_[static_cast<std::size_t>(step % steps)]; }

  std::vector<std::vector<std::uint32_t>> ring_;  // of the steps from next_ to before end_
  std::vector<Later> later_;
  std::int64_t next_ = 0;
  std::int64_t end_ = steps;
};

}  // namespace sim
