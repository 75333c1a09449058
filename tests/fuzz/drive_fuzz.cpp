// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/driver.hpp"
#include "experiment/drive/gamepad.hpp"
#include "experiment/terminal/key_events.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "viewer/server/page_drive.hpp"

// Events of a gamepad, and the same bytes as keys of a terminal, a profile and a message of a page.

SHOAL_FUZZ_TARGET(drive) {
  static const experiment::DriveProfile profile = experiment::read_drive_profile("");
  const auto check = [](const experiment::DriveValues& values) {
    for (const auto& [axis, value] : values)
      fuzz::require(std::abs(value) <= 1, "a position of the controls is from -1 to 1");
  };
  // Events, in pieces of 7 bytes.
  experiment::Gamepad pad(profile.gamepad);
  experiment::InputEventReader reader;
  fuzz::allow<experiment::DriveError>([&] {
    for (std::size_t at = 0; at < input.size(); at += 7) {
      reader.add(input.subspan(at, std::min<std::size_t>(7, input.size() - at)));
      while (const auto event = reader.next()) {
        fuzz::require(event->time_us >= 0, "a time is not negative");
        pad.take(*event);
        check(pad.values());
      }
    }
    fuzz::require(reader.count() == static_cast<std::int64_t>(input.size() / experiment::InputEventReader::event_bytes),
                  "every whole event is read");
  });
  // Keys.
  experiment::KeyEvents events;
  experiment::DriveKeys keys(profile.keys);
  for (const char byte : fuzz::text_of(input)) {
    if (const auto event = events.next(byte)) keys.press(event->key);
    check(keys.values());
  }
  // Texts.
  const std::string text(fuzz::text_of(input));
  fuzz::allow<sim::ConfigError>([&] {
    const experiment::DriveProfile own = experiment::parse_drive_profile(text, "profile");
    fuzz::require(own.hold_s <= 0.2 && own.rate_hz >= 5, "a profile keeps the limits of safety");
  });
  fuzz::allow<experiment::DriveError>([&] { check(viewer::PageDrive::read(text).values); });
}
