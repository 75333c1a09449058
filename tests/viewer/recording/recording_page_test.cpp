// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/recording/recording_page.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "bridges/lockstep/lockstep_service.hpp"
#include "bridges/view/view_publisher.hpp"
#include "tests/viewer/recording/recording_fixture.hpp"
#include "viewer/recording/recording.hpp"

namespace {

using namespace recording_fixture;

using testing::HasSubstr;
using testing::Not;

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
