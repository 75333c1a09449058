// SPDX-License-Identifier: BSD-3-Clause
#include "sim/director/world_observer.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

TEST(Occurrence, OfEachKindHasAWordOfItsOwn) {
  using Kind = sim::Occurrence::Kind;
  std::set<std::string> words;
  for (const Kind kind :
       {Kind::event, Kind::fault, Kind::added, Kind::removed, Kind::moved, Kind::changed, Kind::ended})
    words.insert(sim::occurrence_word(kind));
  EXPECT_EQ(words, (std::set<std::string>{"added", "changed", "ended", "event", "fault", "moved", "removed"}));
}

}  // namespace
