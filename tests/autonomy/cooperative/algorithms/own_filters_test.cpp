// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;
using test::far_m;
using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

TEST(DeadReckoning, HearsNothingAndSaysNothing) {
  const auto dr = started("dr", nav_setup(2, 0, {0, 0}, 1));
  dr->predict(100 * nav_second, {1, 2}, 0.01 * Matrix2::Identity());
  const auto other = started("naive", nav_setup(2, 1, {500, 0}, 1));
  dr->on_range(received_from(1, other->make_payload(0, 100), 450));
  EXPECT_TRUE(dr->make_payload(100 * nav_second, 100).empty());
  const Estimate estimate = dr->now(101 * nav_second);
  EXPECT_TRUE(estimate.p_W.isApprox(Vector2(101, 202)));
  EXPECT_TRUE(estimate.P.isApprox(2 * Matrix2::Identity()));  // 1 + 0.01 * 100
}

TEST(Naive, AddsTheVarianceOfTheSenderToThatOfTheRange) {
  const auto own = started("naive", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  // S = 4 + 9 + 1 = 14: it moves by 4 / 14 of the innovation of 14 m.
  const Estimate estimate = own->now(0);
  EXPECT_NEAR(estimate.p_W.x(), 4, 1e-4);
  EXPECT_NEAR(estimate.P(0, 0), 4 - 16.0 / 14, 1e-4);
  EXPECT_NEAR(estimate.P(1, 1), 4, 1e-6);
}

TEST(Naive, CountsItsOwnInformationAgain) {
  const auto own = started("naive", nav_setup(2, 0, {0, 0}, 2));
  const auto other = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 20; ++i) {
    own->on_range(received_from(1, other->make_payload(0, 100), far_m));
    other->on_range(received_from(0, own->make_payload(0, 100), far_m));
  }
  // Together they know x_0 - x_1 to 1 m / sqrt(40), and the mean of both to 1 / (1 / 4 + 1 / 9): x_0 to 1.66 m.
  EXPECT_LT(std::sqrt(own->now(0).P(0, 0)), 0.8);
}

TEST(NaiveWithoutClocks, TakesTheErrorOfItsClockForOneOfItsPosition) {
  navigation::Setup setup = nav_setup(2, 0, {0, 0}, 2);
  setup.team[0].errors.clock_s = 0.002;  // 3 m
  const auto with_clock = started("naive", setup), without = started("naive_clockless", setup);
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  for (const auto& own : {with_clock.get(), without.get()})
    own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 7));
  EXPECT_NEAR(with_clock->now(0).p_W.x(), 7 * 4.0 / (4 + 9 + 9 + 1), 1e-3);
  EXPECT_NEAR(without->now(0).p_W.x(), 7 * 4.0 / (4 + 9 + 1), 1e-3);
  EXPECT_EQ(without->now(0).clock_error_s, 0);
}

TEST(NaiveOfDeadReckoning, SaysWhatItKnowsWithoutRanges) {
  const auto own = started("naive_dr", nav_setup(2, 0, {0, 0}, 2));
  const Bytes before = own->make_payload(0, 100);
  const auto sender = started("naive_dr", nav_setup(2, 1, {-far_m, 0}, 0.1));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 10));
  EXPECT_LT(own->now(0).P(0, 0), 1);
  EXPECT_EQ(own->make_payload(0, 100), before);
}

TEST(CovarianceIntersection, DoesNotUseARangeThatDoesNotPay) {
  // Inflating a round covariance of 4 by 1 / w costs more than a range to a sender of 9 gives, for all w.
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("ci", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 1));
  EXPECT_TRUE(own->now(0).P.isApprox(4 * Matrix2::Identity()));
  EXPECT_EQ(own->now(0).p_W.x(), 0);
}

TEST(CovarianceIntersection, InflatesBothByTheWeightOfLeastTrace) {
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("ci", nav_setup(2, 1, {-far_m, 0}, 0.1));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 1));
  const Estimate estimate = own->now(0);
  const double w = 4 / estimate.P(1, 1);  // across the line P1 = P / w is unchanged
  EXPECT_GT(w, 0.5);
  EXPECT_LT(w, 1);
  const auto along = [](double weight) {
    return 4 / weight - (16 / (weight * weight)) / (4 / weight + 0.01 / (1 - weight) + 1);
  };
  EXPECT_NEAR(estimate.P(0, 0), along(w), 1e-4);
  const double S = 4 / w + 0.01 / (1 - w) + 1;
  EXPECT_NEAR(estimate.p_W.x(), 4 / w / S, 1e-4);
  // No other weight gives less.
  for (double other = 0.02; other < 1; other += 0.02) EXPECT_LE(estimate.P.trace(), 4 / other + along(other) + 1e-4);
}

