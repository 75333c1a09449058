// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/record_view.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "motion/record/motion_recorder.hpp"
#include "motion/record/recorded_motion.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/viewer/server/view_page.hpp"

// The live page of `shoal motion record --view`.

namespace {

using testing::HasSubstr;

/// A recording at rest with its page, in another thread.  The page lies in memory that was used before.
class ViewedRecording {
 public:
  /// `world`: a file; empty: a leg.
  explicit ViewedRecording(const std::string& world = "") {
    options_.stage.world = world.empty() ? folder_.file("world.yaml") : world;
    options_.name = "rest";  // of its file: it is a part of the state
    options_.stage.scores = true;
    options_.back_s = 500;
    if (world.empty())
      std::ofstream(options_.stage.world) << test::leg_world(
          "        - {name: group, type: joint_group}\n"
          "        - {name: player, type: motion_player, group: group}\n");
    recorder_ = std::make_unique<motion::MotionRecorder>(options_, motion::journal_path(file_));
    experiment::ViewOptions page;
    page.port = 0;
    view_.reset(new (used_.data()) motion::RecordView(page, *recorder_));
    thread_ = std::thread([this] {
      while (!ends_) {
        if (const double by_s = back_s_.exchange(0); by_s > 0) {
          recorder_->back(by_s);
          view_->went_back();
        }
        recorder_->frame(std::vector<double>(recorder_->joints().size(), 0.0));
        view_->serve(false);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~ViewedRecording() { stop(); }
  /// Saves the recording, plays it in the same world, and expects the same state.
  sim::JointMotion save() {
    stop();
    const std::uint64_t hash = recorder_->finish();
    view_.reset();
    recorder_.reset();
    const sim::JointMotion motion = motion::save_take(file_, motion::read_journal(file_).value(), "", "record").motion;
    motion::MotionStage stage(options_.stage, sim::load_motion(motion::take_path(file_)));
    stage.play_out(0, 600);
    EXPECT_EQ(stage.state_hash(), hash);
    return motion;
  }
  std::string url() const { return view_->url(); }
  void rewind(double by_s) { back_s_ = by_s; }

 private:
  struct Destroy {
    void operator()(motion::RecordView* view) const { view->~RecordView(); }
  };

  void stop() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }

  const test_support::ScratchFolder folder_;
  const std::string file_ = folder_.file("rest.yaml");
  motion::RecordOptions options_;
  std::unique_ptr<motion::MotionRecorder> recorder_;
  std::vector<unsigned char> used_ = std::vector<unsigned char>(sizeof(motion::RecordView), 0x55);
  std::unique_ptr<motion::RecordView, Destroy> view_;
  std::atomic<bool> ends_ = false;
  std::atomic<double> back_s_ = 0;
  std::thread thread_;
};

TEST(RecordView, ShowsTheRecordingAndGoesBackWithIt) {
  ViewedRecording recording;
  test::ViewPage page(recording.url());
  EXPECT_EQ(page.text("hello")["source"], "run");
  std::vector<std::string> names;
  const auto scene = page.text("scene");
  for (const auto& body : scene["bodies"]) names.push_back(body["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"dog/thigh", "dog/shin"}));
  const test::ViewState before = page.state();
  EXPECT_EQ(before.count, 2u);
  EXPECT_EQ(before.branch, 0);
  recording.rewind(0.1);
  test::ViewState after = page.state();
  while (after.branch == 0) after = page.state();
  EXPECT_EQ(after.branch, 1);
  EXPECT_TRUE(after.jump());
}

TEST(RecordView, IsSteeredByItsKeysOnly) {
  ViewedRecording recording;
  test::ViewPage page(recording.url());
  page.control("pause");
  const auto reply = page.reply();
  EXPECT_EQ(reply["ok"], false);
  EXPECT_EQ(reply["text"], "a recording is controlled by its keys");
}

/// A box that stands where nothing else is.
std::string add_box(const std::string& name) {
  return "{add: {object: {name: " + name +
         ", position_m: [3, 0, 0.1], parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}}}";
}

bool has_box(const web_test::Json& scene) {
  return std::any_of(scene["bodies"].begin(), scene["bodies"].end(),
                     [](const auto& body) { return body["owner"] == "box"; });
}

TEST(RecordView, WhatAPageAddsAndRemovesIsAPartOfTheRecording) {
  ViewedRecording recording;
  test::ViewPage page(recording.url());
  page.control("do", 0, add_box("low"));
  const auto added = page.reply();
  EXPECT_EQ(added["ok"], true) << added;
  EXPECT_THAT(added["text"], HasSubstr("recorded at "));
  page.control("do", 0, add_box("low"));
  EXPECT_EQ(page.reply()["ok"], false);  // it is there
  page.control("do", 0, "{remove: low}");
  EXPECT_EQ(page.reply()["ok"], true);
  page.control("do", 0, add_box("high"));
  EXPECT_EQ(page.reply()["ok"], true);
  const sim::JointMotion motion = recording.save();
  ASSERT_EQ(motion.changes.size(), 3u);
  EXPECT_EQ(motion.changes[1].action.entries.front().key, "remove");
}

TEST(RecordView, GoingBackTakesBackWhatAPageAdded) {
  ViewedRecording recording;
  test::ViewPage page(recording.url());
  while (page.state().time_us < 200'000) continue;
  page.control("do", 0, add_box("box"));
  ASSERT_EQ(page.reply()["ok"], true);
  page.text("scene", has_box);
  recording.rewind(500);  // to its start
  page.text("scene", [](const web_test::Json& scene) { return !has_box(scene); });
  EXPECT_TRUE(recording.save().changes.empty());
}

TEST(RecordView, RefusesWhatARecordingCannotHave) {
  ViewedRecording recording;
  test::ViewPage page(recording.url());
  const auto refused = [&](const std::string& command, const std::string& text) {
    page.control(command, 0, text);
    const auto reply = page.reply();
    EXPECT_EQ(reply["ok"], false) << text;
    return reply["text"].get<std::string>();
  };
  EXPECT_THAT(refused("do", "{remvoe: box}"), HasSubstr("'remvoe'"));
  EXPECT_THAT(refused("do", "{remove: box}"), HasSubstr("'remove' names no vehicle or object 'box'"));
  EXPECT_THAT(refused("do", "{remove: dog}"), HasSubstr("vehicle 'dog' has the motion, and cannot be removed"));
  // The first action of a list is taken back when the second one is refused.
  EXPECT_THAT(refused("do", "[" + add_box("box") + ", {remove: dog}]"), HasSubstr("cannot be removed"));
  EXPECT_THAT(refused("do", "{remove: box}"), HasSubstr("'remove' names no vehicle or object 'box'"));
  EXPECT_THAT(refused("spawn", "{name: other, file: rover.yaml}"), HasSubstr("only objects can be added"));
  // What makes the recording would stop, or play other frames.
  EXPECT_THAT(refused("do", "{set: {device: dog/player, values: {motions: []}}}"),
              HasSubstr("'dog/player' makes the recording, and cannot be changed by it"));
  EXPECT_THAT(refused("do",
                      "[{log: hm}, {publish: {channel: dog.player.cmd, type: shoal.motion_command_t, value: "
                      "{command: 2}}}]"),
              HasSubstr("'dog/player' makes the recording"));
  EXPECT_TRUE(recording.save().changes.empty());
}

TEST(RecordView, ShowsTheMarginsOfTheWorld) {
  ViewedRecording recording(test_support::source_path("worlds/ers7_studio.yaml"));
  test::ViewPage page(recording.url());
  const auto stands = [](const web_test::Json& scores) {
    const auto& figures = scores["metrics"][0]["figures"];
    return figures.contains("static_m") && figures["static_m"].is_number();
  };
  const auto figures = page.text("scores", stands)["metrics"][0]["figures"];
  // The feet of an ERS-7 are 0.13 m apart from left to right.
  EXPECT_GT(figures["static_m"], 0.01);
  EXPECT_LT(figures["static_m"], 0.07);
  EXPECT_LE(figures["static_min_m"], figures["static_m"]);
  EXPECT_TRUE(figures["zmp_m"].is_number());
  EXPECT_TRUE(figures["capture_m"].is_number());
}

}  // namespace
