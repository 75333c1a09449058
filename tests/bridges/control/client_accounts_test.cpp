// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/bridges/lockstep/lockstep_fixture.hpp"

namespace {

/// A world with a limit on spawn requests.
struct LimitedWorld : lcm_test::ServedWorld {
  LimitedWorld() : ServedWorld("shoal: 1\nphysics: {step_s: 0.01}\nlimits: {spawns_per_client: 2}\n") {}
  std::string spawn(const std::string& name, const std::string& client) {
    const std::string at_m = std::to_string(3 * ++places);
    const auto reply =
        request_reply("spawn", 0,
                      "{name: " + name + ", position_m: [" + at_m +
                          ", 0, 0], model: {shoal: 1, bodies: [{name: b, parts: [{shape: box, mass_kg: 1}]}]}}",
                      client);
    return reply.ok ? "ok" : reply.text;
  }
  int places = 0;
};

TEST(Limits, OnSpawnsAreOfEachClientAndOfAllTogether) {
  LimitedWorld w;
  EXPECT_EQ(w.spawn("a1", "a"), "ok");
  EXPECT_NE(w.spawn("a1", "a"), "ok");  // the name is taken: it does not count
  EXPECT_EQ(w.spawn("a2", "a"), "ok");
  EXPECT_EQ(w.spawn("a3", "a"),
            "client 'a' has used up its 2 spawn requests; see limits.spawns_per_client of the world");
  for (int i = 0; i < 9; ++i)
    for (const std::string n : {"1", "2"}) EXPECT_EQ(w.spawn("b" + std::to_string(i) + n, std::to_string(i)), "ok");
  EXPECT_EQ(w.spawn("c", "c"),
            "all clients together have made 20 spawn requests; see limits.spawns_per_client of the world");
}

}  // namespace