TEST(CovarianceIntersection, TakesASenderWithSatellitesAsIndependent) {
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("ci", nav_setup(2, 1, {-far_m, 0}, 1e4));
  sender->fix(0, {-far_m, 0}, 3);
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  EXPECT_NEAR(own->now(0).p_W.x(), 4, 1e-4);  // as naive
}

TEST(CovarianceIntersection, IsNeverTooSureOfCommonInformation) {
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto other = started("ci", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 100; ++i) {
    own->on_range(received_from(1, other->make_payload(0, 100), far_m, 0.01));
    other->on_range(received_from(0, own->make_payload(0, 100), far_m, 0.01));
  }
  // The best that anyone can know is 1 / (1 / 4 + 1 / 9).
  EXPECT_GE(own->now(0).P(0, 0), 36.0 / 13);
}

TEST(SplitCovarianceIntersection, IsExactForIndependentSenders) {
  const auto own = started("sci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("sci", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  // Both have own measurements only: as naive.
  EXPECT_NEAR(own->now(0).p_W.x(), 4, 0.01);
  EXPECT_NEAR(own->now(0).P(0, 0), 4 - 16.0 / 14, 0.01);
}

TEST(SplitCovarianceIntersection, ADependentPartIsInflatedAndStaysDependent) {
  // A sender of Bd = 8 and Bi = 1, R = 1, own Pi = 4: P1 = 4, P2 = 8 / (1 - w) + 1 is least for w = 0.01, the least
  // weight.
  const auto own = started("sci", nav_setup(2, 0, {0, 0}, 2));
  Bytes payload;
  PayloadWriter writer(payload);
  write_position(writer, {{-far_m, 0}, 9 * Matrix2::Identity()});
  write_covariance(writer, Matrix2::Identity());
  own->on_range(received_from(1, payload, far_m + 10));
  const double S = 4 + 8 / 0.99 + 1 + 1, K = 4 / S;
  const Estimate estimate = own->now(0);
  EXPECT_NEAR(estimate.p_W.x(), 10 * K, 1e-3);
  EXPECT_NEAR(estimate.P(0, 0), 4 - 16 / S, 1e-3);
  // Pi+ = (1 - K)^2 4 + K^2 R; what it says is rounded up to 1 cm of the deviation.
  const auto independent_m2 = [](const Bytes& bytes) {
    PayloadReader reader(bytes);
    read_position(reader);
    return (*read_covariance(reader))(0, 0);
  };
  EXPECT_NEAR(independent_m2(own->make_payload(0, 100)), (1 - K) * (1 - K) * 4 + K * K, 0.04);
  EXPECT_NEAR(independent_m2(own->make_payload(0, 100)), 0, 1e-3);  // what it said, others may have
}

TEST(SplitCovarianceIntersection, IsNeverTooSureOfCommonInformation) {
  const auto own = started("sci", nav_setup(2, 0, {0, 0}, 2));
  const auto other = started("sci", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 100; ++i) {
    own->on_range(received_from(1, other->make_payload(0, 100), far_m, 0.01));
    other->on_range(received_from(0, own->make_payload(0, 100), far_m, 0.01));
  }
  // The best that anyone can know is 1 / (1 / 4 + 1 / 9).
  EXPECT_GE(own->now(0).P(0, 0), 36.0 / 13 - 0.01);
}

// On straight lines of equal range, with a linear motion, least squares over the trajectory are the Kalman filter.
TEST(FixedLagSmoother, IsTheKalmanFilterOfALinearProblem) {
  navigation::Setup setup = nav_setup(2, 0, {0, 0}, 2);
  setup.team[0].errors.clock_s = 0.001;
  setup.team[0].errors.clock_drift = 1e-6;  // a state without noise
  const auto smoother = started("fls", setup), filter = started("naive", setup);
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 1; i <= 30; ++i) {  // 300 s: the oldest are marginalized
    const Time now = 10 * i * nav_second;
    for (const auto& own : {smoother.get(), filter.get()}) {
      own->predict(now, {0.1, 0}, 0.01 * Matrix2::Identity());
      own->on_range(received_from(1, sender->make_payload(0, 100), far_m + i + (i % 3), 1, now));
      if (i % 10 == 0) own->fix(now, {i + 0.5, -0.2}, 1);
    }
    const Estimate a = smoother->now(now), b = filter->now(now);
    EXPECT_NEAR((a.p_W - b.p_W).norm(), 0, 1e-3) << i;  // points of equal range bend by (2 m)^2 / far_m
    EXPECT_TRUE(a.P.isApprox(b.P, 1e-3)) << i;
    EXPECT_NEAR(a.clock_error_s, b.clock_error_s, 1e-6) << i;
  }
}

