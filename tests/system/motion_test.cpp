// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>

#include "tests/system/shoal_program.hpp"
#include "tests/viewer/server/view_page.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::Not;

const std::string wave = "vehicles/motions/ers7/wave.yaml";

Ended motion(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "motion");
  return run_shoal(std::move(arguments));
}

TEST(Motion, EveryShippedOneKeepsTheLimitsOfItsRobot) {
  int motions = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source("vehicles/motions/ers7"))) {
    if (entry.path().extension() != ".yaml" || entry.path().stem() == "names") continue;
    ++motions;
    const Ended ended = motion({"check", entry.path().string()});
    EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
  }
  EXPECT_EQ(motions, 12);
}

TEST(Motion, IsShownWithItsJointsAndAsFrames) {
  const Ended shown = motion({"show", source(wave)});
  EXPECT_EQ(shown.exit_code, 0);
  EXPECT_THAT(shown.output, HasSubstr("motion 'wave' of ers7: 9.000 s, 12 joints"));
  const Ended frames = motion({"show", source(wave), "--frames"});
  EXPECT_THAT(frames.output, HasSubstr("t_s,lf_swing,"));
  EXPECT_THAT(frames.output, HasSubstr("\n0.008,"));
}

TEST(Motion, IsCheckedAgainstALimitOfTwoJoints) {
  const ScratchFolder folder;
  // Sony: with the front leg swung to 60 degrees the flap is at least -3 degrees.
  write_file(folder.file("m.yaml"),
             "shoal: 1\nmotion: m\nvehicle: ers7\nkeys:\n  - {at_s: 0, joints: {lf_swing: 0, lf_flap: 0}}\n"
             "  - {at_s: 2, joints: {lf_swing: 60, lf_flap: -4}}\n");
  const Ended ended = motion({"check", folder.file("m.yaml")});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.output, HasSubstr("joint 'lf_flap' after key 2 at 2.000 s: -4.00 deg is below its lower limit at "
                                      "this position of another joint, -3.00 deg"));
}

TEST(Motion, IsPlayedAndAgainFromAnInstantWithTheSameEnd) {
  const Ended ended = motion({"play", source(wave), "--world", source("worlds/ers7_studio.yaml"), "--again-from", "4"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("the same final state"));
  EXPECT_THAT(ended.output, Not(HasSubstr("has fallen")));
}

TEST(Motion, APartOfItIsPlayedAgainAndAgain) {
  const std::string world = source("worlds/ers7_studio.yaml");
  const auto play = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"play", source(wave), "--world", world});
    return motion(more);
  };
  const Ended ended = play({"--from", "1", "--to", "1.5", "--loop", "--loop-time", "3"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("3.000 s simulated"));
  const Ended once = play({"--from", "1", "--to", "1.5", "--again-from", "1.25"});
  EXPECT_EQ(once.exit_code, 0) << once.errors;
  EXPECT_THAT(once.output, HasSubstr("the same final state"));
  const auto error_of = [&](std::vector<std::string> more) {
    const Ended refused = play(std::move(more));
    EXPECT_EQ(refused.exit_code, 2);
    return refused.errors;
  };
  EXPECT_THAT(error_of({"--from", "5", "--to", "4"}),
              HasSubstr("--from and --to must be a part of the motion, from 0 to 9 s, got 5 to 4"));
  EXPECT_THAT(error_of({"--to", "9.5"}), HasSubstr("from 0 to 9 s, got 0 to 9.5"));
  EXPECT_THAT(error_of({"--from", "9"}), HasSubstr("from 0 to 9 s, got 9 to 9"));
  EXPECT_THAT(error_of({"--from", "1", "--to", "2", "--again-from", "3"}),
              HasSubstr("--again-from must be from 1 to 2 s, the part that is played, got 3"));
  EXPECT_THAT(error_of({"--rate", "0.5"}), HasSubstr("--rate needs --view"));
}

