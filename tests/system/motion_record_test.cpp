// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>

#include "experiment/drive/input_events.hpp"
#include "motion/record/recorded_motion.hpp"
#include "tests/system/on_terminal.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal motion record`.

namespace {

using namespace system_test;
using experiment::InputEvent;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

struct Stroke {
  double at_s;
  std::uint16_t code;
  std::int32_t value;
  std::uint16_t type = InputEvent::button;
};

/// What an input device writes; the last event is an end of a report at `end_s`.
std::string events_of(const std::vector<Stroke>& strokes, double end_s) {
  std::string bytes;
  const auto add = [&](const Stroke& stroke) {
    const auto event = experiment::bytes_of(
        {1'700'000'000'000'000 + std::llround(stroke.at_s * 1e6), stroke.type, stroke.code, stroke.value});
    bytes.append(reinterpret_cast<const char*>(event.data()), event.size());
  };
  add({0, 0, 0, InputEvent::report});
  for (const Stroke& stroke : strokes) add(stroke);
  add({end_s, 0, 0, InputEvent::report});
  return bytes;
}

/// Codes of keys of a keyboard (linux/input-event-codes.h).
constexpr std::uint16_t key_1 = 2, key_2 = 3, key_3 = 4, key_4 = 5, key_7 = 8, key_8 = 9, key_5 = 6, key_e = 18,
                        key_d = 32, key_f = 33, key_left_bracket = 26, key_apostrophe = 40;

class MotionRecord : public testing::Test {
 protected:
  std::vector<std::string> arguments(std::vector<std::string> more) const {
    std::vector<std::string> all{"motion", "record", file_, "--world", source("worlds/ers7_studio.yaml")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Ended record(const std::vector<Stroke>& strokes, double end_s, std::vector<std::string> more = {}) {
    write_file(folder_.file("keys.events"), events_of(strokes, end_s));
    more.insert(more.end(), {"--events", folder_.file("keys.events")});
    return run_shoal(arguments(more));
  }
  std::string take() const { return folder_.file("wave_take.yaml"); }
  std::string frames() const { return folder_.file("wave_take.csv"); }

  ScratchFolder folder_;
  const std::string file_ = folder_.file("wave.yaml");
};

/// Row of a CSV file, as text, by its number.
std::string row_of(const std::string& csv, int number) {
  std::size_t at = 0;
  for (int i = 0; i < number && at != std::string::npos; ++i) at = csv.find('\n', at) + 1;
  return csv.substr(at, csv.find('\n', at) - at);
}

TEST_F(MotionRecord, EightJointsStartInOneFrameAndTheSameEventsGiveTheSameFiles) {
  std::vector<Stroke> strokes;
  for (const std::uint16_t key : {key_2, key_3, key_4, key_7, key_8, key_d, key_f, key_5}) {
    strokes.push_back({0.1, key, 1});
  }
  for (const std::uint16_t key : {key_2, key_3, key_4, key_7, key_8, key_d, key_f, key_5})
    strokes.push_back({0.2, key, 0});
  std::string first;
  for (int i = 0; i < 2; ++i) {
    const Ended ended = record(strokes, 0.4, {"--overwrite"});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    const std::string all = ended.output + text_of_file(file_) + text_of_file(take()) + text_of_file(frames());
    if (i == 0) first = all;
    EXPECT_EQ(all, first);
  }
  // The head, three joints of each foreleg, and one of a hind leg.
  const std::string csv = text_of_file(frames());
  EXPECT_EQ(row_of(csv, 0), "t_s,head_nod,lf_swing,lf_flap,lf_knee,lh_swing,rf_swing,rf_flap,rf_knee");
  // The events at 0.1 s are those of the tick at 0.104 s, after the first frame.
  const std::string before = row_of(csv, 1 + 14), after = row_of(csv, 1 + 15);
  EXPECT_EQ(before, "0.112,0,0,0,0,0,0,0,0");
  EXPECT_EQ(after, "0.12,-0.012,0.012,0.012,0.012,-0.012,0.012,0.012,0.012");
  // The exact motion ends in the state of the recording, and keeps the limits of the robot.
  const Ended played = run_shoal({"motion", "play", take(), "--world", source("worlds/ers7_studio.yaml")});
  EXPECT_THAT(played.output, HasSubstr("the final state equals that of the recording"));
  const Ended checked = run_shoal({"motion", "check", file_});
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
}

TEST_F(MotionRecord, ATakePlaysInTheWorldThatItHolds) {
  const std::string world = folder_.file("carpet.yaml");
  write_file(world, "shoal: 1\ninclude: ers7_studio.yaml\n");
  write_file(folder_.file("keys.events"), events_of({{0.1, key_3, 1}, {0.2, key_3, 0}}, 0.4));
  const std::vector<std::string> command{"motion",
                                         "record",
                                         file_,
                                         "--world",
                                         world,
                                         "--set",
                                         "physics.gravity_mps2=9",
                                         "--events",
                                         folder_.file("keys.events"),
                                         "--embed",
                                         "--overwrite"};
  const Ended recorded = run_shoal(command);
  ASSERT_EQ(recorded.exit_code, 0) << recorded.errors;
  EXPECT_THAT(text_of_file(file_), Not(HasSubstr("embedded_world")));
  // The world has changed: only the one in the take has the gravity and the name of the recording.
  write_file(world, "shoal: 1\ninclude: ers7_studio.yaml\nphysics: {gravity_mps2: 4}\n");
  const Ended changed = run_shoal({"motion", "play", take(), "--world", world});
  EXPECT_EQ(changed.exit_code, 1) << changed.output;
  EXPECT_THAT(changed.output, HasSubstr("world: " + world + ", not the embedded one\n"));
  EXPECT_THAT(changed.output, HasSubstr("differs from that of the recording"));
  std::filesystem::remove(world);
  const Ended played = run_shoal({"motion", "play", take()});
  EXPECT_EQ(played.exit_code, 0) << played.output << played.errors;
  EXPECT_THAT(played.output, HasSubstr("world: the one embedded in " + take() + "\n"));
  EXPECT_THAT(played.output, HasSubstr("the final state equals that of the recording"));
  EXPECT_THAT(run_shoal({"motion", "play", file_}).errors,
              HasSubstr("needs --world: '" + file_ + "' contains no world"));
}

TEST_F(MotionRecord, APageChangesNothing) {
  const std::vector<Stroke> strokes{{0.1, key_1, 1}, {0.2, key_1, 0}};
  const Ended alone = record(strokes, 0.4, {"--overwrite"});
  EXPECT_EQ(alone.exit_code, 0) << alone.errors;
  const Ended viewed = record(strokes, 0.4, {"--overwrite", "--view", "--view-port", "0"});
  EXPECT_EQ(viewed.exit_code, 0) << viewed.errors;
  EXPECT_THAT(viewed.errors, HasSubstr("live page: http://"));
  EXPECT_EQ(viewed.output, alone.output);  // with the hash of the state
}

TEST_F(MotionRecord, SaysOnceWhatIsWrongWithItsWorld) {
  const Ended ended = record({}, 0.4, {"--set", "view.scores_rate_hz=0"});
  EXPECT_EQ(ended.exit_code, 2);
  const std::size_t first = ended.errors.find("'scores_rate_hz' must be > 0");
  ASSERT_NE(first, std::string::npos) << ended.errors;
  EXPECT_EQ(ended.errors.find("'scores_rate_hz' must be > 0", first + 1), std::string::npos) << ended.errors;
}

TEST_F(MotionRecord, AGamepadMovesTheJointsOfALeg) {
  // The next set twice: the right foreleg; its stick up, and the right stick.
  const Ended ended = record({{0.05, 311, 1},
                              {0.06, 311, 0},
                              {0.07, 311, 1},
                              {0.1, 1, -32768, InputEvent::axis},
                              {0.1, 4, -32768, InputEvent::axis},
                              {0.5, 1, 0, InputEvent::axis},
                              {0.5, 4, 0, InputEvent::axis},
                              {0.6, 315, 1}},
                             10);
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  const Ended shown = run_shoal({"motion", "show", file_});
  // 1.5 rad/s for 0.4 s are 34 degrees.  The button 'start' ended it, not the last event.
  EXPECT_THAT(shown.output, HasSubstr("motion 'wave' of ers7: 0.6"));
  EXPECT_THAT(text_of_file(frames()), HasSubstr("t_s,rf_swing,rf_knee\n"));
  EXPECT_THAT(shown.output, HasSubstr("rf_swing"));
}

TEST_F(MotionRecord, OverdubPunchAndUndo) {
  ASSERT_EQ(record({{0.1, key_3, 1}, {0.5, key_3, 0}}, 1).exit_code, 0);
  const std::string first = text_of_file(file_);
  const Ended again = record({}, 1);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.errors, HasSubstr("exists: record over it with --overdub or --punch-in"));
  ASSERT_EQ(record({{0.2, key_1, 1}, {0.6, key_1, 0}}, 1, {"--overdub", "neck_tilt"}).exit_code, 0);
  EXPECT_THAT(text_of_file(file_), HasSubstr("neck_tilt: -"));
  const std::string second = text_of_file(file_);
  const Ended punched =
      record({{0, key_e, 1}}, 1, {"--punch-in", "0.3", "--punch-out", "0.8", "--overdub", "lf_swing"});
  EXPECT_EQ(punched.exit_code, 0) << punched.errors;
  EXPECT_NE(text_of_file(file_), second);
  EXPECT_EQ(run_shoal({"motion", "edit", "undo", file_}).exit_code, 0);
  EXPECT_EQ(text_of_file(file_), second);
  EXPECT_EQ(run_shoal({"motion", "edit", "undo", file_}).exit_code, 0);
  EXPECT_EQ(text_of_file(file_), first);
}

TEST_F(MotionRecord, GoesOnFromTheEndOfTheFile) {
  ASSERT_EQ(record({{0.1, key_3, 1}, {0.5, key_3, 0}}, 0.8).exit_code, 0);
  const std::string first = text_of_file(file_);
  // The file ends at 0.824 s; the key moves the neck only after that.
  const Ended ended = record({{0.1, key_1, 1}}, 1.2, {"--append"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr(": 1.224 s, "));
  const std::string csv = text_of_file(frames());
  EXPECT_THAT(row_of(csv, 0), HasSubstr("neck_tilt"));
  const Ended played = run_shoal({"motion", "play", take(), "--world", source("worlds/ers7_studio.yaml")});
  EXPECT_THAT(played.output, HasSubstr("the final state equals that of the recording"));
  // What the file had is still there: the other part was recorded at its end.
  const Ended compared = run_shoal({"motion", "compare", file_});
  EXPECT_THAT(compared.output, HasSubstr("neck_tilt"));
  EXPECT_THAT(compared.output, Not(HasSubstr("lf_swing")));
  EXPECT_EQ(run_shoal({"motion", "edit", "undo", file_}).exit_code, 0);
  EXPECT_EQ(text_of_file(file_), first);
}

TEST_F(MotionRecord, ItsDurationMayBeBeyondTheEndOfTheFile) {
  ASSERT_EQ(record({{0.1, key_3, 1}, {0.5, key_3, 0}}, 0.8).exit_code, 0);
  const Ended ended = record({{0.1, key_1, 1}}, 5, {"--punch-in", "0.4", "--duration", "1.6"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr(": 1.600 s, "));
  const auto errors_of = [&](std::vector<std::string> more) {
    const Ended refused = record({}, 0.1, std::move(more));
    EXPECT_EQ(refused.exit_code, 2);
    return refused.errors;
  };
  EXPECT_THAT(errors_of({"--punch-in", "0.4", "--punch-out", "0.8", "--duration", "7"}),
              HasSubstr("--duration must be at most 1.6 s, the end of the motion, to which it is played after "
                        "--punch-out, got 7"));
  EXPECT_THAT(errors_of({"--append", "--duration", "1"}),
              HasSubstr("--duration must be above 1.6 s, where the recording starts, got 1"));
  EXPECT_THAT(errors_of({"--append", "--punch-in", "1"}), HasSubstr("--punch-in cannot be combined with --append"));
  write_file(file_,
             "shoal: 1\nmotion: wave\nloop: true\nkeys:\n  - {at_s: 0, joints: {mouth: -10}}\n"
             "  - {at_s: 1, joints: {mouth: -10}}\n");
  EXPECT_THAT(errors_of({"--append"}), HasSubstr("wave.yaml' loops, and has no end"));
  std::filesystem::remove(file_);
  EXPECT_THAT(errors_of({"--append"}), HasSubstr("wave.yaml"));
}

TEST_F(MotionRecord, MeasuresPushesInEightDirectionsAndChangesNothing) {
  const std::vector<Stroke> strokes{{0.1, key_3, 1}, {0.3, key_3, 0}};
  const Ended alone = record(strokes, 0.4);
  EXPECT_EQ(alone.exit_code, 0) << alone.errors;
  std::vector<Stroke> measured = strokes;
  measured.push_back({0.35, key_apostrophe, 1});
  const Ended ended = record(measured, 0.4, {"--overwrite"});
  EXPECT_EQ(ended.output, alone.output);
  EXPECT_THAT(ended.errors,
              MatchesRegex("(.*\n)?withstands pushes at 0.36 s, N s: ahead [>0-9.]+, ahead left [>0-9.]+, "
                           "left [>0-9.]+, back left [>0-9.]+, back [>0-9.]+, back right [>0-9.]+, right [>0-9.]+, "
                           "ahead right [>0-9.]+; least [>0-9.]+ [a-z ]+\n(.*\n)?"));
}

TEST_F(MotionRecord, ChangesOfTheWorldAreAPartOfIt) {
  const Ended ended =
      record({{0.2, key_left_bracket, 1}, {0.3, key_3, 1}, {0.5, key_3, 0}}, 0.8,
             {"--on",
              "[={add: {object: {name: box, position_m: [0.3, 0, 0.05], parts: [{shape: box, size_m: [0.1, 0.1, 0.1], "
              "mass_kg: 1}]}}}"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(text_of_file(file_), HasSubstr("changes:\n  - {at_s: 0.208, do: {add: "));
  const Ended played = run_shoal({"motion", "play", take(), "--world", source("worlds/ers7_studio.yaml")});
  EXPECT_THAT(played.output, HasSubstr("the final state equals that of the recording"));
  EXPECT_THAT(
      run_shoal(arguments({"--on", "3={remove: box}", "--overwrite", "--events", folder_.file("keys.events")})).errors,
      HasSubstr("--on: key '3' has another effect"));
}

TEST_F(MotionRecord, AnObjectIsRemovedByABracket) {
  write_file(folder_.file("keys.events"), events_of({{0.2, key_left_bracket, 1}}, 0.4));
  const Ended ended =
      run_shoal({"motion", "record", file_, "--world", source("worlds/ers7_field.yaml"), "--events",
                 folder_.file("keys.events"), "--on", "[={remove: crate}", "--on", "]={remove: block}"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(text_of_file(file_), HasSubstr("do: {remove: crate}"));
}

TEST_F(MotionRecord, ActionsAreCheckedAtTheStart) {
  const auto errors_of = [&](const std::string& action) {
    const Ended ended = record({}, 0.1, {"--on", action});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(file_));
    return ended.errors;
  };
  EXPECT_THAT(errors_of("ctrl+x={remove: box}"), HasSubstr("'ctrl+x' is not a key; known: a character, up, down"));
  EXPECT_THAT(errors_of("[=remove"), HasSubstr("the action of key '[' must be a map of one action"));
  EXPECT_THAT(errors_of("[=[{remove: box}]"), HasSubstr("must be a map of one action"));
  EXPECT_THAT(errors_of("[={remvoe: box}"), HasSubstr("unknown action 'remvoe'; did you mean 'remove'?"));
}

TEST_F(MotionRecord, ReplacesNoOtherFilesUnasked) {
  for (const char* name : {"wave_take.yaml", "wave_take.csv", "wave.csv"}) {
    write_file(folder_.file(name), "mine\n");
    const Ended refused = record({{0.1, key_3, 1}}, 0.3);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.errors, HasSubstr(std::string(name) + "' exists"));
    EXPECT_EQ(text_of_file(folder_.file(name)), "mine\n");
    std::filesystem::remove(folder_.file(name));
  }
  ASSERT_EQ(record({{0.1, key_3, 1}}, 0.3).exit_code, 0);
  // The take of the recording before is that of the motion.
  EXPECT_EQ(record({{0.1, key_1, 1}}, 0.3, {"--overdub", "neck_tilt"}).exit_code, 0);
  write_file(take(), "shoal: 1\nmotion: other\nkeys: [{at_s: 0, joints: {mouth: -10}}]\n");
  EXPECT_THAT(record({}, 0.3, {"--overdub", "neck_tilt"}).errors,
              HasSubstr("wave_take.yaml' exists and is not a recording"));
}

TEST_F(MotionRecord, AKilledProgramLosesNothing) {
  std::vector<std::string> program = arguments({});
  program.insert(program.begin(), built("shoal"));
  std::size_t before = 0;
  {
    OnTerminal terminal(program);
    ASSERT_TRUE(terminal.shows("enter ends"));
    terminal.press("3");
    const std::string journal = motion::journal_path(file_);
    ASSERT_TRUE(await(
        [&] {
          return std::filesystem::exists(journal) && std::filesystem::file_size(journal) > 1000 &&
                 motion::read_take(journal).frame_count() > 100;
        },
        timeout));
    // No other process can record or recover it now.
    EXPECT_THAT(run_shoal({"motion", "record", file_, "--recover"}).errors, HasSubstr("by another process"));
    kill(terminal.pid(), SIGKILL);
    EXPECT_EQ(terminal.wait(), 128 + SIGKILL);
    before = motion::read_take(journal).frame_count();
  }
  const Ended recovered = run_shoal({"motion", "record", file_, "--recover"});
  EXPECT_EQ(recovered.exit_code, 0) << recovered.errors;
  EXPECT_THAT(recovered.errors, HasSubstr("recovered a recording of"));
  EXPECT_FALSE(std::filesystem::exists(motion::journal_path(file_)));
  const std::string csv = text_of_file(frames());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(before + 1));
  EXPECT_THAT(text_of_file(file_), HasSubstr("lf_swing: "));
  EXPECT_EQ(run_shoal({"motion", "record", file_, "--recover"}).exit_code, 4);
}

TEST_F(MotionRecord, AClosedTerminalSavesTheRecording) {
  std::vector<std::string> program = arguments({});
  program.insert(program.begin(), built("shoal"));
  OnTerminal terminal(program);
  ASSERT_TRUE(terminal.shows("enter ends"));
  ASSERT_TRUE(await([&] { return terminal.is_raw(); }, timeout));
  kill(terminal.pid(), SIGHUP);
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_TRUE(std::filesystem::exists(file_));
  EXPECT_FALSE(std::filesystem::exists(motion::journal_path(file_)));
}

TEST_F(MotionRecord, ATerminalWithReleasesMovesJointsWhileTheirKeysAreHeld) {
  std::vector<std::string> program = arguments({});
  program.insert(program.begin(), built("shoal"));
  OnTerminal terminal(program);
  ASSERT_TRUE(terminal.shows("\x1b[?u"));
  ASSERT_TRUE(await([&] { return terminal.is_raw(); }, timeout));
  terminal.press("\x1b[?0u");  // the answer of a terminal with the Kitty protocol
  ASSERT_TRUE(terminal.shows("\x1b[>11u"));
  // 3 and d down, 3 repeated, both up.
  EXPECT_TRUE(terminal.shows("hold the keys: a joint moves while its key is held"));
  terminal.press("\x1b[51u\x1b[100;1:1u");
  ASSERT_TRUE(terminal.shows("lf_flap"));
  terminal.press("\x1b[51;1:2u\x1b[51;1:3u\x1b[100;1:3u");
  terminal.press("\x1b[13u");
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_THAT(terminal.shown(), HasSubstr("\x1b[<u"));
  // Both have moved by the same way.
  const std::string csv = text_of_file(frames());
  EXPECT_EQ(row_of(csv, 0), "t_s,lf_swing,lf_flap");
  const std::string last = row_of(csv, static_cast<int>(std::count(csv.begin(), csv.end(), '\n')) - 1);
  const std::string swing = last.substr(last.find(',') + 1, last.rfind(',') - last.find(',') - 1);
  EXPECT_EQ(last.substr(last.rfind(',') + 1), swing);
  EXPECT_GT(std::stod(swing), 0);
}

TEST_F(MotionRecord, ATerminalWithoutReleasesStartsAndStopsJoints) {
  std::vector<std::string> program = arguments({});
  program.insert(program.begin(), built("shoal"));
  OnTerminal terminal(program);
  ASSERT_TRUE(terminal.shows("enter ends"));
  ASSERT_TRUE(await([&] { return terminal.is_raw(); }, timeout));
  EXPECT_TRUE(terminal.shows("a key starts its joint, the same key stops it"));
  terminal.press("3d");
  ASSERT_TRUE(terminal.shows("lf_flap"));
  EXPECT_TRUE(terminal.shows(" limit"));  // lf_flap goes outward by 1.5 rad/s to its limit
  terminal.press("\t\r");
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_THAT(row_of(text_of_file(frames()), 0), HasSubstr("lf_swing,lf_flap"));
}

TEST_F(MotionRecord, ItsLineHasTheStaticMarginInRedWhereItIsSmall) {
  // Its front legs swing backward, until its center of mass is before its feet.
  write_file(file_,
             "shoal: 1\nmotion: wave\nvehicle: ers7\nkeys:\n"
             "  - {at_s: 0, joints: {lf_swing: 0, rf_swing: 0}}\n"
             "  - {at_s: 2, joints: {lf_swing: -60, rf_swing: -60}}\n");
  std::vector<std::string> program = arguments({"--append"});
  program.insert(program.begin(), built("shoal"));
  OnTerminal terminal(program);
  ASSERT_TRUE(terminal.shows("enter ends"));
  EXPECT_TRUE(terminal.shows("playing    static "));
  EXPECT_TRUE(terminal.shows("playing    \x1b[31mstatic "));
  EXPECT_TRUE(terminal.shows("recording"));
  EXPECT_TRUE(terminal.shows("past the end of wave.yaml: 2.0 s"));
  terminal.press("\r");
  EXPECT_TRUE(terminal.shows(" frames began more than a step, 2 ms, late"));
  EXPECT_EQ(terminal.wait(), 0);
}

TEST_F(MotionRecord, SaysWhatIsWrong) {
  EXPECT_THAT(run_shoal({"motion", "record", file_}).errors, HasSubstr("needs --world"));
  EXPECT_THAT(run_shoal(arguments({})).errors, HasSubstr("needs a terminal, or --input or --events"));
  EXPECT_FALSE(std::filesystem::exists(motion::journal_path(file_)));
  EXPECT_THAT(run_shoal(arguments({"--input", "/dev/nothing"})).errors, HasSubstr("/dev/nothing: cannot be opened"));
  EXPECT_THAT(run_shoal(arguments({"--events", folder_.file("none")})).errors, HasSubstr("none: cannot be read"));
  EXPECT_THAT(record({}, 0.1, {"--overdub", "tail"}).errors, HasSubstr("wave.yaml"));
}

TEST_F(MotionRecord, IsComparedWithItsFramesAndWithTheVersionBefore) {
  ASSERT_EQ(record({{0.1, key_3, 1}, {0.5, key_3, 0}}, 1).exit_code, 0);
  const Ended none = run_shoal({"motion", "compare", file_});
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_THAT(none.errors, HasSubstr("has no earlier version"));
  const Ended frames = run_shoal({"motion", "compare", file_, take(), "--tolerance", "0.25"});
  EXPECT_EQ(frames.exit_code, 0) << frames.output << frames.errors;
  EXPECT_THAT(frames.output, testing::EndsWith("\nequal within 0.25 deg\n"));
  ASSERT_EQ(record({{0.2, key_1, 1}, {0.6, key_1, 0}}, 1, {"--overdub", "neck_tilt"}).exit_code, 0);
  const Ended before = run_shoal({"motion", "compare", file_, "--tolerance", "0.1", "--world",
                                  source("worlds/ers7_studio.yaml"), "--png", folder_.file("wave.png")});
  EXPECT_EQ(before.exit_code, 1);
  ASSERT_EQ(before.errors, "");
  // 1.5 rad/s for 50 frames of 8 ms: 34.38 degrees, from the frame after 0.2 s on.
  EXPECT_THAT(before.output, testing::ContainsRegex("neck_tilt +34\\.37[0-9]+ +0\\.[0-9]+ +[0-9.]+ +0\\.2[0-9]+\n"));
  EXPECT_THAT(before.output, testing::ContainsRegex("\n[0-9]+ joints: 0\n"));
  EXPECT_THAT(before.output, testing::EndsWith("\nthey differ\n"));
  EXPECT_THAT(before.output, HasSubstr("vehicle: greatest distance "));
  EXPECT_EQ(text_of_file(folder_.file("wave.png")).substr(1, 3), "PNG");
}

TEST_F(MotionRecord, ABittleIsRecordedAndExportedAndReadAgain) {
  // Shoulders and knees of the usual keys: 2, 3, 4, 5 of the left and right front legs.
  write_file(folder_.file("keys.events"),
             events_of({{0.1, key_2, 1}, {0.1, key_3, 1}, {0.6, key_2, 0}, {0.6, key_3, 0}}, 1));
  const Ended recorded = run_shoal({"motion", "record", file_, "--world", source("worlds/bittle_bench.yaml"),
                                    "--events", folder_.file("keys.events")});
  EXPECT_EQ(recorded.exit_code, 0) << recorded.errors;
  const Ended checked = run_shoal({"motion", "check", file_});
  EXPECT_EQ(checked.exit_code, 0) << checked.output << checked.errors;
  const Ended exported =
      run_shoal({"motion", "export", file_, "--format", "opencat", "--output", folder_.file("wave.h")});
  EXPECT_EQ(exported.exit_code, 0) << exported.errors;
  const Ended imported = run_shoal({"motion", "import", folder_.file("wave.h"), "--format", "opencat", "--vehicle",
                                    "bittle", "--output", folder_.file("again.yaml")});
  EXPECT_EQ(imported.exit_code, 0) << imported.errors;
  // What was read is written as the same skill.  Its last row has the end of the recording, in whole degrees.
  const Ended again = run_shoal(
      {"motion", "export", folder_.file("again.yaml"), "--format", "opencat", "--output", folder_.file("again.h")});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(text_of_file(folder_.file("again.h")), text_of_file(folder_.file("wave.h")));
  // 1 rad/s for 62 frames of 8 ms: 28.42 degrees; 28 degrees are 0.4887 rad.
  EXPECT_THAT(text_of_file(file_), HasSubstr("lf_shoulder: 28.4"));
  EXPECT_THAT(text_of_file(folder_.file("again.yaml")), HasSubstr("lf_shoulder: 0.48869219"));
}

}  // namespace
