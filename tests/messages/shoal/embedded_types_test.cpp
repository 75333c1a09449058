// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "all_message_types.hpp"
#include "shoal/message_codec.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace shoal;

TEST(MessageCodec, KnowsTheTypeOfEveryLcmFile) {
#define SHOAL_ONE(type) +1u
  EXPECT_EQ(embedded_types().all().size(), 0u SHOAL_ALL_MESSAGE_TYPES(SHOAL_ONE));
}

}  // namespace