TEST(Motion, IsPlayedOnALivePage) {
  const std::string world = source("worlds/ers7_studio.yaml");
  Program program({built("shoal"), "motion", "play", source("vehicles/motions/ers7/nod.yaml"), "--world", world,
                   "--view", "--view-port", "0", "--rate", "0.5"});
  ASSERT_TRUE(await([&] { return program.errors().find("Ctrl-C ends it\n") != std::string::npos; }, timeout));
  const std::string errors = program.errors();
  const std::size_t at = errors.find("http://");
  test::ViewPage page(errors.substr(at, errors.find('\n', at) - at));
  const auto margins =
      page.text("scores", [](const auto& scores) { return scores["metrics"][0]["figures"]["static_m"].is_number(); });
  EXPECT_EQ(margins["metrics"][0]["name"], "support");
  page.control("pause");
  EXPECT_EQ(page.reply()["ok"], true);
  EXPECT_TRUE(page.text("status", [](const auto& status) { return status["paused"] == true; })["speed"] == 0.5);
  page.control("rewind", 0.1);
  EXPECT_EQ(page.reply()["ok"], true);
  page.control("do", 0, "{remove: dog}");
  EXPECT_THAT(page.reply()["text"], HasSubstr("'do' is not possible while a motion is played"));
  page.control("speed", 0);
  EXPECT_EQ(page.reply()["ok"], true);
  page.control("resume");
  EXPECT_EQ(program.wait(), 0);
  // What the page did does not change how it ends.
  const Ended alone = motion({"play", source("vehicles/motions/ers7/nod.yaml"), "--world", world});
  EXPECT_EQ(program.output(), alone.output);
}

TEST(Motion, ASignalEndsALoopOnALivePage) {
  Program program({built("shoal"), "motion", "play", source("vehicles/motions/ers7/nod.yaml"), "--world",
                   source("worlds/ers7_studio.yaml"), "--view", "--view-port", "0", "--loop"});
  ASSERT_TRUE(await([&] { return program.errors().find("Ctrl-C ends it\n") != std::string::npos; }, timeout));
  program.send_signal(SIGINT);
  EXPECT_EQ(program.wait(), 130);
  EXPECT_THAT(program.output(), HasSubstr("ended after 0.000 s"));
}

