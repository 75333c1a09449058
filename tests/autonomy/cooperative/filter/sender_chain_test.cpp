// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/filter/sender_chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace {

using namespace navigation;

constexpr Time chain_second = 1'000'000;

/// A vehicle with its origin and its last transmission as copies.
struct Sender {
  JointFilter filter;
  int own, origin;

  Sender() : own(filter.add(DeviceErrors{}, 0, {10, 20}, 1)), origin(filter.copy(own)) {}

  Pair pair(int earlier) const {
    Pair pair;
    const int places[] = {filter.offset(earlier), filter.offset(earlier) + 1, filter.offset(own),
                          filter.offset(own) + 1};
    for (int i = 0; i < 4; ++i) {
      pair.mean[i] = filter.x()[places[i]];
      for (int j = 0; j < 4; ++j) pair.covariance(i, j) = filter.P()(places[i], places[j]);
    }
    return pair;
  }
};

TEST(SenderChain, LinkBetweenTwoPacketsIsThatOfTheSender) {
  Sender sender;
  sender.filter.move(sender.own, 100 * chain_second, {1, 0.5}, 0.01 * Matrix2::Identity());
  const Pair before = sender.pair(sender.origin);
  const int last = sender.filter.copy(sender.own);
  Matrix2 q;
  q << 0.04, 0.01, 0.01, 0.02;
  sender.filter.move(sender.own, 160 * chain_second, {0, 1}, q);
  sender.filter.fix(sender.own, {112, 128}, 2);
  sender.filter.move(sender.own, 200 * chain_second, {0, 1}, q);
  const auto link = link_between(before, sender.pair(sender.origin));
  ASSERT_TRUE(link);
  const ChainLink own = link_of(sender.pair(last), before.mean.tail<2>(), before.covariance.bottomRightCorner<2, 2>());
  EXPECT_TRUE(link->information.isApprox(own.information, 1e-6)) << link->information << "\n\n" << own.information;
  EXPECT_TRUE(link->vector.isApprox(own.vector, 1e-6)) << link->vector << "\n\n" << own.vector;
}

TEST(SenderChain, AdvancingGivesWhatTheSenderKnows) {
  Sender sender;
  sender.filter.move(sender.own, 100 * chain_second, {1, 0}, 0.01 * Matrix2::Identity());
  const Pair before = sender.pair(sender.origin);
  sender.filter.move(sender.own, 200 * chain_second, {0, 1}, 0.03 * Matrix2::Identity());
  sender.filter.fix(sender.own, {111, 119}, 3);
  const Pair after = sender.pair(sender.origin);
  navigation::Setup setup;
  setup.team.resize(2);
  SenderChains chains(setup);
  chains.begin(1, {before.mean.tail<2>(), before.covariance.bottomRightCorner<2, 2>()});
  chains.advance(1, *link_between(before, after));
  EXPECT_TRUE(chains.filter().position(1).isApprox(after.mean.tail<2>(), 1e-9));
  EXPECT_TRUE((chains.filter().covariance(1).isApprox(after.covariance.bottomRightCorner<2, 2>(), 1e-8)));
}

TEST(SenderChain, EqualPacketsHaveNoLink) {
  Sender sender;
  sender.filter.move(sender.own, 100 * chain_second, {1, 0}, 0.01 * Matrix2::Identity());
  const Pair pair = sender.pair(sender.origin);
  EXPECT_FALSE(link_between(pair, pair));
}

}  // namespace
