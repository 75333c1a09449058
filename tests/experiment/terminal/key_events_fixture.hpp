// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/terminal/key_events.hpp"

namespace key_events_fixture {

/// Events of bytes: names, with `^` before those with Ctrl and `-` after a release.
inline std::vector<std::string> events_of(const std::string& bytes) {
  experiment::KeyEvents keys;
  std::vector<std::string> events;
  for (const char byte : bytes)
    if (const auto event = keys.next(byte))
      events.push_back((event->ctrl ? "^" : "") + event->key +
                       (event->action == experiment::KeyEvent::Action::release ? "-" : ""));
  return events;
}

}  // namespace key_events_fixture
