// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/reference/reference_pages.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "shoal/message_schema.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world_file/metric_registry.hpp"
#include "tests/project_paths.hpp"

namespace {

TEST(ReferencePages, InDocsAreUpToDate) {
  for (const std::string name : {"devices", "world_format", "messages", "metrics", "programs"}) {
    std::ifstream in(test_support::source_path("docs/reference/") + name + ".md", std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    // Not EXPECT_EQ: no one wants to read two whole pages.
    EXPECT_TRUE(text == tools::reference_page(name))
        << "docs/reference/" << name << ".md is stale; type\n  build/bin/shoal describe --page " << name
        << " > docs/reference/" << name << ".md";
  }
}

TEST(ReferencePages, ThereIsNoOtherPage) {
  EXPECT_THROW(tools::reference_page("lidars"), std::out_of_range);
}

TEST(ReferencePages, NameEveryDeviceAndEveryMessage) {
  const std::string devices = tools::reference_page("devices");
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all())
    EXPECT_THAT(devices, testing::HasSubstr("\n## " + type->name + "\n"));
  const std::string messages = tools::reference_page("messages");
  for (const auto& [name, schema] : shoal::embedded_types().all())
    EXPECT_THAT(messages, testing::HasSubstr("\n## " + name + "\n"));
}

TEST(ReferencePages, ExplainEveryFigureWithItsUnit) {
  const std::string page = tools::reference_page("metrics");
  for (const sim::MetricKind* kind : sim::MetricRegistry::instance().all()) {
    EXPECT_THAT(page, testing::HasSubstr("\n## " + kind->word + "\n"));
    std::set<std::string> names;
    for (const sim::FigureKind& figure : kind->figures) {
      EXPECT_NE(figure.unit, "") << kind->word << "." << figure.name;
      EXPECT_NE(figure.meaning, "") << kind->word << "." << figure.name;
      EXPECT_EQ(figure.name.ends_with("_m"), figure.unit == "m") << figure.name;
      EXPECT_EQ(figure.name.ends_with("_s"), figure.unit == "s") << figure.name;
      EXPECT_EQ(figure.name.ends_with("_deg"), figure.unit == "deg") << figure.name;
      EXPECT_THAT(page, testing::HasSubstr("| `" + figure.name + "` | "));
      names.insert(figure.name);
    }
    // Reports find the type of a metric by its figures.
    EXPECT_EQ(sim::MetricRegistry::instance().of_figures(names), kind);
  }
  EXPECT_EQ(sim::MetricRegistry::instance().of_figures({"rms_m"}), nullptr);
}

TEST(ReferencePages, NoDeviceTakesAKeyThatAllDevicesHave) {
  std::set<std::string> common;
  {
    std::vector<sim::ParamInfo> table;
    sim::ParamReader in(table);
    sim::DeviceConfig config;
    config.read_common(in);
    for (const sim::ParamInfo& info : table) common.insert(info.key);
  }
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all()) {
    std::vector<sim::ParamInfo> table;
    sim::ParamReader in(table);
    type->make_params()->read(in);
    for (const sim::ParamInfo& info : table) EXPECT_FALSE(common.contains(info.key)) << type->name << ": " << info.key;
  }
}

TEST(Describe, KnowsDevicesMessagesAndFiles) {
  EXPECT_THAT(tools::describe_text("lidar"), testing::HasSubstr("beams"));
  EXPECT_THAT(tools::describe_text("device"), testing::HasSubstr("rate_hz"));
  EXPECT_THAT(tools::describe_text("world"), testing::HasSubstr("duration_s"));
  EXPECT_THAT(tools::describe_text("vehicle"), testing::HasSubstr("bodies"));
  std::istringstream metrics(tools::describe_text("metrics", 80));
  EXPECT_THAT(metrics.str(), testing::HasSubstr("  rms_m (m)\n      root mean square of the position errors\n"));
  for (std::string line; std::getline(metrics, line);) EXPECT_LE(line.size(), 80u) << line;
  EXPECT_THAT(tools::describe_text("noise"), testing::HasSubstr("gaussian_std"));
  EXPECT_THAT(tools::describe_text("pose_t"), testing::HasSubstr("fingerprint"));
  EXPECT_EQ(tools::describe_text("pose_t"), tools::describe_text("shoal.pose_t"));
  EXPECT_EQ(tools::describe_text("lider"), "");
}

}  // namespace