TEST(Motion, ItsStabilityHasARowForEachKey) {
  const ScratchFolder folder;
  write_file(folder.file("m.yaml"),
             "shoal: 1\nmotion: m\nvehicle: ers7\nkeys:\n  - {at_s: 0, joints: {head_pan: 0}}\n"
             "  - {at_s: 1, joints: {head_pan: 40}}\n");
  const Ended ended = motion({"stability", folder.file("m.yaml"), "--world", source("worlds/ers7_studio.yaml"),
                              "--directions", "2", "--watch", "0.2"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("\n   0.000"));
  EXPECT_THAT(ended.output, HasSubstr("\n   1.000"));
}

TEST(Motion, SeveralAreSortedIntoClassesOneLineEach) {
  const ScratchFolder folder;
  const std::string head = "shoal: 1\nvehicle: ers7\nmotion: ";
  // Straight legs stand; a dog whose legs are all swung forward falls on its back.
  write_file(folder.file("b.yaml"),
             head + "look\nkeys: [{at_s: 0, joints: {head_pan: 0}}, {at_s: 1, joints: {head_pan: 40}}]\n");
  write_file(folder.file("a.yaml"),
             head +
                 "fall\nkeys: [{at_s: 0, joints: {lf_swing: 0, rf_swing: 0, lh_swing: 0, rh_swing: 0}},\n"
                 "  {at_s: 1, joints: {lf_swing: 100, rf_swing: 100, lh_swing: -100, rh_swing: -100}}]\n");
  write_file(folder.file("c.yaml"), head + "other\nkeys: [{at_s: 0, joints: {elbow: 0}}]\n");
  const std::vector<std::string> options{"--world", source("worlds/ers7_studio.yaml"), "--watch", "1", "--directions",
                                         "2"};
  const auto classes = [&](std::vector<std::string> files) {
    files.insert(files.begin(), "stability");
    files.insert(files.end(), options.begin(), options.end());
    return motion(files);
  };
  const Ended two = classes({folder.file("b.yaml"), folder.file("a.yaml")});
  EXPECT_EQ(two.exit_code, 1) << two.errors;
  EXPECT_THAT(two.output, testing::ContainsRegex("\nlook +stable .*\nfall +unstable .* falls by itself\n"));
  EXPECT_THAT(two.output, HasSubstr("stable: from 0.4 m/s; marginal: from 0.1 m/s"));
  const Ended refused = classes({folder.file("c.yaml"), folder.file("b.yaml")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.output, testing::ContainsRegex("\nother +cannot be played\nlook +stable "));
  EXPECT_THAT(refused.errors, HasSubstr("names joint 'elbow', which is not a servo"));
  // The table of one motion ends with its class, by the same thresholds.
  EXPECT_THAT(classes({folder.file("b.yaml")}).output, HasSubstr("\nlook: stable\n"));
  EXPECT_THAT(classes({folder.file("b.yaml"), "--stable", "5"}).output, HasSubstr("\nlook: marginal\n"));
  EXPECT_THAT(classes({folder.file("b.yaml"), "--marginal", "0.5"}).errors,
              HasSubstr("--marginal must be at most --stable, 0.4, got 0.5"));
}

TEST(Motion, OfTheDogOfTheThesisHaveAWorldThatAWrongOneNames) {
  const Ended wrong =
      run_shoal({"check", source("worlds/ers7_field.yaml"), "--set", "vehicles.dog.file=ers7_seed.yaml"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("the vehicle has no parameter 'camera_hz'; world 'ers7_seed_studio' has this "
                                      "vehicle; or set --set vehicles.dog.parameters={}"));
  const Ended right = run_shoal({"check", source("worlds/ers7_field.yaml"), "--set", "vehicles.dog.file=ers7_seed.yaml",
                                 "--set", "vehicles.dog.parameters={}"});
  EXPECT_EQ(right.exit_code, 0) << right.errors;
}

TEST(Motion, DivergesByModelAndTime) {
  const ScratchFolder folder;
  std::string first;
  for (const std::string threads : {"1", "2"}) {
    const Ended ended = motion({"divergence", source(wave), "--world", source("worlds/ers7_studio.yaml"), "--duration",
                                "1", "--threads", threads, "--csv", folder.file("d.csv")});
    EXPECT_EQ(ended.exit_code, 0) << ended.errors;
    EXPECT_THAT(ended.output, HasSubstr("\nwave "));
    EXPECT_THAT(ended.output, HasSubstr("none fall"));
    const std::string csv = text_of_file(folder.file("d.csv"));
    EXPECT_THAT(csv, testing::StartsWith("t_s,wave_mm\n0.000,0.0000\n0.100,"));
    EXPECT_THAT(csv, HasSubstr("\n1.000,"));
    if (first.empty()) first = csv;
    EXPECT_EQ(csv, first);
  }
}

TEST(Motion, IsEditedAndGoesBack) {
  const ScratchFolder folder;
  const std::string file = folder.file("wave.yaml");
  write_file(file, text_of_file(source(wave)));
  const auto shown = [&] { return motion({"show", file}).output; };
  const std::string before = shown();
  EXPECT_EQ(motion({"edit", "scale", file, "--by", "2"}).exit_code, 0);
  EXPECT_THAT(shown(), HasSubstr("18.000 s"));
  EXPECT_EQ(motion({"edit", "set", file, "--at", "1", "head_pan=20"}).exit_code, 0);
  EXPECT_THAT(shown(), HasSubstr("head_pan"));
  EXPECT_EQ(motion({"edit", "undo", file}).exit_code, 0);
  EXPECT_EQ(motion({"edit", "undo", file}).exit_code, 0);
  EXPECT_EQ(shown(), before);
  const Ended nothing = motion({"edit", "undo", file});
  EXPECT_EQ(nothing.exit_code, 4);
  EXPECT_THAT(nothing.errors, HasSubstr("there is nothing to undo"));
  EXPECT_EQ(motion({"edit", "mirror", file, "--output", folder.file("left.yaml")}).exit_code, 0);
  EXPECT_THAT(motion({"show", folder.file("left.yaml"), "--frames"}).output, HasSubstr("t_s,rf_swing,"));
}

TEST(Motion, OutputsHaveTheirOwnNamesAndReplaceNoFileUnasked) {
  const ScratchFolder folder;
  const std::string file = folder.file("wave.yaml"), other = folder.file("left.yaml");
  write_file(file, text_of_file(source(wave)));
  EXPECT_EQ(motion({"edit", "mirror", file, "--output", other}).exit_code, 0);
  EXPECT_THAT(text_of_file(other), HasSubstr("motion: left\n"));
  const std::string before = text_of_file(other);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"edit", "scale", file, "--by", "2", "--output", other},
        std::vector<std::string>{"check", file, "--fix", other}}) {
    const Ended refused = motion(command);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.errors, HasSubstr("left.yaml' exists; --overwrite replaces it"));
    EXPECT_EQ(text_of_file(other), before);
  }
  EXPECT_EQ(motion({"edit", "scale", file, "--by", "2", "--output", other, "--overwrite"}).exit_code, 0);
  EXPECT_NE(text_of_file(other), before);
  EXPECT_THAT(text_of_file(file), HasSubstr("motion: wave\n"));
  // 9 s in frames of 8 ms, each a key: they become a CSV file.
  write_file(folder.file("wave.csv"), "measured\n");
  const Ended smooth = motion({"edit", "smooth", file, "--window", "0.1"});
  EXPECT_EQ(smooth.exit_code, 2);
  EXPECT_THAT(smooth.errors, HasSubstr("wave.csv' exists and does not belong to '"));
  EXPECT_EQ(text_of_file(folder.file("wave.csv")), "measured\n");
  EXPECT_EQ(motion({"edit", "smooth", file, "--window", "0.1", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(motion({"edit", "smooth", file, "--window", "0.1"}).exit_code, 0);  // it is now its own
}

TEST(Motion, JointsThatAreSetAreThoseOfTheVehicle) {
  const ScratchFolder folder;
  const std::string file = folder.file("wave.yaml");
  write_file(file, text_of_file(source(wave)));
  const Ended misspelled = motion({"edit", "set", file, "--at", "1", "tial_pan=30"});
  EXPECT_EQ(misspelled.exit_code, 2);
  EXPECT_THAT(misspelled.errors,
              HasSubstr("joint 'tial_pan' is not a servo of vehicle 'ers7'; did you mean 'tail_pan'?"));
  EXPECT_EQ(text_of_file(file), text_of_file(source(wave)));
  // An alias sets the joint that the motion names.
  EXPECT_EQ(motion({"edit", "set", file, "--at", "1", "PRM:/r2/c1-Joint2:21=12.5"}).exit_code, 0);
  EXPECT_THAT(text_of_file(file), HasSubstr("lf_swing: 12.5"));
}

TEST(Motion, AWorldIncludesAShippedOneByName) {
  const ScratchFolder folder;
  write_file(folder.file("greet.yaml"),
             "shoal: 1\nmotion: greet\nvehicle: ers7\nkeys: [{at_s: 0, joints: {head_pan: 0}}]\n");
  write_file(folder.file("my_world.yaml"),
             "shoal: 1\ninclude: ers7_studio.yaml\nvehicles:\n  - name: dog\n    overrides:\n"
             "      devices.player.motions: [{file: greet.yaml}]\n"
             "      devices.player.play: {motion: greet, repeat: -1}\n");
  const Ended ended =
      run_shoal({"run", folder.file("my_world.yaml"), "--bus", "none", "--speed", "max", "--duration", "0.1"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  write_file(folder.file("lost.yaml"), "shoal: 1\ninclude: ers7_stduio.yaml\n");
  EXPECT_THAT(run_shoal({"check", folder.file("lost.yaml")}).errors, HasSubstr("lost.yaml:2:10: cannot read '"));
}

TEST(Motion, IsComparedWithSmallDifferencesAndAVerdict) {
  const ScratchFolder folder;
  const std::string head = "shoal: 1\nmotion: m\nkeys: [{at_s: 0, joints: {a: 0, b: 1, c: 2}}, {at_s: 1, joints: {a: ";
  write_file(folder.file("a.yaml"), head + "1}}]\n");
  write_file(folder.file("b.yaml"), head + "1.00002}}]\n");
  const auto compare = [&](const std::string& other, const std::string& tolerance) {
    return motion({"compare", folder.file("a.yaml"), folder.file(other), "--tolerance", tolerance});
  };
  const Ended differ = compare("b.yaml", "0");
  EXPECT_EQ(differ.exit_code, 1);
  EXPECT_THAT(differ.output, testing::ContainsRegex("\na +2e-05 +1\\.000 +1\\.2e-05 +0\\.008\n2 joints: 0\n"));
  EXPECT_THAT(differ.output, testing::EndsWith("greatest difference 2e-05 deg\nthey differ\n"));
  const Ended within = compare("b.yaml", "0.001");
  EXPECT_EQ(within.exit_code, 0);
  EXPECT_THAT(within.output, testing::EndsWith("\nequal within 0.001 deg\n"));
  EXPECT_THAT(compare("a.yaml", "0").output,
              testing::EndsWith("\n3 joints: 0\n1.000 s and 1.000 s; greatest difference "
                                "0 deg\nequal\n"));
}

TEST(Motion, IsPlayedInTheWorldOfItsRecordingWithAVerdict) {
  const ScratchFolder folder;
  const auto play = [&](const std::string& world) {
    write_file(folder.file("m.yaml"),
               "shoal: 1\nmotion: m\nkeys: [{at_s: 0, joints: {head_pan: 0}}, {at_s: 0.1, joints: {head_pan: 1}}]\n"
               "recorded: {world: " +
                   world +
                   ", vehicle: dog, seed: 1, state_hash: '0000000000000001', "
                   "set: [vehicles.dog.position_m=1]}\n");
    return motion({"play", folder.file("m.yaml"), "--world", source("worlds/ers7_studio.yaml"), "--settle", "0.5"});
  };
  const Ended other = play("ers7_studio");
  EXPECT_EQ(other.exit_code, 1) << other.errors;
  EXPECT_THAT(other.output, testing::EndsWith("it was recorded with --set 'vehicles.dog.position_m=1'\nthe final state "
                                              "differs from that of the recording\n"));
  EXPECT_THAT(other.output, testing::ContainsRegex("state hash at the end of the motion [0-9a-f]{16}\n"));
  EXPECT_THAT(other.output, testing::ContainsRegex("state hash after 0\\.5 s of settling [0-9a-f]{16}\n"));
  // The joint of the motion is the first row.
  EXPECT_THAT(other.output, testing::ContainsRegex("rms deg\nhead_pan "));
  const Ended elsewhere = play("harbour");
  EXPECT_EQ(elsewhere.exit_code, 0);
  EXPECT_THAT(elsewhere.output, testing::EndsWith("recorded in world 'harbour', so that the states at the end are not "
                                                  "compared\n"));
}

TEST(Motion, SaysWhatIsWrong) {
  const ScratchFolder folder;
  write_file(folder.file("bad.yaml"), "shoal: 1\nmotion: m\nkeys: [{at_s: x, joints: {a: 1}}]\n");
  const Ended bad = motion({"check", folder.file("bad.yaml")});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.errors, HasSubstr("bad.yaml:3:15: key 1: 'at_s' must be a number"));
  write_file(folder.file("lost.yaml"), "shoal: 1\nmotion: m\nkeys: [{at_s: 0, joints: {a: 1}}]\n");
  EXPECT_THAT(motion({"check", folder.file("lost.yaml")}).errors, HasSubstr("the motion names no vehicle"));
  EXPECT_THAT(motion({"show", source("worlds/minimal.yaml")}).errors, HasSubstr("this is a world, not a motion"));
  EXPECT_THAT(
      motion({"edit", "trim", source(wave), "--from", "3", "--to", "99", "--output", folder.file("x.yaml")}).errors,
      HasSubstr("from 0 to 9 s, got 3 to 99"));
  EXPECT_THAT(motion({"edit", "set", source(wave), "--at", "1", "knee", "--output", folder.file("x.yaml")}).errors,
              HasSubstr("must be JOINT=VALUE, got 'knee'"));
  EXPECT_THAT(motion({"edit", "simplify", source(wave), "--tolerance", "-1", "--output", folder.file("x.yaml")}).errors,
              HasSubstr("--tolerance: must be from 0 to 360, got '-1'"));
  write_file(folder.file("walk.motion"), "#WEBOTS_MOTION,V1.0,knee\n00:00:000,Pose1,0\n");
  EXPECT_THAT(motion({"play", folder.file("walk.motion"), "--world", source("worlds/ers7_studio.yaml")}).errors,
              HasSubstr("walk.motion: looks like the format 'webots'; `shoal motion import` reads it"));
  EXPECT_THAT(motion({"play", source(wave), "--world", source("worlds/minimal.yaml")}).errors,
              HasSubstr("has a motion_player"));
}

TEST(Motion, IsEvolvedToAGaitThatIsAnOrdinaryMotionFile) {
  const ScratchFolder folder;
  const std::string world = source("worlds/ers7_studio.yaml");
  std::string first;
  for (const std::string threads : {"1", "2"}) {
    const std::string file = folder.file("walk.yaml");
    const Ended ended = motion({"evolve",
                                "--world",
                                world,
                                "--gait",
                                "half_ellipse",
                                "--candidates",
                                "20",
                                "--population",
                                "10",
                                "--worlds",
                                "2",
                                "--fresh",
                                "2",
                                "--measure",
                                "0.5",
                                "--threads",
                                threads,
                                "--output",
                                file,
                                "--overwrite"});
    EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
    EXPECT_THAT(ended.errors, HasSubstr("20 of 20 candidates: best "));
    EXPECT_THAT(ended.output, HasSubstr("in 2 fresh worlds: "));
    const std::string both = ended.output + text_of_file(file);
    if (first.empty()) first = both;
    EXPECT_EQ(both, first);
  }
  EXPECT_EQ(motion({"check", folder.file("walk.yaml")}).exit_code, 0);
  EXPECT_THAT(motion({"show", folder.file("walk.yaml")}).output, HasSubstr("motion 'walk' of ers7"));
  // It loops: it is played for a time, and its stability is that of one round.
  const Ended played =
      motion({"play", folder.file("walk.yaml"), "--world", world, "--loop-time", "3", "--settle", "0"});
  EXPECT_EQ(played.exit_code, 0) << played.output << played.errors;
  EXPECT_THAT(played.output, HasSubstr("\n3.000 s simulated"));
  const Ended stable = motion({"stability", folder.file("walk.yaml"), "--world", world, "--every", "0.1",
                               "--directions", "2", "--watch", "0.1"});
  EXPECT_THAT(stable.output, HasSubstr("\n   0.100"));
}

TEST(Motion, KeysOfAMotionAreEvolvedAndThePageHasTheCurve) {
  const ScratchFolder folder;
  write_file(folder.file("sway.yaml"),
             "shoal: 1\nmotion: sway\nvehicle: ers7\nease: smooth\nloop: true\nkeys:\n"
             "  - {at_s: 0, joints: {lf_knee: 30, rf_knee: 30, lh_knee: 30, rh_knee: 30}}\n"
             "  - {at_s: 0.5, joints: {lf_knee: 40, rf_knee: 30}}\n"
             "  - {at_s: 1, joints: {lf_knee: 30, rf_knee: 30, lh_knee: 30, rh_knee: 30}}\n");
  const std::string world = source("worlds/ers7_studio.yaml"), output = folder.file("walk.yaml");
  const Ended ended = motion({"evolve",
                              "--world",
                              world,
                              "--gait",
                              "free_keys",
                              "--motion",
                              folder.file("sway.yaml"),
                              "--candidates",
                              "8",
                              "--population",
                              "4",
                              "--worlds",
                              "0",
                              "--fresh",
                              "0",
                              "--measure",
                              "0.5",
                              "--output",
                              output,
                              "--page",
                              folder.file("page.html")});
  EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("\nkey2.lf_knee "));
  EXPECT_EQ(motion({"check", output}).exit_code, 0);
  const std::string page = text_of_file(folder.file("page.html"));
  EXPECT_THAT(page, HasSubstr("<h1>Search for a gait: walk</h1>"));
  EXPECT_THAT(page, HasSubstr("<polyline points=\""));
  EXPECT_THAT(page, HasSubstr("<td>key2.lf_knee</td>"));
  const Ended again = motion({"evolve", "--world", world, "--output", output});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.errors, HasSubstr("walk.yaml' exists; --overwrite replaces it"));
  EXPECT_THAT(
      motion({"evolve", "--world", world, "--output", folder.file("y.yaml"), "--page", folder.file("page.html")})
          .errors,
      HasSubstr("page.html' exists; --overwrite replaces it"));
  const Ended alone =
      motion({"evolve", "--world", world, "--gait", "free_keys", "--output", folder.file("other.yaml")});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.errors, HasSubstr("--motion FILE and --gait free_keys need each other"));
}

