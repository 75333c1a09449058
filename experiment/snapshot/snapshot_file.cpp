// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/snapshot/snapshot_file.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>

#include "experiment/files/part_file.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "sim/base/crc32.hpp"
#include "sim/config/message_text.hpp"
#include "sim/state/state_archive.hpp"

namespace experiment {

namespace {

constexpr char magic[8] = {'S', 'H', 'O', 'A', 'L', 'S', 'N', 'P'};
constexpr std::uint32_t format_version = 2;
constexpr std::size_t head_bytes = sizeof magic + sizeof format_version;
constexpr std::size_t checksum_bytes = sizeof(std::uint32_t);
constexpr std::intmax_t max_bytes = std::intmax_t{4} << 30;

template <typename T>
T number_at(const sim::Bytes& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void visit(sim::StateArchive& archive, Snapshot& s) {
  archive.section("file");
  archive(s.version, s.world, s.resolved_world, s.files, s.seed, s.epoch_us, s.step_us, s.step, s.branch, s.from_s,
          s.state_hash, s.vehicles, s.state, s.scores, s.owners);
  archive.end();
}

/// First part of the content in every format: the version of shoal that wrote it.
std::string written_by(const sim::Bytes& bytes) {
  std::string version;
  try {
    auto archive = sim::StateArchive::restorer(std::span(bytes).subspan(head_bytes));
    archive.section("file");
    archive(version);
  } catch (const sim::SnapshotError&) {
    return "";
  }
  return ": shoal " + sim::shortened(sim::printable(version)) +
         " wrote it, and only the same build can continue from it";
}

SnapshotFileError cannot(const std::string& doing, const std::string& path, int error_number) {
  return SnapshotFileError(path + ": cannot be " + doing + ": " + std::strerror(error_number));
}

void write_all(int fd, const sim::Bytes& bytes, const std::string& path) {
  std::span<const std::byte> left = bytes;
  while (!left.empty()) {
    const ssize_t written = ::write(fd, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw cannot("written", path, errno);
    left = left.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace

sim::Bytes to_bytes(const Snapshot& snapshot) {
  sim::StateArchive archive = sim::StateArchive::saver();
  archive.raw(const_cast<char*>(magic), sizeof magic);  // only read
  std::uint32_t version = format_version;
  archive(version);
  visit(archive, const_cast<Snapshot&>(snapshot));  // saving changes nothing
  sim::Bytes bytes = archive.take_bytes();
  const std::uint32_t sum = sim::crc32(bytes);
  const auto* from = reinterpret_cast<const std::byte*>(&sum);
  bytes.insert(bytes.end(), from, from + sizeof sum);
  return bytes;
}

Snapshot snapshot_from_bytes(const sim::Bytes& bytes, const std::string& path) {
  const auto fail = [&](const std::string& what) -> SnapshotFileError { return SnapshotFileError(path + ": " + what); };
  // Signature, version and checksum.
  if (bytes.size() < sizeof magic || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
    throw fail("is not a Shoal snapshot: it must start with 'SHOALSNP'");
  if (bytes.size() < head_bytes + checksum_bytes) throw fail(fmt::format("is cut off after {} bytes", bytes.size()));
  const auto version = number_at<std::uint32_t>(bytes, sizeof magic);
  if (version != format_version)
    throw fail(fmt::format("its format version must be {}, got {}{}", format_version, version, written_by(bytes)));
  const std::size_t content = bytes.size() - checksum_bytes;
  const auto expected = number_at<std::uint32_t>(bytes, content);
  const std::uint32_t sum = sim::crc32(std::span(bytes).first(content));
  if (sum != expected)
    throw fail(fmt::format("is damaged or cut off: its checksum must be {:08x}, got {:08x}", expected, sum));
  // Content.
  Snapshot snapshot;
  try {
    auto archive = sim::StateArchive::restorer(std::span(bytes).subspan(head_bytes, content - head_bytes));
    visit(archive, snapshot);
  } catch (const sim::SnapshotError& error) {
    throw fail(error.what());
  }
  // Plausible times.
  const bool possible = snapshot.step >= 0 && snapshot.step_us > 0 && snapshot.step < INT64_MAX / 4 / snapshot.step_us;
  if (!possible) throw fail(fmt::format("step {} of {} us is invalid", snapshot.step, snapshot.step_us));
  if (snapshot.epoch_us < -INT64_MAX / 2 || snapshot.epoch_us > INT64_MAX / 2)
    throw fail(fmt::format("the epoch {} us is too far away", snapshot.epoch_us));
  return snapshot;
}

void write_snapshot(const std::string& path, const Snapshot& snapshot) {
  const sim::Bytes bytes = to_bytes(snapshot);
  // The number of the process, so that two runs do not write one file.
  PartFile<SnapshotFileError> file(path, ".part" + std::to_string(getpid()));
  write_all(file.number(), bytes, path);
  // Some file systems cannot be synchronized (EINVAL).
  if (fsync(file.number()) != 0 && errno != EINVAL) throw cannot("written", path, errno);
  file.finish();
}

Snapshot read_snapshot(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) throw cannot("read", path, errno);
  if (!S_ISREG(status.st_mode)) throw SnapshotFileError(path + ": is not a regular file");
  if (status.st_size > max_bytes) throw SnapshotFileError(path + ": is larger than 4 GB");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw cannot("read", path, errno);
  sim::Bytes bytes(static_cast<std::size_t>(status.st_size));
  in.read(reinterpret_cast<char*>(bytes.data()), status.st_size);
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return snapshot_from_bytes(bytes, path);
}

void check_version(const Snapshot& snapshot, const std::string& path, const std::string& own_version) {
  if (snapshot.version == own_version) return;
  throw SnapshotFileError(path + ": was written by shoal " + sim::shortened(sim::printable(snapshot.version)) +
                          ", this is " + own_version + ": only the same build can continue from it");
}

void check_files(const Snapshot& snapshot, const std::string& path) {
  const std::vector<std::string> changed = changed_files(snapshot.files);
  if (changed.empty()) return;
  std::string text = path + ": these input files of its world changed since it was written:";
  for (const std::string& file : changed) text += "\n  " + sim::printable(file);
  throw SnapshotFileError(text);
}

}  // namespace experiment
