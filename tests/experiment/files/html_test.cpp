// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/html.hpp"

#include <gmock/gmock.h>

#include "experiment/report/report_page.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"

namespace {

TEST(Html, TextStaysText) {
  EXPECT_EQ(experiment::html_text("a < b & c > \"d\" 'e'"), "a &lt; b &amp; c &gt; &quot;d&quot; &#39;e&#39;");
  EXPECT_EQ(experiment::html_text("na\xc3\xafve \xe2\x82\xac \xf0\x9f\x90\x9f"),
            "na\xc3\xafve \xe2\x82\xac \xf0\x9f\x90\x9f");
  // Not UTF-8: a lone byte, an overlong slash, a surrogate, a cut character, a control character.
  EXPECT_EQ(experiment::html_text("\xff"), "\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text("\xc0\xaf"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text("\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text(std::string("\x1b[31m\0", 6)), "\xef\xbf\xbd[31m\xef\xbf\xbd");
}

}  // namespace
