// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "viewer/film/film.hpp"

namespace viewer {

/// Part of a run around an event.
struct Clip {
  double at_s = 0, from_s = 0, to_s = 0;  ///< simulated time
  std::string kind, who;                  ///< of the event
  std::string vehicle;                    ///< that the camera follows; empty: all are in view
  std::string file;
};

struct ClipOptions {
  std::string directory;        ///< is made if it does not exist
  std::string ending = ".mp4";  ///< kind of the films, as for make_film_writer()
  double before_s = 3;          ///< simulated time before the event
  double after_s = 5;           ///< and after it
  std::size_t max_clips = 50;   ///< later events get none
};

/// Clips of a log.
struct ClipOutcome {
  std::vector<Clip> clips;
  std::size_t events = 0;   ///< of the log
  std::size_t without = 0;  ///< events beyond a limit, which have no clip
  std::int64_t frames = 0;
  double wall_s = 0;
  bool interrupted = false;  ///< by a signal; only complete clips are left

  /// Returns a line for each clip, and one with the numbers.
  std::string to_text() const;
};

/// Returns the clips of the events on `sim.event` in a log, by time: one for the events of the same vehicle or object
/// within a second.  At most eight overlap.  Counts the events without a clip in `outcome`.  Throws bridges::BusError;
/// std::runtime_error for a file that is not a log or has no event.
std::vector<Clip> find_clips(const std::string& log, const ClipOptions& options, ClipOutcome& outcome);

/// Renders a clip for each event of a log, in one pass.  Of `film`, `out`, `cameras`, `from_s` and `until_s` are not
/// used.  Throws as make_film() and find_clips() do.
ClipOutcome make_clips(const FilmOptions& film, const ClipOptions& options);

}  // namespace viewer
