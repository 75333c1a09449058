// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <string>

#include "tests/bridges/web/web_client.hpp"
#include "tests/system/shoal_program.hpp"

// `shoal run --view --watch`.

namespace {

using namespace system_test;
using testing::HasSubstr;
using web_test::Json;

/// World that is run again each time that it is saved.
class WatchTest : public testing::Test {
 protected:
  /// Saves the world as an editor does: under another name, then renamed.
  void save(const std::string& text) {
    write_file(world_ + ".new", text);
    std::filesystem::rename(world_ + ".new", world_);
  }
  static std::string world(const std::string& name, const std::string& more = "") {
    return "shoal: 1\nname: " + name + "\nobjects: [{name: ball, parts: [{shape: sphere, mass_kg: 1}]" + more + "}]\n";
  }
  /// Returns the greeting of the page once it holds; it may have to connect again.
  Json await_hello(const std::function<bool(const Json&)>& holds) {
    Json found;
    await(
        [&] {
          try {
            const std::string errors = run_.errors();
            const std::size_t port = errors.find("127.0.0.1:");
            if (port == std::string::npos) return false;
            web_test::Client page(static_cast<std::uint16_t>(std::stoi(errors.substr(port + 10))));
            page.upgrade();
            page.send_json({{"op", "hello"}, {"token", ""}});
            const auto frame = page.read_frame();
            if (!frame || !frame->is_text()) return false;
            found = frame->json();
            return found.value("op", "") == "hello" && holds(found);
          } catch (const std::runtime_error&) {  // between two runs
            return false;
          }
        },
        timeout);
    return found;
  }

  ScratchFolder folder_;
  const std::string world_ = folder_.file("world.yaml");
  struct Saved {
    Saved(const std::string& path, const std::string& text) { write_file(path, text); }
  } saved_{world_, world("first")};
  Program run_{{built("shoal"), "run", world_, "--bus", "none", "--duration", "forever", "--view", "--view-port", "0",
                "--watch"}};
};

TEST_F(WatchTest, ASavedWorldIsRunAnewAtTheSameAddress) {
  EXPECT_EQ(await_hello([](const Json& hello) { return hello["world"] == "first"; })["world"], "first");
  save(world("second"));
  EXPECT_EQ(await_hello([](const Json& hello) { return hello["world"] == "second"; })["world"], "second");
  kill(run_.pid(), SIGTERM);
  EXPECT_EQ(run_.wait(), 128 + SIGTERM) << run_.errors();
}

TEST_F(WatchTest, ErrorsStandOnThePageUntilTheyAreMended) {
  await_hello([](const Json& hello) { return hello["world"] == "first"; });
  save(world("second", ", speed: 3"));
  const Json wrong = await_hello([](const Json& hello) { return hello.contains("problem"); });
  EXPECT_THAT(wrong.value("problem", ""), HasSubstr("world.yaml:3:62: object 'ball': unknown key 'speed'"));
  save(world("third"));
  const Json mended = await_hello([](const Json& hello) { return hello["world"] == "third"; });
  EXPECT_FALSE(mended.contains("problem"));
  kill(run_.pid(), SIGTERM);
  EXPECT_EQ(run_.wait(), 128 + SIGTERM) << run_.errors();
}

/// A program in place of the browser, which writes its arguments into a file.
class OpenTest : public testing::Test {
 protected:
  OpenTest() {
    write_file(browser_, "#!/bin/sh\necho \"$@\" >> " + folder_.file("shown") + "\n");
    std::filesystem::permissions(browser_, std::filesystem::perms::owner_all);
    setenv("BROWSER", browser_.c_str(), 1);
  }
  ~OpenTest() override { unsetenv("BROWSER"); }
  /// Waits until the browser shows an address that a program has printed.
  void await_shown(const Program& program) {
    std::string shown;
    await([&] { return !(shown = text_of_file(folder_.file("shown"))).empty(); }, timeout);
    EXPECT_THAT(shown, HasSubstr("http://127.0.0.1:"));
    EXPECT_THAT(program.output() + program.errors(), HasSubstr("live page: " + shown));
  }

  ScratchFolder folder_;
  const std::string browser_ = folder_.file("browser");
};

TEST_F(OpenTest, TheBrowserShowsTheAddressOfARunThatWasPrinted) {
  Program run({built("shoal"), "run", "minimal", "--bus", "none", "--duration", "forever", "--view", "--view-port", "0",
               "--open"});
  await_shown(run);
  kill(run.pid(), SIGTERM);
  EXPECT_EQ(run.wait(), 128 + SIGTERM) << run.errors();
}

TEST_F(OpenTest, TheBrowserShowsTheAddressOfALogThatWasPrinted) {
  const std::string log = folder_.file("run.lcm");
  ASSERT_EQ(run_shoal({"run", "minimal", "--bus", "none", "--duration", "1", "--record", log}).exit_code, 0);
  Program view({built("shoal"), "view", log, "--view-port", "0", "--open"});
  await_shown(view);
  kill(view.pid(), SIGTERM);
  EXPECT_EQ(view.wait(), 0) << view.errors();
}

TEST(Open, NeedsThePage) {
  const Ended ended = run_shoal({"run", "minimal", "--open"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("--open needs --view"));
}

TEST(Watch, DoesNotWriteResults) {
  const Ended ended = run_shoal({"run", "minimal", "--view", "--watch", "--record", "x.lcm"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("--watch: cannot be given with --results, --record or --from"));
}

}  // namespace