TEST(Motion, PosesAreConnectedByName) {
  const ScratchFolder folder;
  const std::string world = source("worlds/ers7_studio.yaml"), output = folder.file("rise.yaml");
  const Ended ended = motion({"connect", "bow", source("vehicles/motions/ers7/stand.yaml") + ":crouch", "--world",
                              world, "--worlds", "1", "--output", output});
  EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("world 1   straight: arrived"));
  EXPECT_EQ(motion({"check", output}).exit_code, 0);
  // The front swings: bow has -60 degrees, crouch -40.
  EXPECT_THAT(text_of_file(output), HasSubstr("lf_swing: -60"));
  EXPECT_THAT(text_of_file(output), HasSubstr("lf_swing: -40"));
  EXPECT_THAT(text_of_file(output), HasSubstr("motion: rise\n"));
  EXPECT_THAT(motion({"connect", "bow", "crouch", "--world", world, "--output", output}).errors,
              HasSubstr("rise.yaml' exists; --overwrite replaces it"));
  const Ended unknown = motion({"connect", "bow", "bwo", "--world", world, "--output", folder.file("other.yaml")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.errors,
              HasSubstr("'bwo' is neither a motion file, nor a pose or motion of vehicle 'ers7'; known: "
                        "bow, crouch, "));
}

TEST(Motion, IsNotEvolvedWithoutLegsOrCandidates) {
  const ScratchFolder folder;
  const std::string output = folder.file("walk.yaml");
  const Ended none = motion({"evolve", "--world", source("worlds/minimal.yaml"), "--output", output});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.errors, HasSubstr("minimal.yaml: no vehicle has a motion_player"));
  const Ended few =
      motion({"evolve", "--world", source("worlds/ers7_studio.yaml"), "--output", output, "--candidates", "8"});
  EXPECT_EQ(few.exit_code, 2);
  EXPECT_THAT(few.errors, HasSubstr("--candidates must be at least --population, a generation: 16"));
}

TEST(Motion, OfAWorldIsStartedByItsEvents) {
  const Ended ended = run_shoal({"run", source("worlds/ers7_show.yaml"), "--bus", "none", "--speed", "max",
                                 "--duration", "16", "--set", "pass=[dog.max_deg < 25]"});
  EXPECT_EQ(ended.exit_code, 0) << ended.output << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("passed: dog.max_deg < 25"));
}

}  // namespace
