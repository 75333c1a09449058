// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "bridges/log/event_log.hpp"
#include "bridges/log/mcap_conversion.hpp"
#include "bridges/log/recording_bus.hpp"
#include "bridges/mcap/mcap_reader.hpp"

namespace mcap_conversion_fixture {

inline std::uint64_t count_messages(const std::string& path) {
  bridges::mcap::McapReader reader(path);
  std::uint64_t messages = 0;
  for (bridges::mcap::McapReader::Item item; (item = reader.next()) != bridges::mcap::McapReader::Item::end;)
    messages += item == bridges::mcap::McapReader::Item::message;
  EXPECT_TRUE(reader.complete());
  return messages;
}

}  // namespace mcap_conversion_fixture
