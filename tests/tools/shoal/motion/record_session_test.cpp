// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/motion/record_session.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "experiment/drive/input_events.hpp"
#include "tests/motion/record/recording_studio.hpp"
#include "tools/command_line/checks.hpp"

namespace {

using experiment::InputEvent;

/// Writes a file of the events of a keyboard.
std::string events(const recording_studio::Studio& studio, const std::vector<InputEvent>& all) {
  std::ofstream file(studio.folder.file("keys.events"), std::ios::binary);
  for (const InputEvent& one : all) {
    const auto bytes = experiment::bytes_of(one);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  return studio.folder.file("keys.events");
}

TEST(RecordSession, AKeyOfAnActionHasNoOtherEffect) {
  recording_studio::Studio studio;
  const auto recorder = studio.recorder();
  tools::RecordArguments arguments;
  arguments.file = studio.file;
  arguments.events = events(studio, {{0, InputEvent::report, 0, 0}});
  for (const char* key : {"space", "q"})
    EXPECT_THAT(
        [&] {
          const tools::RecordSession session(arguments, *recorder, {{key, {}}});
        },
        testing::ThrowsMessage<command_line::UsageError>("--on: key '" + std::string(key) + "' has another effect"));
}

TEST(RecordSession, RecordsTheEventsOfAFileToItsEnd) {
  recording_studio::Studio studio;
  const auto recorder = studio.recorder();
  tools::RecordArguments arguments;
  arguments.file = studio.file;
  // The key 1, of code 2, moves the hip at 1 rad/s, from the frame at 40 ms to that before 120 ms.
  arguments.events = events(studio, {{0, InputEvent::report, 0, 0},
                                     {40'000, InputEvent::button, 2, 1},
                                     {120'000, InputEvent::button, 2, 0},
                                     {160'000, InputEvent::report, 0, 0}});
  EXPECT_EQ(tools::RecordSession(arguments, *recorder, {}).run(), 0);
  EXPECT_NEAR(recorder->set_points()[0], 0.08, 1e-9);
  EXPECT_EQ(recorder->set_points()[1], 0);
}

}  // namespace
