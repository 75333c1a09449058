// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/utf8.hpp"

#include <gtest/gtest.h>

namespace {

TEST(Utf8, CharactersHaveOneToFourBytes) {
  EXPECT_EQ(sim::utf8_length("a"), 1u);
  EXPECT_EQ(sim::utf8_length("\u00e9"), 2u);
  EXPECT_EQ(sim::utf8_length("\u20ac"), 3u);
  EXPECT_EQ(sim::utf8_length("\U0001f600"), 4u);
  EXPECT_EQ(sim::utf8_length("a\u20ac", 1), 3u);
}

TEST(Utf8, TheLargestAndSmallestCharacterOfEachLengthIsValid) {
  for (const char* text : {"\xc2\x80", "\xdf\xbf"}) EXPECT_EQ(sim::utf8_length(text), 2u);
  for (const char* text : {"\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80", "\xef\xbf\xbf"})
    EXPECT_EQ(sim::utf8_length(text), 3u);
  for (const char* text : {"\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) EXPECT_EQ(sim::utf8_length(text), 4u);
}

TEST(Utf8, WhatRfc3629ForbidsIsInvalid) {
  EXPECT_EQ(sim::utf8_length("\x80"), 0u);              // begins in the middle of a character
  EXPECT_EQ(sim::utf8_length("\xc1\xbf"), 0u);          // 0x7f with two bytes
  EXPECT_EQ(sim::utf8_length("\xe0\x9f\xbf"), 0u);      // 0x7ff with three
  EXPECT_EQ(sim::utf8_length("\xf0\x8f\xbf\xbf"), 0u);  // 0xffff with four
  EXPECT_EQ(sim::utf8_length("\xed\xa0\x80"), 0u);      // the surrogate 0xd800
  EXPECT_EQ(sim::utf8_length("\xf4\x90\x80\x80"), 0u);  // 0x110000
  EXPECT_EQ(sim::utf8_length("\xf5\x80\x80\x80"), 0u);
}

TEST(Utf8, ACharacterThatIsCutOffIsInvalid) {
  EXPECT_EQ(sim::utf8_length("\xe2\x82"), 0u);
  EXPECT_EQ(sim::utf8_length("\xe2\x82x"), 0u);
}

TEST(Utf8, OtherBytesBecomeTheirCodes) {
  EXPECT_EQ(sim::in_utf8("caf\u00e9"), "caf\u00e9");
  EXPECT_EQ(sim::in_utf8("caf\xe9s"), "caf\\xe9s");  // of Latin 1
  EXPECT_EQ(sim::in_utf8("\xe2\x82"), "\\xe2\\x82");
  EXPECT_EQ(sim::in_utf8(""), "");
}

TEST(Utf8, AMarkAtTheBeginningIsRemovedOnce) {
  EXPECT_EQ(sim::without_byte_order_mark("\xef\xbb\xbfx"), "x");
  EXPECT_EQ(sim::without_byte_order_mark("\xef\xbb\xbf\xef\xbb\xbfx"), "\xef\xbb\xbfx");
  EXPECT_EQ(sim::without_byte_order_mark("x"), "x");
}

}  // namespace
