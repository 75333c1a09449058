// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace viewer {

/// Run to be shown in images: a world that is run without programs, or the world of a log, which is run again with
/// the inputs that it recorded.  Neither is changed by being shown.
class FilmSource {
 public:
  virtual ~FilmSource() = default;

  virtual sim::World& world() = 0;
  /// Runs a step.  Returns false at the end of the run; the world is then in its last state.  Throws
  /// sim::PhysicsFault.
  virtual bool step() = 0;
  /// Returns the time at which the run ends; infinity: unknown.
  virtual double end_s() const = 0;
  /// Returns the path of the log; empty: a world without a log.
  virtual const std::string& log() const = 0;

  /// Runs until a time, or to the end of the run.  Returns whether the time was reached.
  bool advance_to(sim::Time time);
};

/// Returns whether a file is an LCM event log, by its first bytes.
bool is_event_log(const std::string& path);

/// Opens a world by file or name, or a log of `shoal run --record`.  Throws sim::ConfigError; std::runtime_error when
/// the log cannot be replayed, or seed or settings are given for it.
std::unique_ptr<FilmSource> open_film_source(const std::string& log_or_world, const sim::LoadOptions& load);

}  // namespace viewer
