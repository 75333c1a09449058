// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_pieces.hpp"

#include <gtest/gtest.h>

#include "shoal/message_codec.hpp"

namespace {

using experiment::in_pieces;
using experiment::Snapshot;
using experiment::SnapshotPieces;

/// Of some 200 kB: four pieces.
Snapshot small_example() {
  Snapshot s;
  s.step = 1'000;
  s.step_us = 10'000;
  s.state = sim::Bytes(200'000, std::byte{5});
  for (std::size_t i = 0; i < s.state.size(); ++i) s.state[i] = static_cast<std::byte>(i * i >> 3);
  s.scores = sim::Bytes(100, std::byte{6});
  return s;
}

TEST(SnapshotPieces, MakeTheSnapshotAgainWithoutItsScores) {
  const auto pieces = in_pieces(small_example(), 2, 7);
  ASSERT_EQ(pieces.size(), 4u);
  SnapshotPieces together;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    EXPECT_LE(shoal::encode(pieces[i]).size(), 65'000u);
    EXPECT_EQ(pieces[i].utime, 10'000'000);
    EXPECT_EQ(pieces[i].branch, 2);
    EXPECT_EQ(pieces[i].input_sequence, 7);
    const auto bytes = together.add(pieces[i]);
    ASSERT_EQ(bytes.has_value(), i == 3) << i;
    if (!bytes) continue;
    const Snapshot again = experiment::snapshot_from_bytes(*bytes, "again");
    EXPECT_EQ(again.state, small_example().state);
    EXPECT_TRUE(again.scores.empty());
  }
  EXPECT_EQ(together.missing(), "");
}

TEST(SnapshotPieces, SaysWhichAreMissing) {
  const auto pieces = in_pieces(small_example(), 0, 0);
  SnapshotPieces middle;
  for (const int i : {0, 3}) EXPECT_FALSE(middle.add(pieces[static_cast<std::size_t>(i)]));
  EXPECT_EQ(middle.missing(), "pieces 2 to 3 of 4 of the snapshot of step 1000 are missing");
  SnapshotPieces end;
  for (const int i : {0, 1, 2, 2, 0}) EXPECT_FALSE(end.add(pieces[static_cast<std::size_t>(i)]));
  EXPECT_EQ(end.missing(), "piece 4 of 4 of the snapshot of step 1000 is missing");
  EXPECT_TRUE(end.add(pieces[3]));
}

TEST(SnapshotPieces, AnotherSnapshotBeginsAnew) {
  const auto first = in_pieces(small_example(), 0, 0), second = in_pieces(small_example(), 1, 5);
  SnapshotPieces together;
  EXPECT_FALSE(together.add(first[0]));
  EXPECT_FALSE(together.add(first[2]));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(together.add(second[i]));
  EXPECT_TRUE(together.add(second[3]));
}

TEST(SnapshotPieces, RefusesWhatCannotBe) {
  SnapshotPieces together;
  for (const auto& [piece, pieces, bytes] :
       {std::tuple<int, int, std::int64_t>{-1, 4, 100}, {4, 4, 100}, {0, 0, 100}, {0, 1, -1}}) {
    shoal::sim_snapshot_t bad = in_pieces(small_example(), 0, 0)[0];
    bad.piece = piece;
    bad.pieces = pieces;
    bad.bytes = bytes;
    EXPECT_THROW(together.add(bad), shoal::MessageError) << piece << " of " << pieces << ", " << bytes;
  }
  shoal::sim_snapshot_t more = in_pieces(small_example(), 0, 0)[0];
  more.bytes = 10;  // it has 60 000
  EXPECT_THROW(together.add(more), shoal::MessageError);
}

}  // namespace
