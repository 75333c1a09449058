// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/system/shoal_program.hpp"

// The programs of a world go back with it: a run that goes back and changes nothing ends as one that never did.

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::IsEmpty;

struct RewoundMission {
  const char* world;
  const char* duration_s;
  std::vector<std::string> times_s;  ///< some are ticks of the programs, some lie between them
  std::vector<std::string> options = {};
};

std::vector<std::string> mission(const RewoundMission& of, const std::vector<std::string>& more = {}) {
  // On a busy machine a program may take longer than the usual 10 s to answer.
  std::vector<std::string> run{"run",     source(of.world), "--launch",    "--speed",
                               "max",     "--duration",     of.duration_s, "--lcm-url",
                               own_url(), "--no-plots",     "--set",       "lockstep.timeout_s=1000"};
  run.insert(run.end(), of.options.begin(), of.options.end());
  run.insert(run.end(), more.begin(), more.end());
  return run;
}

/// Runs a world to its end, and goes back on the way: from the first time by the second, and once more from the third
/// by the fourth.
Ended run_with_two_rewinds(const RewoundMission& of, const std::string& results) {
  const std::vector<std::string>& times_s = of.times_s;
  std::vector<std::string> arguments = mission(of, {"--paused", "--results", results});
  arguments.insert(arguments.begin(), built("shoal"));
  Program program(arguments);
  for (std::size_t i = 0; i < times_s.size(); i += 2) {
    run_until(times_s[i]);
    // After the first the run stands still: on a busy machine it would be over before the next `until` comes.
    std::vector<std::string> rewind{"rewind", "--value", times_s[i + 1]};
    if (i + 2 == times_s.size()) rewind.insert(rewind.begin() + 1, "run");
    const Ended back = control(rewind);
    EXPECT_EQ(back.exit_code, 0) << back.errors;
  }
  Ended ended;
  ended.exit_code = program.wait();
  ended.output = program.output();
  ended.errors = program.errors();
  return ended;
}

class ProgramsGoBack : public testing::TestWithParam<RewoundMission> {};

TEST_P(ProgramsGoBack, AndTheRunEndsAsOneThatNeverWentBack) {
  const RewoundMission& of = GetParam();
  const Ended straight = run_shoal(mission(of));
  const ScratchFolder folder;
  const Ended ended = run_with_two_rewinds(of, folder.file("results"));
  EXPECT_EQ(ended.exit_code, straight.exit_code) << ended.output << ended.errors;
  EXPECT_EQ(run_hash_in(ended), run_hash_in(straight));
  EXPECT_THAT(ended.output, HasSubstr("branch 2: the run was rewound"));
  const auto summary = nlohmann::json::parse(text_of_file(folder.file("results/summary.json")));
  EXPECT_THAT(summary["processes"], IsEmpty()) << "a program ended before the run did";
  ASSERT_FALSE(summary["clients"].empty());
  for (const auto& client : summary["clients"]) EXPECT_EQ(client["ended"], "with the run") << client;
}

/// To a file that was written on the way: at a tick of the programs and between two.
TEST_P(ProgramsGoBack, ToAFileOfTheirRunAsWell) {
  const RewoundMission& of = GetParam();
  const Ended straight = run_shoal(mission(of));
  const ScratchFolder folder;
  std::vector<std::string> arguments =
      mission(of, {"--paused", "--results", folder.file("results"), "--snapshots", folder.file("snaps")});
  arguments.insert(arguments.begin(), built("shoal"));
  Program program(arguments);
  run_until(of.times_s[0]);
  EXPECT_EQ(control({"snapshot", "a"}).exit_code, 0);
  run_until(of.times_s[2]);
  for (int times = 0; times < 2; ++times) {
    const Ended restored = control({"restore", "a"});
    EXPECT_EQ(restored.exit_code, 0) << restored.errors;
    if (times == 0) run_until(of.times_s[2]);
  }
  EXPECT_EQ(control({"resume"}).exit_code, 0);
  const int exit_code = program.wait();
  EXPECT_EQ(exit_code, straight.exit_code) << program.output() << program.errors();
  EXPECT_EQ(run_hash_in({exit_code, program.output(), program.errors()}), run_hash_in(straight));
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, ProgramsGoBack,
    testing::Values(RewoundMission{"worlds/segway.yaml", "30", {"9.005", "4.5", "14", "6.035"}},
                    RewoundMission{"worlds/ball_chase.yaml", "6", {"3.005", "1.5", "5", "2.035"}},
                    RewoundMission{"worlds/slam_days.yaml", "120", {"55.5", "20", "90", "40.3"}},
                    RewoundMission{"worlds/find_the_way.yaml", "120", {"55.5", "20", "90", "40.3"}},
                    RewoundMission{"worlds/coop_land.yaml", "30", {"12.34", "5", "20", "11.27"}},
                    RewoundMission{"worlds/coop_underwater.yaml", "150", {"90", "33.3", "120", "40.14"}},
                    RewoundMission{"worlds/coop_relay.yaml", "200", {"150", "20", "160", "50.3"}},
                    RewoundMission{"worlds/ranger_dock.yaml", "130", {"90", "33.3", "120", "40.14"}},
                    RewoundMission{"worlds/avoid_rovers.yaml", "30", {"12.34", "5", "20", "11.27"}},
                    RewoundMission{"worlds/formation.yaml", "60", {"40", "5.3", "50", "41.14"}},
                    // Small steps, so that times lie between the ticks of the programs.
                    RewoundMission{"worlds/benchmark/09_thermocline.yaml",
                                   "150",
                                   {"90", "33.3", "120", "40.14"},
                                   {"--set", "physics.step_s=0.005"}}),
    [](const auto& test) {
      const std::string path = test.param.world;
      const std::size_t name = path.rfind('/') + 1;
      return path.substr(name, path.find('.') - name);
    });

TEST(Rewind, AProgramThatIsNotToGoBackEndsAndSaysSo) {
  const ScratchFolder folder;
  const std::string world = folder.file("segway.yaml");
  std::string text = text_of_file(source("worlds/segway.yaml"));
  const std::string args = "args: {name: segway1";
  ASSERT_NE(text.find(args), std::string::npos);
  text.insert(text.find(args) + args.size(), ", rewind_s: 2");
  const std::string file = "file: segway_rmp.yaml";
  text.replace(text.find(file), file.size(), "file: " + source("vehicles/segway_rmp.yaml"));
  write_file(world, text);
  std::vector<std::string> arguments{built("shoal"), "run", world,      "--launch",  "--speed", "max",
                                     "--duration",   "20",  "--paused", "--lcm-url", own_url()};
  Program program(arguments);
  run_until("8");
  EXPECT_EQ(control({"rewind", "run", "--value", "5"}).exit_code, 0);
  EXPECT_NE(program.wait(), 0);  // no one balances it any more
  EXPECT_THAT(program.errors(),
              HasSubstr("the world was rewound further than this program supports, 2 s (--rewind-s)"));
  EXPECT_THAT(program.output(), HasSubstr("process 'balance' exited with code 6"));
}

}  // namespace
