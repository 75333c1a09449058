// SPDX-License-Identifier: BSD-3-Clause
#include "sim/state/state_archive.hpp"

#include <cstring>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

constexpr std::size_t max_name_bytes = 300;

}  // namespace

void StateArchive::section(std::string_view name) {
  end_part();
  // Hash: start a new part hash.
  if (hashing()) {
    if (keeps_parts_) part_ = name;
    part_hash_ = StateHash();
    in_part_ = had_parts_ = true;
    return;
  }
  part_ = name;
  // Save or restore: name and length of the part.
  std::string text(name);
  visit(text);
  std::uint64_t length = 0;  // known at the end of the part
  if (restoring()) {
    if (text.size() > max_name_bytes || text != name)
      throw SnapshotError("the snapshot has '" + shortened(printable(text)) + "' where this world has '" +
                          std::string(name) + "'");
    scalar(length);
    if (length > input_.size() - at_)
      fail("the snapshot is truncated: " + std::to_string(length) + " bytes should follow, " +
           std::to_string(input_.size() - at_) + " are present");
    part_end_ = at_ + length;
  } else {
    scalar(length);
    part_start_ = output_.size();
  }
  in_part_ = true;
}

void StateArchive::save_or_restore(void* data, std::size_t size) {
  if (saving()) {
    const auto* from = static_cast<const std::byte*>(data);
    output_.insert(output_.end(), from, from + size);
    return;
  }
  if (size > left()) fail_short(size);
  if (size > 0) std::memcpy(data, input_.data() + at_, size);
  at_ += size;
}

void StateArchive::visit_class(std::string& text) {
  const std::size_t size = count(text.size(), 1);
  if (restoring()) text.resize(size);
  raw(text.data(), size);
}

void StateArchive::end() {
  end_part();
  part_ = "the end";
  if (restoring() && at_ != input_.size())
    fail(std::to_string(input_.size() - at_) + " bytes are left over in the snapshot");
}

void StateArchive::end_part() {
  if (!in_part_) return;
  in_part_ = false;
  if (hashing()) {
    if (keeps_parts_) parts_.push_back({part_, part_hash_.value()});
    total_.add(part_hash_.value());
  } else if (saving()) {
    // The length is known now, and fills the gap that was left before the part.
    const std::uint64_t length = output_.size() - part_start_;
    std::memcpy(output_.data() + part_start_ - sizeof length, &length, sizeof length);
  } else if (at_ != part_end_) {
    fail("the snapshot has " + std::to_string(part_end_ - at_) + " bytes more than this world");
  }
}

void StateArchive::fail(const std::string& what) const {
  throw SnapshotError("snapshot: " + part_ + ": " + what);
}

void StateArchive::fail_short(std::size_t desired) const {
  fail("the snapshot ends where " + std::to_string(desired) + " bytes should follow");
}

void StateArchive::fail_number(double value) const {
  fail("the snapshot has the invalid number " + number_text(value) + "");
}

void StateArchive::fail_range(std::string_view what) const {
  fail("the snapshot has an invalid value: " + std::string(what) + "");
}

void StateArchive::expect_count(std::size_t size, std::string_view of) {
  std::uint64_t there = size;
  scalar(there);
  if (there != size)
    fail("the snapshot has " + std::to_string(there) + " " + std::string(of) + ", this world " + std::to_string(size));
}

std::size_t StateArchive::count(std::size_t size, std::size_t bytes_each) {
  std::uint64_t there = size;
  scalar(there);
  if (restoring() && there > left() / bytes_each)
    fail("the snapshot says that " + std::to_string(there) + " elements follow, more than it has bytes for");
  return static_cast<std::size_t>(there);
}

}  // namespace sim
