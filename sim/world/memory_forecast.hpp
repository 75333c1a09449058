// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace sim {

/// Bytes that this process has allocated and not freed; none: unknown.
std::optional<std::size_t> allocated_bytes();

/// Bytes that this process can still allocate without swapping: what the system has available, at most the rest of the
/// limits of its control group and of its address space.  None: unknown.
std::optional<std::size_t> available_bytes();

/// Forecast of the memory of a world while its vehicles are built: the mean growth by each vehicle so far, and half as
/// much again for its first steps, times their number.  Forecasts are made after 64 vehicles and after each
/// doubling, so that a world that does not fit is refused long before the memory is full.
class MemoryForecast {
 public:
  /// `vehicles`: number of all.
  MemoryForecast(std::size_t vehicles, std::optional<std::size_t> allocated, std::optional<std::size_t> available);

  /// Whether a forecast is due after so many vehicles.
  bool is_due(std::size_t built) const { return known_ && built == next_ && built < vehicles_; }
  /// Returns the text of an error when the remaining vehicles do not fit; empty: they fit.
  std::string problem(std::size_t built, std::size_t allocated);

 private:
  std::size_t vehicles_, start_bytes_ = 0, available_bytes_ = 0, next_ = 64;
  bool known_ = false;
};

/// Returns a size with two digits and its unit: `85 kB`, `3.2 GB`.
std::string size_text(double bytes);

}  // namespace sim
