// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/diagnostics.hpp"

#include <gtest/gtest.h>

namespace {

using sim::ConfigError;
using sim::Diagnostics;
using sim::SourcePlace;
using Lines = std::vector<std::string>;

TEST(SourcePlace, IsWrittenAsEditorsExpectIt) {
  const std::string* file = sim::intern_file_name("worlds/harbor.yaml");
  EXPECT_EQ((SourcePlace{file, 14, 7}.text()), "worlds/harbor.yaml:14:7");
  EXPECT_EQ((SourcePlace{file, 0, 0}.text()), "worlds/harbor.yaml");
  EXPECT_EQ(SourcePlace{}.text(), "");
}

TEST(SourcePlace, OneFileNameIsKeptOnce) {
  EXPECT_EQ(sim::intern_file_name("a.yaml"), sim::intern_file_name(std::string("a.yaml")));
  EXPECT_NE(sim::intern_file_name("a.yaml"), sim::intern_file_name("b.yaml"));
}

TEST(Diagnostics, ALineIsPlaceWhoAndText) {
  Diagnostics diagnostics;
  const SourcePlace place{sim::intern_file_name("w.yaml"), 2, 3};
  diagnostics.error(place, "vehicle 'auv1'", "is lost");
  diagnostics.error(place, "", "is late");
  diagnostics.error({}, "", "is lost");
  EXPECT_EQ(diagnostics.lines(), (Lines{"w.yaml:2:3: vehicle 'auv1': is lost", "w.yaml:2:3: is late", "is lost"}));
}

TEST(Diagnostics, AMistakeAtOnePlaceIsKeptOnceForAllWhoMakeIt) {
  Diagnostics diagnostics;
  const SourcePlace place{sim::intern_file_name("auv.yaml"), 2, 3};
  for (const char* who : {"vehicle 'auv1'", "vehicle 'auv2'"}) diagnostics.error(place, who, "is lost");
  EXPECT_EQ(diagnostics.lines(), Lines{"auv.yaml:2:3: vehicle 'auv1': is lost"});
}

TEST(Diagnostics, TheSameLineIsKeptOnce) {
  Diagnostics diagnostics;
  for (int i = 0; i < 3; ++i) diagnostics.error({}, "a", "b");
  EXPECT_EQ(diagnostics.lines(), Lines{"a: b"});
}

TEST(Diagnostics, ALineHasNoControlCharacters) {
  Diagnostics diagnostics;
  diagnostics.error({}, "vehicle 'a\nb\x1b[2J\x7f\xc2\x9b'", "x\ty");
  EXPECT_EQ(diagnostics.lines(), Lines{"vehicle 'a\\nb\\x1b[2J\\x7f\\x9b': x\\ty"});
  sim::Diagnostics turned;
  turned.error({}, "a", "x\xe2\x80\xaey\xe2\x81\xa6z\xe2\x80\xa6");  // U+202E, U+2066, and an ellipsis
  EXPECT_EQ(turned.lines(), Lines{"a: x\\xe2\\x80\\xaey\\xe2\\x81\\xa6z\xe2\x80\xa6"});
}

TEST(Diagnostics, StopsAfterAThousandLines) {
  Diagnostics diagnostics;
  for (int i = 0; i < 5000; ++i) diagnostics.error({}, "", std::to_string(i));
  ASSERT_EQ(diagnostics.lines().size(), 1001u);
  EXPECT_EQ(diagnostics.lines().back(), "more errors are not shown");
}

TEST(Diagnostics, ThrowsAllItsLines) {
  Diagnostics diagnostics;
  EXPECT_NO_THROW(diagnostics.throw_if_any());
  diagnostics.error({}, "", "one");
  diagnostics.error({}, "", "two");
  try {
    diagnostics.throw_if_any();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "one\ntwo");
    EXPECT_EQ(error.lines(), (Lines{"one", "two"}));
  }
}

}  // namespace
