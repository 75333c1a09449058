// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/device_registry.hpp"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "sim/script/action_registry.hpp"
#include "sim/world_file/metric_registry.hpp"

namespace {

std::vector<sim::ParamInfo> params_of(auto&& read) {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  read(in);
  return table;
}

TEST(DeviceRegistry, NoDeviceTypeTakesAKeyThatAllDevicesHave) {
  std::set<std::string> common;
  sim::DeviceConfig config;
  for (const auto& info : params_of([&](sim::ParamReader& in) { config.read_common(in); })) common.insert(info.key);
  ASSERT_TRUE(common.contains("rate_hz"));
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    for (const auto& info : params_of([&](sim::ParamReader& in) { type->make_params()->read(in); }))
      EXPECT_FALSE(common.contains(info.key)) << type->name << ": " << info.key;
}

TEST(DeviceRegistry, EveryTypeSaysWhatItIsAndWhatItPublishes) {
  const auto all = sim::DeviceRegistry::instance().all();
  EXPECT_GE(all.size(), 7u);
  for (const sim::DeviceType* type : all) {
    if (type->name.starts_with("test_")) continue;  // other tests of this program register theirs
    EXPECT_FALSE(type->meaning.empty()) << type->name;
    // A linkage, which works without electronics, has no messages.
    EXPECT_FALSE(type->report_message.empty() && type->command_messages.empty() && !type->always_on) << type->name;
    for (const auto& info : params_of([&](sim::ParamReader& in) { type->make_params()->read(in); }))
      EXPECT_FALSE(info.meaning.empty()) << type->name << ": " << info.key;
  }
}

TEST(DeviceRegistry, FixedKeysAreKeysOfTheirType) {
  int found = 0;
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all()) {
    std::set<std::string> keys;
    for (const auto& info : params_of([&](sim::ParamReader& in) { type->make_params()->read(in); }))
      keys.insert(info.key);
    for (const std::string& fixed : type->fixed_keys) {
      EXPECT_TRUE(type->changeable && keys.contains(fixed)) << type->name << ": " << fixed;
      ++found;
    }
  }
  EXPECT_GT(found, 10);
}

TEST(DeviceRegistry, RefusesASecondTypeOfTheSameName) {
  sim::DeviceType type;
  type.name = "lidar";
  sim::DeviceRegistry& registry = sim::DeviceRegistry::instance();
  const std::size_t before = registry.all().size();
  registry.add(type);
  EXPECT_EQ(registry.take_problems(), std::vector<std::string>{"device type 'lidar' exists twice"});
  EXPECT_EQ(registry.take_problems(), std::vector<std::string>{});
  EXPECT_EQ(registry.all().size(), before);
}

TEST(MetricRegistry, RefusesASecondTypeOfTheSameName) {
  sim::MetricRegistry& registry = sim::MetricRegistry::instance();
  const std::size_t before = registry.all().size();
  EXPECT_THROW(registry.add({.word = "tilt", .meaning = {}, .figures = {}, .make_params = {}}), std::logic_error);
  EXPECT_EQ(registry.all().size(), before);
}

TEST(ActionRegistry, RefusesASecondTypeOfTheSameName) {
  sim::ActionRegistry& registry = sim::ActionRegistry::instance();
  const std::size_t before = registry.all().size();
  EXPECT_THROW(registry.add({"log", "writes", "text", true, {}}), std::logic_error);
  EXPECT_EQ(registry.all().size(), before);
}

}  // namespace
