// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/motion_record/record_view.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/experiment/view/view_page.hpp"
#include "tools/experiment/motion_record/motion_recorder.hpp"

// The live page of `shoal motion record --view`.

namespace {

/// A recording of a leg at rest with its page, in another thread.  The page lies in memory that was used before.
class ViewedRecording {
 public:
  ViewedRecording() {
    tools::RecordOptions options;
    options.stage.world = folder_.file("world.yaml");
    std::ofstream(options.stage.world) << test::leg_world(
        "        - {name: group, type: joint_group}\n"
        "        - {name: player, type: motion_player, group: group}\n");
    recorder_ = std::make_unique<tools::MotionRecorder>(options, folder_.file("rest.journal"));
    tools::ViewOptions page;
    page.port = 0;
    view_.reset(new (used_.data()) tools::RecordView(page, recorder_->stage()));
    thread_ = std::thread([this] {
      while (!ends_) {
        if (goes_back_.exchange(false)) {
          recorder_->back(0.1);
          view_->went_back();
        }
        recorder_->frame(std::vector<double>{0, 0});
        view_->serve(false);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~ViewedRecording() {
    ends_ = true;
    thread_.join();
  }
  std::string url() const { return view_->url(); }
  void rewind() { goes_back_ = true; }

 private:
  struct Destroy {
    void operator()(tools::RecordView* view) const { view->~RecordView(); }
  };

  const test_support::ScratchFolder folder_;
  std::unique_ptr<tools::MotionRecorder> recorder_;
  std::vector<unsigned char> used_ = std::vector<unsigned char>(sizeof(tools::RecordView), 0x55);
  std::unique_ptr<tools::RecordView, Destroy> view_;
  std::atomic<bool> ends_ = false, goes_back_ = false;
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
  recording.rewind();
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
  EXPECT_EQ(reply["text"], "a recording is steered by its keys");
}

}  // namespace
