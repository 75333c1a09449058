// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "bridges/mcap/mcap_reader.hpp"
#include "tests/system/shoal_program.hpp"

// The layouts for Foxglove name topics, fields and frames of the worlds that they are for.

namespace {

using namespace system_test;
using Json = nlohmann::json;
using Item = bridges::mcap::McapReader::Item;

/// Topics of a run with its programs, and the definition of the type of each.
std::map<std::string, std::string> topics_of(const std::string& world) {
  const ScratchFolder folder;
  const std::string record = folder.file("run.mcap");
  const Ended ended = run_shoal({"run", source("worlds/" + world + ".yaml"), "--launch", "--quiet", "--speed", "max",
                                 "--duration", "12", "--record", record, "--lcm-url", own_url()});
  EXPECT_LE(ended.exit_code, 1) << ended.errors;  // 1: it ends before its programs are where they are to be
  bridges::mcap::McapReader reader(record);
  while (reader.next() != Item::end) {
  }
  std::map<std::string, std::string> topics;
  for (const auto& [number, channel] : reader.channels())
    topics[channel.topic] = reader.schemas().at(channel.schema).text;
  return topics;
}

/// What a layout names: topics, and fields of messages as TOPIC.FIELD.FIELD.
struct Names {
  std::set<std::string> topics, paths;

  void find(const Json& json) {
    for (const auto& [key, value] : json.items()) {
      if (json.is_object() && key.starts_with('/')) topics.insert(key);
      if (key == "topicPath") topics.insert(value.get<std::string>());
      if (key == "value" && value.is_string() && value.get<std::string>().starts_with('/')) paths.insert(value);
      // Panels may publish too, on topics of their own.
      if (value.is_structured() && key != "publish") find(value);
    }
  }
};

class FoxgloveLayout : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(FoxgloveLayout, NamesTopicsAndFieldsOfItsWorld) {
  const auto& [name, world] = GetParam();
  const Json layout = Json::parse(std::ifstream(source("viewer/foxglove/" + std::string(name) + ".json")));
  const std::map<std::string, std::string> topics = topics_of(world);
  Names names;
  names.find(layout);
  EXPECT_GE(names.topics.size(), 6u);
  EXPECT_GE(names.paths.size(), 2u);
  for (const std::string& topic : names.topics) EXPECT_TRUE(topics.contains(topic)) << topic;
  for (const std::string& path : names.paths) {
    const std::size_t dot = path.find('.');
    const auto topic = topics.find(path.substr(0, dot));
    ASSERT_NE(topic, topics.end()) << path;
    // Each part of the path is a member in the definition of the type, or of a type in it.
    std::stringstream fields(path.substr(dot + 1));
    for (std::string field; std::getline(fields, field, '.');)
      EXPECT_THAT(topic->second, testing::ContainsRegex(" " + field + "([ =\n]|$)")) << path;
  }
  // The camera follows a vehicle of the world.
  const std::string followed = layout["configById"]["3D!scene"]["followTf"];
  const bool has_topics = std::any_of(topics.begin(), topics.end(),
                                      [&](const auto& topic) { return topic.first.starts_with("/" + followed + "/"); });
  EXPECT_TRUE(has_topics) << followed;
}

INSTANTIATE_TEST_SUITE_P(Worlds, FoxgloveLayout,
                         testing::Values(std::pair{"land", "coop_land"}, std::pair{"marine", "coop_underwater"}),
                         [](const auto& test) { return std::string(test.param.first); });

}  // namespace
