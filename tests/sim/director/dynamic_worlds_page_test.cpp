// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

/// The ```yaml blocks of a page.
std::vector<std::string> snippets(const std::string& path) {
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::string> found;
  const std::string open = "```yaml\n";
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
    at += open.size();
    found.push_back(text.substr(at, text.find("```", at) - at));
  }
  return found;
}

TEST(LivingWorldsPage, HasSnippetsThatLoadAndRun) {
  const auto all = snippets(test_support::source_path("docs/guides/dynamic_worlds.md"));
  ASSERT_EQ(all.size(), 5u);
  std::string world = "shoal: 1\nobjects:\n  - {name: ground, fixed: true, parts: [{shape: plane}]}\n";
  int x = 30;
  for (const std::string name : {"forklift", "door", "crate", "pallet_a", "pallet_b", "visitor"})
    world += "  - {name: " + name + ", position_m: [" + std::to_string(x += 3) +
             ", 0, 1], present: " + (name == "visitor" ? "false" : "true") + ", parts: [{shape: box, mass_kg: 5}]}\n";
  world += "vehicles: [{name: rover1, file: rover_gps.yaml}]\n";
  for (const std::string& snippet : all) {
    const std::string key = "objects:\n";
    std::string with_snippet = world + snippet;
    if (snippet.starts_with(key))
      with_snippet = std::string(world).insert(world.find(key) + key.size(), snippet.substr(key.size()));
    test::TestWorld test(with_snippet);
    test.run_for(11);
    EXPECT_EQ(test.world.counts().bad_messages, 0) << snippet;
  }
}

}  // namespace
