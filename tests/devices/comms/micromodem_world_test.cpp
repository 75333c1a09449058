// SPDX-License-Identifier: BSD-3-Clause
// worlds/micromodems.yaml with hosts that type the same at the same steps.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "sim/world/world_state.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

struct Session {
  std::vector<std::uint64_t> hashes;  // after every step
  std::string answers;                // of both modems
  bool operator==(const Session&) const = default;
};

/// One host pings the other, then sends it a frame, which answers.
Session session(int threads) {
  std::ifstream file(test_support::source_path("worlds/micromodems.yaml"));
  test::WorldWithPorts test({std::istreambuf_iterator<char>(file), {}});
  test.world.use_threads(threads);
  EXPECT_EQ(test.ends.size(), 2u);
  std::string& one = test.ends.begin()->second->to_world;
  std::string& two = test.ends.rbegin()->second->to_world;
  Session result;
  for (int step = 0; step < 2000; ++step) {
    if (step == 10) one += "$CCCFG,SRC,1\r\n$CCMPC,1,2\r\n";
    if (step == 400) two += "$CCCYC,0,2,1,0,0,1\r\n";
    if (step == 410) two += "$CCTXD,2,1,0,68656c6c6f\r\n";
    if (step == 1200) one += "$CCMUC,1,2,1234\r\n";
    if (step == 1201) two += "\x80 noise $CC\r\n";
    test.world.step();
    result.hashes.push_back(test.world.state().hash());
  }
  for (const auto& [path, end] : test.ends) result.answers += path + "\n" + end->from_world;
  return result;
}

TEST(MicromodemsWorld, IsTheSameRunForAnyNumberOfThreadsAndASecondTime) {
  const Session expected = session(1);
  EXPECT_NE(expected.answers.find("$CAMPR,2,1,0.5"), std::string::npos) << expected.answers;  // 750 m
  EXPECT_NE(expected.answers.find("$CARXD,2,1,0,1,68656c6c6f"), std::string::npos) << expected.answers;
  EXPECT_NE(expected.answers.find("$CAMUA,1,2,1234"), std::string::npos) << expected.answers;
  for (const int threads : {1, 2, 8}) EXPECT_TRUE(session(threads) == expected) << threads;
}

}  // namespace
