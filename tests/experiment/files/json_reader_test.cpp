// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/json_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace {

using experiment::JsonReader;

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

std::string parse_error(const std::string& text) {
  return error_of([&] { experiment::parse_json(text, "f.json"); });
}

TEST(JsonReader, SaysWhereATextIsNoJson) {
  EXPECT_EQ(parse_error("{\"a\": 1}"), "none");
  EXPECT_EQ(parse_error("{\"a\": 1,\n \"b\": oops}"), "f.json:2:7: must be JSON, got 'oops}'");
  EXPECT_EQ(parse_error("{\"a\": 1"), "f.json:1:8: must be JSON, got the end of the file");
  EXPECT_EQ(parse_error(""), "f.json:1:1: must be JSON, got the end of the file");
  EXPECT_EQ(parse_error("1e999"), "f.json: must be JSON with numbers of at most 1.8e308");
}

TEST(JsonReader, ReadsValuesOfTheirTypes) {
  const auto json = experiment::parse_json(
      R"({"text": "t", "number": 1.5, "whole": 3, "yes": true, "list": [1], "object": {"a": 1}})", "f.json");
  const JsonReader in(json, "f.json");
  EXPECT_EQ(in.text("text"), "t");
  EXPECT_EQ(in.number("number"), 1.5);
  EXPECT_EQ(in.number("whole"), 3);
  EXPECT_EQ(in.whole("whole"), 3);
  EXPECT_TRUE(in.boolean("yes"));
  EXPECT_EQ(in.list("list").size(), 1u);
  EXPECT_EQ(in.object("object").at("a"), 1);
  EXPECT_TRUE(in.has("yes"));
  EXPECT_FALSE(in.has("no"));
}

TEST(JsonReader, SaysWhichKeyHasWhatInsteadOfWhat) {
  const auto json =
      experiment::parse_json(R"({"text": 1, "number": "x", "whole": 1.5, "list": {}, "object": []})", "f");
  const JsonReader in(json, "f.json: rules");
  EXPECT_EQ(error_of([&] { in.text("text"); }), "f.json: rules: 'text' must be text, got 1");
  EXPECT_EQ(error_of([&] { in.number("number"); }), "f.json: rules: 'number' must be a number, got \"x\"");
  EXPECT_EQ(error_of([&] { in.whole("whole"); }), "f.json: rules: 'whole' must be a whole number, got 1.5");
  EXPECT_EQ(error_of([&] { in.list("list"); }), "f.json: rules: 'list' must be a list, got {}");
  EXPECT_EQ(error_of([&] { in.object("object"); }), "f.json: rules: 'object' must be an object, got []");
  EXPECT_EQ(error_of([&] { in.boolean("missing"); }), "f.json: rules: has no 'missing'");
  EXPECT_EQ(error_of([&] { JsonReader(json.at("object"), "f"); }), "f: must be an object, got []");
}

TEST(JsonReader, WhatIsNoNumberIsNaN) {
  EXPECT_EQ(experiment::number_or_nan(2.5), 2.5);
  EXPECT_TRUE(std::isnan(experiment::number_or_nan(nullptr)));
  EXPECT_TRUE(std::isnan(experiment::number_or_nan("2.5")));
}

TEST(JsonReader, ShowsLongValuesInPart) {
  EXPECT_LT(experiment::shown_json(std::string(10'000, 'x')).size(), 300u);
  EXPECT_EQ(experiment::shown_json("\xff"), "\"\ufffd\"");
}

}  // namespace
