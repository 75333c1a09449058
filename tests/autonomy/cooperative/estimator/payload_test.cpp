// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/payload.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using navigation::Bytes;
using navigation::Matrix2;
using navigation::PayloadReader;
using navigation::PayloadWriter;
using navigation::Position;

TEST(Payload, PositionComesBackWithinACentimeter) {
  Position sent;
  sent.p_W << 1234.567, -8.004;
  sent.P << 4, 0.6, 0.6, 0.25;
  Bytes bytes;
  PayloadWriter writer(bytes);
  write_position(writer, sent);
  EXPECT_EQ(bytes.size(), navigation::position_bytes);
  PayloadReader reader(bytes);
  const auto read = read_position(reader);
  ASSERT_TRUE(read);
  EXPECT_NEAR(read->p_W.x(), 1234.57, 1e-9);
  EXPECT_NEAR(read->p_W.y(), -8.00, 1e-9);
  EXPECT_NEAR(read->P(0, 0), 4, 1e-9);
  EXPECT_NEAR(read->P(1, 1), 0.25, 1e-9);
  EXPECT_NEAR(read->P(0, 1), 0.6, 1e-4);  // 1 / 32767 of the product of the deviations
}

TEST(Payload, DeviationsAreRoundedUpSoThatNobodySeemsTooSure) {
  Bytes bytes;
  PayloadWriter writer(bytes);
  write_covariance(writer, 1e-8 * Matrix2::Identity());
  PayloadReader reader(bytes);
  EXPECT_NEAR((*read_covariance(reader))(0, 0), 1e-4, 1e-12);
}

TEST(Payload, MissingBytesAreNoPosition) {
  const Bytes bytes(navigation::position_bytes - 1, 1);
  PayloadReader reader(bytes);
  EXPECT_FALSE(read_position(reader));
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.whole(4), 0U);
}

TEST(Payload, ZerosAreNoCovariance) {
  const Bytes bytes(6, 0);
  PayloadReader reader(bytes);
  EXPECT_FALSE(read_covariance(reader));
}

TEST(Payload, NumbersBeyondTheirBytesAreLimited) {
  Bytes bytes;
  PayloadWriter writer(bytes);
  writer.fixed(1e9, 0.01, 2);
  writer.fixed(-1e9, 0.01, 2);
  writer.fixed(std::numeric_limits<double>::quiet_NaN(), 0.01, 2);
  writer.whole(300, 1);
  PayloadReader reader(bytes);
  EXPECT_NEAR(reader.fixed(0.01, 2), 327.67, 1e-9);
  EXPECT_NEAR(reader.fixed(0.01, 2), -327.67, 1e-9);
  EXPECT_EQ(reader.fixed(0.01, 2), 0);
  EXPECT_EQ(reader.whole(1), 255U);
}

TEST(Payload, RealNumbersAreFinite) {
  Bytes bytes;
  PayloadWriter writer(bytes);
  writer.real(1.5);
  writer.real(0.1, 8);
  writer.real(std::numeric_limits<double>::infinity());
  PayloadReader reader(bytes);
  EXPECT_EQ(reader.real(), 1.5);
  EXPECT_EQ(reader.real(8), 0.1);
  EXPECT_EQ(reader.real(), 0);
  EXPECT_FALSE(reader.ok());
}

}  // namespace
