// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/acoustics/sound_observer.hpp"

namespace sim {

/// Something that happened in a world, for logs and time lines.
struct Occurrence {
  /// Kind of an occurrence.
  enum class Kind {
    event,    ///< an event of the world file fired
    fault,    ///< a fault of a device was set or cleared, or a device switched itself off
    added,    ///< a vehicle or object was added
    removed,  ///< a vehicle or object was removed
    moved,    ///< a vehicle or object was moved by an action or a request
    changed,  ///< parameters of a device, or gravity, were changed
    ended,    ///< an event ended the run
  };

  Kind kind = Kind::event;
  std::string who;   ///< event, device, vehicle or object
  std::string text;  ///< what happened, in a few words; may be empty
};

/// Returns the word of a kind, such as `fault`.
const char* occurrence_word(Occurrence::Kind kind);

/// Observer of a world.  It must not change the world, and is not state: what a rewind takes back has been reported.
class WorldObserver : public SoundObserver {
 public:
  virtual void happened(const Occurrence& occurrence) = 0;
};

}  // namespace sim
