// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/state_hash.hpp"
#include "sim/state/enum_values.hpp"

namespace sim {

/// Invalid snapshot: truncated, damaged, or of another world.  what() names the part of the state.
class SnapshotError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Hash of one part of the state.
struct PartHash {
  std::string part;  ///< such as `auv1/dvl`
  std::uint64_t hash = 0;
  bool operator==(const PartHash&) const = default;
};

/// Archive that hashes, saves or restores the whole state.  A class with state has one function for all three purposes,
/// so that a snapshot cannot omit a member:
///
///     void visit_state(StateArchive& archive) { archive(charge_, reading_, noise_); }
/// archive(...) accepts numbers, enumerations, texts, durations, fixed-size Eigen types, the containers below of these
/// types, and every class with visit_state().  Derived state is computed again when archive.restoring().  Hashing and
/// saving do not modify the state. Restored data are untrusted.  The archive refuses values that are not enumerators,
/// numbers that are not finite or exceed max_number, and times more than max_time from the start.  visit_state() must
/// check all other invariants, such as indices, counts and times used for planning, with require() when
/// archive.restoring().
class StateArchive {
 public:
  /// Makes an archive that hashes; result in hash() and parts().
  static StateArchive hasher() { return StateArchive(Purpose::hash); }
  /// Makes an archive that hashes without parts(), for callers that need hash() only.
  static StateArchive quick_hasher() {
    StateArchive archive(Purpose::hash);
    archive.keeps_parts_ = false;
    return archive;
  }
  /// Makes an archive that saves; result in take_bytes().  `about_bytes`: expected size, so that memory is allocated
  /// once.
  static StateArchive saver(std::size_t about_bytes = 0) {
    StateArchive archive(Purpose::save);
    archive.output_.reserve(about_bytes);
    return archive;
  }
  /// Makes an archive that restores from bytes, which must outlive it.
  static StateArchive restorer(std::span<const std::byte> bytes) {
    StateArchive archive(Purpose::restore);
    archive.input_ = bytes;
    return archive;
  }

  bool hashing() const { return purpose_ == Purpose::hash; }
  bool saving() const { return purpose_ == Purpose::save; }
  bool restoring() const { return purpose_ == Purpose::restore; }

  /// Starts a part of the state and ends the previous one.  `name` identifies the part in errors and differences.
  /// Restoring throws SnapshotError when the snapshot has another part here, or the previous part was longer.
  void section(std::string_view name);
  /// Ends the last part.  Restoring throws SnapshotError when bytes are left over.
  void end();
  /// Throws SnapshotError with the name of the part: for well-formed but impossible state.
  [[noreturn]] void fail(const std::string& what) const;
  /// Throws SnapshotError with the name of the part when a restored value is outside of [low, high]; `what` names it.
  /// Does nothing while hashing and saving.
  template <typename T>
  void require(const T& value, const std::type_identity_t<T>& low, const std::type_identity_t<T>& high,
               std::string_view what) const {
    if (restoring() && !(value >= low && value <= high)) fail_range(what);
  }

