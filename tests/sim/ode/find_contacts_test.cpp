// SPDX-License-Identifier: BSD-3-Clause
#include "sim/ode/find_contacts.hpp"

#include <gtest/gtest.h>

#include "tests/sim/ode/find_contacts_fixture.hpp"

namespace {

using namespace find_contacts_fixture;

TEST(FindContacts, FindsTheDepthOfASphereInATriangle) {
  // Its center is 0.45 m above the plane, and its radius 0.5 m.
  EXPECT_NEAR(sum_of_depths(100), 100 * 0.05, 1e-9);
}

}  // namespace
