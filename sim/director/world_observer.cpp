// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/world_observer.hpp"

namespace sim {

const char* occurrence_word(Occurrence::Kind kind) {
  switch (kind) {
    case Occurrence::Kind::event:
      return "event";
    case Occurrence::Kind::fault:
      return "fault";
    case Occurrence::Kind::added:
      return "added";
    case Occurrence::Kind::removed:
      return "removed";
    case Occurrence::Kind::moved:
      return "moved";
    case Occurrence::Kind::changed:
      return "changed";
    case Occurrence::Kind::ended:
      return "ended";
  }
  return "";
}

}  // namespace sim
