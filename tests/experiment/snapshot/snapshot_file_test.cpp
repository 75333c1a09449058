// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch_folder.hpp"

namespace {

using experiment::Snapshot;
using experiment::SnapshotFileError;
using testing::HasSubstr;
using testing::StartsWith;

Snapshot example() {
  Snapshot s;
  s.version = "1.2.3 (abc)";
  s.world = "harbor";
  s.resolved_world = "shoal: 1\nname: harbor\n";
  s.seed = 7;
  s.epoch_us = 1'000'000'000;
  s.step_us = 10'000;
  s.step = 2'000;
  s.branch = 3;
  s.from_s = 1.5;
  s.state_hash = 0x123456789abcdef0;
  s.vehicles = {"auv1", "usv1"};
  s.state = sim::Bytes(1'000, std::byte{5});
  s.scores = sim::Bytes(10, std::byte{6});
  s.owners = sim::Bytes(3, std::byte{7});
  return s;
}

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const SnapshotFileError& error) {
    return error.what();
  }
  return "no error";
}

std::string error_of_bytes(const sim::Bytes& bytes) {
  return error_of([&] { experiment::snapshot_from_bytes(bytes, "a.snapshot"); });
}

TEST(SnapshotFile, GivesBackAllThatWasWritten) {
  test_support::ScratchFolder folder;
  experiment::write_snapshot(folder.file("a.snapshot"), example());
  const Snapshot read = experiment::read_snapshot(folder.file("a.snapshot"));
  EXPECT_EQ(experiment::to_bytes(read), experiment::to_bytes(example()));
  EXPECT_EQ(read.world, "harbor");
  EXPECT_EQ(read.vehicles, example().vehicles);
  EXPECT_DOUBLE_EQ(read.time_s(), 20);
  EXPECT_EQ(read.utime(), 1'020'000'000);
}

TEST(SnapshotFile, LeavesNothingBesideIt) {
  test_support::ScratchFolder folder;
  for (int i = 0; i < 2; ++i) experiment::write_snapshot(folder.file("a.snapshot"), example());
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("."))) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 1);
}

TEST(SnapshotFile, RefusesOneCutOffAtAnyByte) {
  const sim::Bytes whole = experiment::to_bytes(example());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string error = error_of_bytes({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_THAT(error, StartsWith("a.snapshot: is ")) << size;
  }
}

TEST(SnapshotFile, RefusesOneWithAnyByteChanged) {
  const sim::Bytes whole = experiment::to_bytes(example());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    sim::Bytes damaged = whole;
    damaged[at] ^= std::byte{0x40};
    EXPECT_THAT(error_of_bytes(damaged), StartsWith("a.snapshot: ")) << at;
  }
  sim::Bytes damaged = whole;
  damaged[500] ^= std::byte{1};
  EXPECT_THAT(error_of_bytes(damaged), HasSubstr("is damaged or cut off: its checksum must be "));
}

TEST(SnapshotFile, RefusesForeignFilesAndOtherFormats) {
  EXPECT_EQ(error_of_bytes(sim::Bytes(100, std::byte{'x'})),
            "a.snapshot: is not a Shoal snapshot: it must start with 'SHOALSNP'");
  sim::Bytes other = experiment::to_bytes(example());
  other[8] = std::byte{3};
  EXPECT_EQ(error_of_bytes(other),
            "a.snapshot: its format version must be 2, got 3: shoal 1.2.3 (abc) wrote it, and only the same build can "
            "continue from it");
  other.resize(40);
  EXPECT_EQ(error_of_bytes(other), "a.snapshot: its format version must be 2, got 3");
}

TEST(SnapshotFile, RefusesTimesThatAreNone) {
  Snapshot far = example();
  far.epoch_us = INT64_MAX - 5;
  EXPECT_EQ(error_of_bytes(experiment::to_bytes(far)), "a.snapshot: the epoch 9223372036854775802 us is too far away");
  Snapshot early = example();
  early.step = -1;
  EXPECT_EQ(error_of_bytes(experiment::to_bytes(early)), "a.snapshot: step -1 of 10000 us is invalid");
}

TEST(SnapshotFile, RefusesWhatAnotherBuildWrote) {
  EXPECT_EQ(
      error_of([] { experiment::check_version(example(), "a.snapshot", "1.2.4 (abd)"); }),
      "a.snapshot: was written by shoal 1.2.3 (abc), this is 1.2.4 (abd): only the same build can continue from it");
  EXPECT_NO_THROW(experiment::check_version(example(), "a.snapshot", "1.2.3 (abc)"));
}

TEST(SnapshotFile, SaysWhichFileCannotBeReadOrWritten) {
  test_support::ScratchFolder folder;
  const std::string missing = folder.file("no/such.snapshot");
  EXPECT_EQ(error_of([&] { experiment::read_snapshot(missing); }),
            missing + ": cannot be read: No such file or directory");
  EXPECT_EQ(error_of([&] { experiment::write_snapshot(missing, example()); }),
            missing + ": cannot be written: No such file or directory");
  EXPECT_EQ(error_of([&] { experiment::read_snapshot(folder.file(".")); }),
            folder.file(".") + ": is not a regular file");
  EXPECT_EQ(error_of([&] { experiment::read_snapshot("/dev/zero"); }), "/dev/zero: is not a regular file");
}

}  // namespace
