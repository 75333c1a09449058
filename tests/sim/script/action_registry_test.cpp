// SPDX-License-Identifier: BSD-3-Clause
#include "sim/script/action_registry.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace {

TEST(ActionRegistry, HasItsWordsInOrderAndFindsEach) {
  const sim::ActionRegistry& registry = sim::ActionRegistry::instance();
  const std::vector<std::string> words = registry.words();
  EXPECT_TRUE(std::is_sorted(words.begin(), words.end()));
  EXPECT_EQ(registry.all().size(), words.size());
  for (const std::string& word : words) {
    ASSERT_NE(registry.find(word), nullptr) << word;
    EXPECT_EQ(registry.find(word)->word, word);
  }
  EXPECT_EQ(registry.find("dance"), nullptr);
}

TEST(ActionRegistry, AKindDescribesItsKeysTheMainOneFirst) {
  const sim::ActionKind* move = sim::ActionRegistry::instance().find("move");
  ASSERT_NE(move, nullptr);
  EXPECT_EQ(move->keys().front().key, "name");
  const sim::ParamInfo info = move->info();
  EXPECT_EQ(info.key, "move");
  EXPECT_EQ(info.type, "map");
  EXPECT_EQ(info.children.size(), move->keys().size());
}

TEST(ActionRegistry, AMainValueThatMayStandAloneIsPartOfTheType) {
  EXPECT_EQ(sim::ActionRegistry::instance().find("log")->info().type, "text or map");
}

}  // namespace
