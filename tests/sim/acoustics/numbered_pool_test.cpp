// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/numbered_pool.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using Texts = sim::NumberedPool<std::string>;
using TextId = sim::Id<std::string>;

Texts three() {
  Texts pool;
  for (const char* text : {"a", "b", "c"}) pool[pool.add()] = text;
  return pool;
}

TEST(NumberedPool, TheNumberReleasedLastIsUsedNext) {
  Texts pool = three();
  pool.remove({0});
  pool.remove({2});
  EXPECT_EQ(pool.in_use(), 1u);
  EXPECT_EQ(pool.add().number, 2);
  EXPECT_EQ(pool.add().number, 0);
  EXPECT_EQ(pool.add().number, 3);
  EXPECT_EQ(pool[TextId{0}], "") << "a new object";
  EXPECT_EQ(pool[TextId{1}], "b");
}

TEST(NumberedPool, KnowsWhichNumbersExist) {
  const Texts pool = three();
  EXPECT_TRUE(pool.contains(2));
  EXPECT_FALSE(pool.contains(3));
  EXPECT_FALSE(pool.contains(-1));
  EXPECT_FALSE(TextId{}.valid());
}

void visit(Texts& pool, sim::StateArchive& archive) {
  auto count = static_cast<std::uint64_t>(pool.size());
  archive(count);
  pool.visit_items(archive, count, [&](TextId, std::string& text) { archive(text); });
  pool.visit_free(archive);
}

TEST(NumberedPool, ARestoredPoolGoesOnWithTheSameNumbers) {
  Texts saved = three(), restored;
  saved.remove({1});
  saved.remove({0});
  sim::StateArchive saver = sim::StateArchive::saver();
  visit(saved, saver);
  const std::vector<std::byte> bytes = saver.take_bytes();
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  visit(restored, restorer);
  EXPECT_EQ(restored[TextId{2}], "c");
  EXPECT_EQ(restored.used(restorer), (std::vector<char>{0, 0, 1}));
  EXPECT_EQ(restored.add().number, 0);
  EXPECT_EQ(restored.add().number, 1);
}

TEST(NumberedPool, RefusesANumberThatIsFreeTwiceOrDoesNotExist) {
  const sim::StateArchive archive = sim::StateArchive::saver();
  Texts twice = three();
  twice.remove({1});
  twice.remove({1});
  EXPECT_THROW(twice.used(archive), sim::SnapshotError);
  // Two objects, but the free numbers of a pool of three.
  Texts three_objects = three(), restored;
  three_objects.remove({2});
  sim::StateArchive saver = sim::StateArchive::saver();
  three_objects.visit_items(saver, 2, [&](TextId, std::string& text) { saver(text); });
  three_objects.visit_free(saver);
  const std::vector<std::byte> bytes = saver.take_bytes();
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  restored.visit_items(restorer, 2, [&](TextId, std::string& text) { restorer(text); });
  restored.visit_free(restorer);
  EXPECT_THROW(restored.used(restorer), sim::SnapshotError);
}

}  // namespace
