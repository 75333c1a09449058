// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "autonomy/cooperative/estimator/estimator.hpp"

namespace navigation {

/// Writer of numbers of few bytes, big-endian, at the end of a payload.
class PayloadWriter {
 public:
  explicit PayloadWriter(Bytes& bytes) : bytes_(bytes) {}

  /// Writes the low `size` bytes of an unsigned number, or the largest number of that size.
  void whole(std::uint64_t value, int size);
  /// Writes a number in units of `step`, rounded, limited to what `size` bytes hold with a sign.
  void fixed(double value, double step, int size);
  /// Writes a float of 4 bytes, or with `size` 8 a double.
  void real(double value, int size = 4);

 private:
  Bytes& bytes_;
};

/// Reader of these numbers.  After a read beyond the end ok() is false, and all further numbers are 0.
class PayloadReader {
 public:
  explicit PayloadReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  std::uint64_t whole(int size);
  double fixed(double step, int size);
  double real(int size = 4);
  bool ok() const { return ok_; }
  std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::uint8_t> rest_;
  bool ok_ = true;
};

/// Position with covariance, as most algorithms send it.
struct Position {
  Vector2 p_W = Vector2::Zero();
  Matrix2 P = Matrix2::Identity();
};

/// Size of a Position: east, north 3 bytes each, in cm; two standard deviations, in cm, rounded up, and the correlation
/// 2 bytes each.
inline constexpr std::size_t position_bytes = 12;
/// Appends a position.  The covariance that is read is not smaller than the written one in its diagonal; deviations are
/// limited to 1 cm to 655.35 m.
void write_position(PayloadWriter& writer, const Position& position);
/// Reads a position; std::nullopt if bytes are missing or no position was written.
std::optional<Position> read_position(PayloadReader& reader);

/// Appends a covariance in 6 bytes, as in a position.
void write_covariance(PayloadWriter& writer, const Matrix2& P);
std::optional<Matrix2> read_covariance(PayloadReader& reader);

}  // namespace navigation