TEST(FixedLagSmoother, FindsAStartThatIsWrongByHundredsOfMeters) {
  navigation::Setup setup = nav_setup(3, 0, {0, 0}, 200);
  const auto smoother = started("fls", setup);
  const auto west = started("naive", nav_setup(3, 1, {-300, 0}, 0.1));
  const auto south = started("naive", nav_setup(3, 2, {0, -300}, 0.1));
  const Vector2 truth(150, 220);  // at rest
  for (int i = 1; i <= 6; ++i) {
    const Time now = 10 * i * nav_second;
    smoother->predict(now, {0, 0}, 1e-4 * Matrix2::Identity());
    const bool is_west = i % 2 == 0;
    const Vector2 sender = is_west ? Vector2(-300, 0) : Vector2(0, -300);
    const Bytes payload = (is_west ? west : south)->make_payload(0, 100);
    smoother->on_range(received_from(is_west ? 1 : 2, payload, (truth - sender).norm(), 1, now));
  }
  EXPECT_NEAR((smoother->now(60 * nav_second).p_W - truth).norm(), 0, 2);  // 4 sigma of 6 ranges of 1 m
}

TEST(CoopAuvFilter, AddsTheVarianceOfTheSenderToThatOfTheRange) {
  const auto own = started("coop_auv", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  const Estimate estimate = own->now(0);  // S = 4 + 9 + 1
  EXPECT_NEAR(estimate.p_W.x(), 4, 1e-3);
  EXPECT_NEAR(estimate.P(0, 0), 4 - 16.0 / 14, 1e-3);
}

TEST(CoopAuvFilter, DoubtsASenderThatContradictsAndStillUsesTheOther) {
  navigation::Setup setup = nav_setup(3, 0, {0, 0}, 2);
  setup.gate = 10.83;
  const auto own = started("coop_auv", setup);
  const auto west = started("naive", nav_setup(3, 1, {-far_m, 0}, 1)),
             south = started("naive", nav_setup(3, 2, {0, -far_m}, 1));
  Time now = 0;
  const auto receive = [&](int sender, const Bytes& payload, double range_m) {
    now += nav_second;
    own->predict(now, {0, 0}, 1e-6 * Matrix2::Identity());
    own->on_range(received_from(sender, payload, range_m, 1, now));
  };
  for (int i = 0; i < 6; ++i) receive(1, west->make_payload(0, 100), far_m + 500);
  receive(1, west->make_payload(0, 100), far_m + 1);  // agrees, but it is in doubt
  EXPECT_NEAR(own->now(now).p_W.x(), 0, 1e-9);
  receive(2, south->make_payload(0, 100), far_m + 6);
  EXPECT_NEAR(own->now(now).p_W.y(), 6 * 4.0 / (4 + 1 + 1), 1e-3);
}

/// A rover that has driven 10 m east.
std::unique_ptr<Estimator> driven_rover() {
  auto rover = started("coop_rover", nav_setup(2, 0, {5, 0}, 0.1));
  for (int i = 1; i <= 10; ++i) rover->predict(i * nav_second, {1, 0}, 100 * Matrix2::Identity());
  return rover;
}

TEST(CoopRoverFilter, HasTheErrorsOfOdometryOfTheProgram) {
  const Estimate estimate = driven_rover()->now(10.5 * nav_second);
  EXPECT_NEAR(estimate.p_W.x(), 5 + 10.5, 1e-9);
  EXPECT_NEAR(estimate.P(0, 0), 0.1 * 0.1 + 0.03 * 0.03 * 10, 1e-9);
  // Across: slip, and the random walk of the heading over the rest of each way, m^2: 0.015^2 (9^2 + ... + 1).
  EXPECT_NEAR(estimate.P(1, 1), 0.1 * 0.1 + 0.01 * 0.01 * 10 + 0.015 * 0.015 * 285, 1e-9);
}

TEST(CoopRoverFilter, UsesASightFromItsHeading) {
  const auto rover = driven_rover();
  const auto other = started("naive", nav_setup(2, 1, {15, 4}, 0.2));
  const Bytes payload = other->make_payload(0, 100);
  Relative seen;
  seen.time = 10 * nav_second;
  seen.other = 1;
  seen.range_m = 4.1;  // north of it, 0.1 m too far
  seen.bearing_rad = std::numbers::pi / 2;
  seen.range_std_m = 0.1;
  seen.payload = payload;
  rover->on_bearing(seen);
  // Across, as above, with the error of the heading, 0.015^2 (9 + ... + 1), which a relative measurement from 4 m away
  // shows along.
  const double R = 0.2 * 0.2 + 0.1 * 0.1, across = 0.1 * 0.1 + 0.01 * 0.01 * 10 + 0.015 * 0.015 * 285;
  const double both = 4 * 0.015 * 0.015 * 45;
  const double along = 0.1 * 0.1 + 0.03 * 0.03 * 10 + 4 * 4 * 0.015 * 0.015 * 10 + R;
  const double gain = (across * along - both * both) / (along * (across + R) - both * both);
  EXPECT_NEAR(rover->now(10 * nav_second).p_W.y(), -0.1 * gain, 1e-6);
}

TEST(CoopRoverFilter, SendsItsPositionWithGpsOnlyAndNotBetterThanAFix) {
  const auto rover = driven_rover();
  EXPECT_TRUE(rover->make_payload(10 * nav_second, 100).empty());
  rover->fix(10 * nav_second, {15, 0}, 0.5);
  const auto sent = position_in(rover->make_payload(10 * nav_second, 100));
  ASSERT_TRUE(sent);
  EXPECT_NEAR(sent->P(0, 0), 0.5 * 0.5, 1e-9);
  EXPECT_NEAR(sent->P(1, 1), 0.5 * 0.5, 1e-9);
}

TEST(CoopRoverFilter, UsesFixesBeforeItMoves) {
  const auto rover = started("coop_rover", nav_setup(2, 0, {0, 0}, 1));
  rover->fix(0, {3, 0}, 1);
  const Estimate estimate = rover->now(0);  // K = 1 / 2
  EXPECT_NEAR(estimate.p_W.x(), 1.5, 1e-12);
  EXPECT_NEAR(estimate.P(0, 0), 0.5, 1e-12);
}

TEST(ParticleStart, FindsAnUnknownStartByTheRangesOfThreeSenders) {
  navigation::Setup setup = nav_setup(4, 0, {0, 0}, 1000);
  const auto filter = started("pf", setup);
  const Vector2 truth(400, -250);
  const Vector2 senders[] = {{0, 0}, {500, 0}, {0, 500}};
  for (int i = 0; i < 12; ++i) {
    const Time now = 10 * (i + 1) * nav_second;
    filter->predict(now, {0, 0}, 1e-3 * Matrix2::Identity());
    const Vector2 sender = senders[i % 3];
    const auto other = started("naive", nav_setup(4, 1 + i % 3, sender, 0.5));
    filter->on_range(received_from(1 + i % 3, other->make_payload(0, 100), (truth - sender).norm(), 1, now));
  }
  EXPECT_NEAR((filter->now(120 * nav_second).p_W - truth).norm(), 0, 3);
  EXPECT_LT(filter->now(120 * nav_second).P.trace(), 9);
}

TEST(ParticleStart, IsNaiveAfterAKnownStart) {
  const auto filter = started("pf", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  filter->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  EXPECT_NEAR(filter->now(0).p_W.x(), 4, 1e-4);
}

TEST(Algorithms, ThatNeedMoreBytesAreRefusedAtTheStart) {
  navigation::Setup setup = nav_setup(2, 0, {0, 0}, 1);
  setup.payload_bytes = 22;
  for (const char* name : {"osm", "deif"}) {
    try {
      started(name, setup);
      FAIL() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("bytes of payload, these have 22"), std::string::npos) << error.what();
    }
  }
}

TEST(Algorithms, IgnorePayloadsOfOthers) {
  for (const Algorithm* algorithm : all_algorithms()) {
    if (!algorithm->make) continue;
    const auto own = started(algorithm->name, nav_setup(2, 0, {0, 0}, 2));
    for (const Bytes& payload : {Bytes{}, Bytes{1}, Bytes(12, 255), Bytes(30, 0), Bytes(113, 255), Bytes(200, 7)})
      own->on_range(received_from(1, payload, 100));
    EXPECT_TRUE(own->now(0).p_W.allFinite()) << algorithm->name;
  }
}

TEST(Algorithms, SayNoMoreThanTheyMay) {
  for (const Algorithm* algorithm : all_algorithms()) {
    if (!algorithm->make) continue;
    const auto own = started(algorithm->name, nav_setup(4, 0, {0, 0}, 2));
    own->predict(nav_second, {1, 0}, 0.1 * Matrix2::Identity());
    EXPECT_LE(own->make_payload(nav_second, 118).size(), 118U) << algorithm->name;
  }
}

TEST(Algorithms, AnUnknownNameListsTheKnownOnes) {
  try {
    algorithm_named("kalman");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("unknown algorithm 'kalman'; known algorithms: cekf, ci,"),
              std::string::npos);
  }
}

}  // namespace
