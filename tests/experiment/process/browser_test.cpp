// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/process/browser.hpp"

#include <gmock/gmock.h>
#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <string>

#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* url = "http://127.0.0.1:8765/#t=5f$(x)";

/// A program that takes the place of the browser while the test runs.
class BrowserTest : public testing::Test {
 protected:
  ~BrowserTest() override { unsetenv("BROWSER"); }
  void set_browser(const std::string& script) {
    const std::string program = folder_.file("browser");
    std::ofstream(program) << "#!/bin/sh\n" << script << '\n';
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    setenv("BROWSER", program.c_str(), 1);
  }
  std::string shown() const {
    std::ifstream in(folder_.file("shown"));
    return {std::istreambuf_iterator<char>(in), {}};
  }

  lcm_test::ScratchFolder folder_;
};

/// Notices the warning of a program that fails, which another thread logs.
struct ExitWarning : spdlog::sinks::base_sink<std::mutex> {
  std::atomic<bool> seen = false;
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text(message.payload.data(), message.payload.size());
    if (text.find("ended with exit code 3; open the address by hand") != std::string::npos) seen = true;
  }
  void flush_() override {}
};

TEST(BrowserCommand, IsXdgOpenUnlessTheUserHasChosenAnother) {
  EXPECT_THAT(experiment::browser_command("", url), ElementsAre("xdg-open", url));
  EXPECT_THAT(experiment::browser_command(" ", url), ElementsAre("xdg-open", url));
  EXPECT_THAT(experiment::browser_command("firefox", url), ElementsAre("firefox", url));
}

TEST(BrowserCommand, HasTheAddressAtItsPlaceAndIsTheFirstOfAList) {
  EXPECT_THAT(experiment::browser_command("firefox  --new-window %s --safe:lynx", url),
              ElementsAre("firefox", "--new-window", url, "--safe"));
  EXPECT_THAT(experiment::browser_command("chromium --app=%s", url),
              ElementsAre("chromium", std::string("--app=") + url));
}

TEST_F(BrowserTest, ReceivesTheAddressAsOneArgumentThatNoShellReads) {
  set_browser("printf '%s %s\\n' $# \"$1\" > " + folder_.file("shown"));
  experiment::Browser browser;
  browser.open(url);
  EXPECT_TRUE(lcm_test::await([&] { return shown() == std::string("1 ") + url + "\n"; })) << shown();
}

TEST_F(BrowserTest, ThatDoesNotExistIsAWarning) {
  const test_support::LogCapture log;
  setenv("BROWSER", "/nowhere/browser", 1);
  experiment::Browser().open(url);
  EXPECT_THAT(log.text(), HasSubstr("--open: cannot start '/nowhere/browser': No such file or directory"));
}

TEST_F(BrowserTest, ThatFailsIsAWarning) {
  const auto sink = std::make_shared<ExitWarning>();
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("capture", sink));
  set_browser("exit 3");
  {
    experiment::Browser browser;
    browser.open(url);
    EXPECT_TRUE(lcm_test::await([&] { return sink->seen.load(); }));
  }
  spdlog::set_default_logger(before);
}

TEST_F(BrowserTest, ThatStaysOpenDoesNotDelayTheEnd) {
  set_browser("echo > " + folder_.file("shown") + "\nexec sleep 3");
  experiment::Browser browser;
  browser.open(url);
  EXPECT_TRUE(lcm_test::await([&] { return shown() == "\n"; }));
}

}  // namespace