  /// Largest magnitude of a restored number: larger than any physical quantity, and small enough that squares do not
  /// overflow.
  static constexpr double max_number = 1e100;
  /// Largest magnitude of a restored time or duration: 31 years.
  static constexpr std::chrono::microseconds max_time{1'000'000'000'000'000};

  template <typename... Values>
  void operator()(Values&... values) {
    (visit(values), ...);
  }
  /// Visits values in which NaN and infinity are valid, such as an unset target.
  template <typename... Values>
  void not_only_finite(Values&... values) {
    const bool before = std::exchange(finite_only_, false);
    (visit(values), ...);
    finite_only_ = before;
  }
  /// Visits values that are saved and restored but not hashed, because they do not influence the simulation, such as
  /// counts for a summary.
  template <typename... Values>
  void unhashed(Values&... values) {
    if (!hashing()) (visit(values), ...);
  }
  /// Checks that the number of objects, `size`, is the same in the world and in the snapshot.
  void expect_count(std::size_t size, std::string_view of);

  /// Returns the hash of all parts, and of the values visited outside of them.
  std::uint64_t hash() const {
    StateHash all = total_;
    if (in_part_ || !had_parts_) all.add(part_hash_.value());
    return all.value();
  }
  /// Returns the hashes of the parts, in order.
  const std::vector<PartHash>& parts() const { return parts_; }
  std::vector<std::byte> take_bytes() { return std::move(output_); }

  /// Returns the number of unread bytes of the part or the snapshot.
  std::size_t bytes_left() const { return left(); }

  /// Visits raw memory.
  void raw(void* data, std::size_t size) {
    if (hashing())
      part_hash_.add_bytes(data, size);
    else
      save_or_restore(data, size);
  }

 private:
  enum class Purpose { hash, save, restore };
  explicit StateArchive(Purpose purpose) : purpose_(purpose) {}

  void save_or_restore(void* data, std::size_t size);

  template <typename T>
  static constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
  template <typename T>
  static constexpr bool has_names = std::is_enum_v<T> && !std::is_same_v<T, std::byte>;

  template <typename T>
  void visit(T& value) {
    if constexpr (is_plain<T>) {
      scalar(value);
    } else {
      visit_class(value);
    }
  }
  template <typename T>
  void scalar(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      if (restoring()) {
        unsigned char byte = 0;
        raw(&byte, 1);
        if (byte > 1) fail("a flag that is neither true nor false");
        value = byte == 1;
        return;
      }
    }
    if (!hashing()) {
      save_or_restore(&value, sizeof value);
      if (restoring()) check_scalar(value);
      return;
    }
    if constexpr (std::is_floating_point_v<T>)
      part_hash_.add(static_cast<double>(value));
    else
      part_hash_.add(static_cast<std::uint64_t>(value));
  }
  /// Checks a restored value.
  template <typename T>
  void check_scalar(const T& value) const {
    if constexpr (std::is_floating_point_v<T>) {
      const bool finite = std::abs(value) <= max_number;
      if (!finite && (finite_only_ || std::isfinite(value))) fail_number(static_cast<double>(value));
    } else if constexpr (has_names<T>) {
      if (!detail::is_enumerator(value)) fail("a value out of range");
    }
  }
  template <typename T>
  void check_scalars(const T* values, std::size_t size) const {
    if constexpr (std::is_floating_point_v<T> || has_names<T>)
      for (std::size_t i = 0; restoring() && i < size; ++i) check_scalar(values[i]);
  }
  template <typename T>
  requires requires(T& value, StateArchive& archive) { value.visit_state(archive); }
  void visit_class(T& value) { value.visit_state(*this); }
  template <typename Rep, typename Period>
  void visit_class(std::chrono::duration<Rep, Period>& value) {
    Rep count = value.count();
    scalar(count);
    value = std::chrono::duration<Rep, Period>(count);
    if (restoring() && (value > max_time || value < -max_time)) fail_range("a time");
  }
  template <typename Scalar, int Rows, int Columns, int Options, int MaxRows, int MaxColumns>
  requires(Rows != Eigen::Dynamic && Columns != Eigen::Dynamic) void visit_class(
      Eigen::Matrix<Scalar, Rows, Columns, Options, MaxRows, MaxColumns>& value) {
    raw(value.data(), sizeof(Scalar) * static_cast<std::size_t>(value.size()));
    check_scalars(value.data(), static_cast<std::size_t>(value.size()));
  }
  template <typename Scalar, int Options>
  void visit_class(Eigen::Quaternion<Scalar, Options>& value) {
    visit(value.coeffs());
  }
  template <typename Scalar, int Dim, int Mode, int Options>
  void visit_class(Eigen::Transform<Scalar, Dim, Mode, Options>& value) {
    visit(value.matrix());
  }
  void visit_class(std::string& text);
  template <typename T>
  void visit_class(std::vector<T>& values) {
    static_assert(!std::is_same_v<T, bool>, "use std::vector<char>");
    if constexpr (is_plain<T>) {
      const std::size_t size = count(values.size(), sizeof(T));
      if (restoring()) values.resize(size);
      raw(values.data(), size * sizeof(T));
      check_scalars(values.data(), size);
    } else {
      sequence(values);
    }
  }
  template <typename T>
  void visit_class(std::deque<T>& values) {
    sequence(values);
  }
  template <typename T, std::size_t size>
  void visit_class(std::array<T, size>& values) {
    for (T& value : values) visit(value);
  }
  template <typename T, std::size_t size>
  void visit_class(T (&values)[size]) {
    for (T& value : values) visit(value);
  }
  template <typename First, typename Second>
  void visit_class(std::pair<First, Second>& value) {
    visit(value.first);
    visit(value.second);
  }
  template <typename T>
  void visit_class(std::optional<T>& value) {
    bool there = value.has_value();
    scalar(there);
    if (restoring()) {
      if (!there)
        value.reset();
      else if (!value)
        value.emplace();
    }
    if (there) visit(*value);
  }
  template <typename T, typename Less>
  void visit_class(std::set<T, Less>& values) {
    const std::size_t size = count(values.size(), 1);
    if (!restoring()) {
      for (T value : values) visit(value);
      return;
    }
    values.clear();
    for (std::size_t i = 0; i < size; ++i) {
      T value{};
      visit(value);
      values.insert(std::move(value));
    }
  }
  template <typename Key, typename T, typename Less>
  void visit_class(std::map<Key, T, Less>& values) {
    const std::size_t size = count(values.size(), 1);
    if (!restoring()) {
      for (auto& [key, value] : values) {
        Key same = key;
        visit(same);
        visit(value);
      }
      return;
    }
    values.clear();
    for (std::size_t i = 0; i < size; ++i) {
      Key key{};
      visit(key);
      visit(values[std::move(key)]);
    }
  }
  template <typename Sequence>
  void sequence(Sequence& values) {
    const std::size_t size = count(values.size(), 1);
    if (values.size() > size) values.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      if (i == values.size()) values.emplace_back();  // grown while reading: a wrong size allocates no memory
      visit(values[i]);
    }
  }
  /// Visits the number of elements that follow.  Restoring throws when the remaining bytes cannot hold that many
  /// elements of at least `bytes_each`.
  std::size_t count(std::size_t size, std::size_t bytes_each);
  [[noreturn]] void fail_short(std::size_t desired) const;
  [[noreturn]] void fail_number(double value) const;
  [[noreturn]] void fail_range(std::string_view what) const;
  /// Returns the remaining bytes of this part, or of the snapshot outside of parts.
  std::size_t left() const { return (in_part_ ? part_end_ : input_.size()) - at_; }
  void end_part();

  Purpose purpose_;
  bool finite_only_ = true;
  StateHash total_, part_hash_;
  bool keeps_parts_ = true;
  bool had_parts_ = false;
  std::vector<PartHash> parts_;
  std::string part_ = "the start";
  std::vector<std::byte> output_;
  std::size_t part_start_ = 0;  // offset of the length of the part in the output
  bool in_part_ = false;
  std::span<const std::byte> input_;
  std::size_t at_ = 0;
  std::size_t part_end_ = 0;  // in the input
};

}  // namespace sim
