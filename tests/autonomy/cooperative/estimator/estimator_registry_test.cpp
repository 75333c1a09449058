// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/estimator/estimator_registry.hpp"

#include <gtest/gtest.h>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

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
