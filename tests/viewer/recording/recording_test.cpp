// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/recording/recording.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "bridges/view/view_publisher.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"
#include "viewer/recording/recording_page.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;
using Kind = viewer::Recording::Kind;

constexpr const char* end_of_script = "</script><script>alert(1)</script><!--";

/// A log of a ball that falls for five seconds, with an event whose text is markup.
struct Log {
  Log() {
    test::RecordedRun run(
        "shoal: 1\nname: fall\nphysics: {step_s: 0.01}\nobjects: [{name: ball, position_m: [1, 2, 200], parts: "
        "[{shape: sphere, mass_kg: 1}]}]\nevents: [{name: half, at: 1, do: [{log: \"" +
            std::string(end_of_script) + "\"}]}]\n",
        path);
    bridges::ViewPublisher view(run.gate, run.world, {}, [] { return true; });
    view.after_step();
    for (int i = 0; i < 500; ++i) {
      run.world.step();
      view.after_step();
    }
  }
  test_support::ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
};

std::vector<std::int64_t> state_times(const viewer::Recording& recording) {
  std::vector<std::int64_t> times;
  for (const auto& entry : recording.entries())
    if (entry.kind == Kind::state) times.push_back(entry.time_us);
  return times;
}

/// Returns the texts of a kind.
std::vector<std::string> texts(const viewer::Recording& recording, const std::string& op) {
  std::vector<std::string> found;
  for (const auto& entry : recording.entries())
    if (entry.kind == Kind::text && entry.bytes.find("\"op\":\"" + op + "\"") != std::string::npos)
      found.push_back(entry.bytes);
  return found;
}

/// A small page, as the build embeds one.
struct SmallPage {
  explicit SmallPage(std::string loader = "start();\n") : loader_text(std::move(loader)) {}
  std::vector<bridges::EmbeddedFile> files() const {
    const auto file = [](const char* path, const std::string& text) {
      const auto* begin = reinterpret_cast<const unsigned char*>(text.data());
      return bridges::EmbeddedFile{path, begin, begin + text.size()};
    };
    return {file("index.html", index), file("style.css", style), file("main.js", main),
            file("recording_loader.js", loader_text)};
  }
  std::string index =
      "<html><head>\n<meta charset=\"utf-8\">\n<link rel=\"stylesheet\" href=\"style.css\">\n"
      "<script type=\"module\" src=\"main.js\"></script>\n</head><body></body></html>\n";
  std::string style = "p { margin: 0 }\n", main = "const a = '</script>';\n", loader_text;
};

TEST(Recording, HasSceneEventsAndAllStatesOfASmallLog) {
  const Log log;
  const viewer::Recording recording(log.path, "test", {});
  EXPECT_EQ(recording.start_us(), 0);
  EXPECT_EQ(recording.end_us(), 5'000'000);
  EXPECT_EQ(recording.states(), recording.states_of_log());
  const auto times = state_times(recording);
  ASSERT_EQ(times.size(), recording.states());
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 5'000'000);
  EXPECT_EQ(texts(recording, "scene").size(), 1u);
  ASSERT_EQ(texts(recording, "events").size(), 1u);
  EXPECT_THAT(texts(recording, "events")[0], HasSubstr("half"));
  EXPECT_TRUE(recording.problems().empty());
}

TEST(Recording, KeepsFirstAndLastStateWhenItIsThinned) {
  const Log log;
  viewer::Recording recording(log.path, "test", {});
  for (std::size_t before = recording.states(); recording.thin(); before = recording.states()) {
    EXPECT_LT(recording.states(), before);
    const auto times = state_times(recording);
    ASSERT_EQ(times.size(), recording.states());
    EXPECT_EQ(times.front(), 0);
    EXPECT_EQ(times.back(), 5'000'000);
  }
  EXPECT_EQ(recording.states(), 2u);
}

TEST(Recording, NeedsBoundedMemoryForALongLog) {
  const Log log;
  viewer::Recording::Limits limits;
  limits.state_bytes = 10 * 52;  // a head of 32 bytes and one body of 20
  const viewer::Recording recording(log.path, "test", limits);
  EXPECT_LE(recording.states(), 11u);
  EXPECT_GE(recording.states(), 5u);
  const auto times = state_times(recording);
  EXPECT_EQ(times.back(), 5'000'000);
  for (std::size_t i = 1; i + 1 < times.size(); ++i)
    EXPECT_EQ(times[i] - times[i - 1], times[1] - times[0]) << "state " << i;
}

TEST(Recording, WritesEntriesWithHeads) {
  const Log log;
  const viewer::Recording recording(log.path, "test", {});
  const std::string bytes = recording.to_bytes();
  std::size_t at = 0, number = 0;
  for (; at < bytes.size(); ++number) {
    std::array<std::uint32_t, 2> head{};
    std::memcpy(head.data(), bytes.data() + at, sizeof head);
    ASSERT_LT(number, recording.entries().size());
    EXPECT_EQ(head[0], static_cast<std::uint32_t>(recording.entries()[number].kind));
    ASSERT_EQ(head[1], recording.entries()[number].bytes.size());
    at += 24 + head[1];
  }
  EXPECT_EQ(at, bytes.size());
  EXPECT_EQ(number, recording.entries().size());
}

TEST(RecordingPage, HasTheWholePageAndNoNameCanEndItsData) {
  const Log log;
  const viewer::RecordingPage page = viewer::make_recording_page(log.path, "test");
  EXPECT_THAT(page.html, Not(HasSubstr("alert(1)")));
  EXPECT_THAT(page.html, Not(HasSubstr("src=")));
  EXPECT_THAT(page.html, Not(HasSubstr("<link rel=\"stylesheet\"")));
  EXPECT_THAT(page.html, HasSubstr("default-src 'none'"));
  EXPECT_LT(page.html.size(), 600'000u);
  EXPECT_THAT(page.to_text(), HasSubstr("0 to 5 s"));
}

TEST(RecordingPage, StaysBelowItsLimitByFewerStates) {
  const Log log;
  const std::size_t whole = viewer::make_recording_page(log.path, "test").html.size();
  const viewer::RecordingPage page = viewer::make_recording_page(log.path, "test", whole - 200);
  EXPECT_LE(page.html.size(), whole - 200);
  EXPECT_LT(page.states, page.states_of_log);
  EXPECT_THAT(page.to_text(), HasSubstr(" of the "));
  try {
    viewer::make_recording_page(log.path, "test", 1000);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("run.lcm: scene and meshes alone make a page of"));
  }
}

TEST(RecordingPage, StylesAndLoaderStandInIt) {
  const std::string html = viewer::recording_html(SmallPage().files(), "data");
  EXPECT_THAT(html, HasSubstr("<style>\np { margin: 0 }\n</style>"));
  EXPECT_THAT(html, HasSubstr("<script>\nstart();\n</script>"));
  EXPECT_THAT(html, HasSubstr("id=\"recording\">ZGF0YQ==</script>"));
}

TEST(RecordingPage, SaysWhatThePageLacks) {
  EXPECT_THROW(viewer::recording_html({}, ""), std::runtime_error);
  EXPECT_THROW(viewer::recording_html(SmallPage("const a = '</script>';").files(), ""), std::runtime_error);
  SmallPage page;
  page.index = "<html></html>";
  EXPECT_THROW(viewer::recording_html(page.files(), ""), std::runtime_error);
}

}  // namespace
