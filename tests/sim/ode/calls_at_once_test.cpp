// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "tests/sim/ode/find_contacts_fixture.hpp"

namespace {

using namespace find_contacts_fixture;

TEST(FindContacts, FindsContactsOfMeshesInSeveralThreads) {
  constexpr int count = 20'000;
  const double expected = sum_of_depths(count);
  std::vector<double> sums(4);
  std::vector<std::thread> threads;
  for (double& sum : sums) threads.emplace_back([&sum] { sum = sum_of_depths(count); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(sums, std::vector<double>(4, expected));
}

}  // namespace
