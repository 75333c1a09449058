// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/payload.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace navigation {

namespace {

constexpr double cm = 0.01;
constexpr double max_deviation_m = 655.35;
constexpr double correlation_step = 1.0 / 32767;

std::uint64_t largest(int size) {
  return size >= 8 ? ~std::uint64_t{0} : (std::uint64_t{1} << (8 * size)) - 1;
}

}  // namespace

void PayloadWriter::whole(std::uint64_t value, int size) {
  value = std::min(value, largest(size));
  for (int i = size - 1; i >= 0; --i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void PayloadWriter::fixed(double value, double step, int size) {
  const double limit = static_cast<double>(largest(size) >> 1);
  const double steps = std::isnan(value) ? 0 : std::clamp(std::round(value / step), -limit, limit);
  whole(static_cast<std::uint64_t>(static_cast<std::int64_t>(steps)) & largest(size), size);
}

void PayloadWriter::real(double value, int size) {
  if (size == 8)
    whole(std::bit_cast<std::uint64_t>(value), 8);
  else
    whole(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}

std::uint64_t PayloadReader::whole(int size) {
  const auto count = static_cast<std::size_t>(size);
  if (!ok_ || rest_.size() < count) {
    ok_ = false;
    return 0;
  }
  std::uint64_t value = 0;
  for (const std::uint8_t byte : rest_.first(count)) value = value << 8 | byte;
  rest_ = rest_.subspan(count);
  return value;
}

double PayloadReader::fixed(double step, int size) {
  std::uint64_t value = whole(size);
  if ((value >> (8 * size - 1)) != 0) value |= ~largest(size);
  return static_cast<double>(static_cast<std::int64_t>(value)) * step;
}

double PayloadReader::real(int size) {
  double value =
      size == 8 ? std::bit_cast<double>(whole(8)) : std::bit_cast<float>(static_cast<std::uint32_t>(whole(4)));
  if (!std::isfinite(value)) {
    ok_ = false;
    value = 0;
  }
  return value;
}

void write_covariance(PayloadWriter& writer, const Matrix2& P) {
  for (int i = 0; i < 2; ++i) {
    const double deviation_m = std::sqrt(std::max(0.0, P(i, i)));
    writer.whole(static_cast<std::uint64_t>(std::ceil(std::clamp(deviation_m, cm, max_deviation_m) / cm - 1e-9)), 2);
  }
  const double product = std::sqrt(P(0, 0) * P(1, 1));
  writer.fixed(product > 0 ? std::clamp(P(0, 1) / product, -0.9999, 0.9999) : 0, correlation_step, 2);
}

std::optional<Matrix2> read_covariance(PayloadReader& reader) {
  const double east_m = static_cast<double>(reader.whole(2)) * cm;
  const double north_m = static_cast<double>(reader.whole(2)) * cm;
  const double correlation = reader.fixed(correlation_step, 2);
  if (!reader.ok() || !(east_m > 0) || !(north_m > 0) || !(std::abs(correlation) < 1)) return std::nullopt;
  Matrix2 P;
  P << east_m * east_m, correlation * east_m * north_m, correlation * east_m * north_m, north_m * north_m;
  return P;
}

void write_position(PayloadWriter& writer, const Position& position) {
  for (int i = 0; i < 2; ++i) writer.fixed(position.p_W[i], cm, 3);
  write_covariance(writer, position.P);
}

std::optional<Position> read_position(PayloadReader& reader) {
  Position position;
  for (int i = 0; i < 2; ++i) position.p_W[i] = reader.fixed(cm, 3);
  const auto P = read_covariance(reader);
  if (!P) return std::nullopt;
  position.P = *P;
  return position;
}

}  // namespace navigation
