// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/view/view_publisher.hpp"
#include "bridges/web/web_server.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"
#include "tools/experiment/log_data/state_frame.hpp"
#include "tools/experiment/view/foxglove_view.hpp"
#include "tools/experiment/view/page_drive.hpp"
#include "tools/experiment/view/page_traffic.hpp"
#include "tools/experiment/view/past_view.hpp"
#include "tools/experiment/view/view_messages.hpp"

namespace tools {

/// Options of the live page.
struct ViewOptions {
  std::string host = "127.0.0.1";    ///< address to listen at; another than loopback lets other machines see the run
  std::uint16_t port = 8765;         ///< first port to try
  int port_tries = 20;               ///< 1: this port or none
  std::vector<std::string> origins;  ///< web sites whose pages may connect
  std::string token = {};            ///< what a page needs to steer; empty: 128 random bits
  std::string page_directory;        ///< folder with the page; empty: the page in the program
  bool foxglove_control = false;     ///< clients of Foxglove may control the run or the playback
  std::string drive_profile;         ///< file of the profile by which pages drive; empty: that of the program
  std::function<void(const std::string& url)> opened = {};  ///< receives the address of the page of a run
};

/// Returns the settings of the server.
bridges::WebOptions web_options(const ViewOptions& options);

/// Live page of a run: sends the state of the world at up to 30 Hz of wall time, and passes requests of the pages on.
/// The run does not depend on it; without a page it does nothing.
class RunView {
 public:
  /// Answer to a request: whether it was carried out, and the text of the reply.
  struct Answer {
    bool ok = true;
    std::string text;
  };
  /// Executes a request of `sim.control`; none: it is still undecided.
  using Execute = std::function<Answer(const std::string& command, double value, const std::string& text)>;

  /// Starts the server.  Throws bridges::WebError, and sim::ConfigError for the profile.
  RunView(const ViewOptions& options, const std::string& version);

  std::string url() const { return server_.url(); }
  /// What the run is, if it is not a usual one.
  struct Source {
    std::string record;       ///< `recorded`: a record that is run again; `branched`: it has left its record
    std::string programs;     ///< where the messages of programs come from; empty: from programs
    bool may_launch = false;  ///< a branch of the record can start the programs of its world again
  };
  /// Lets pages drive vehicles: `publish` gives their commands to the run.
  void allow_drive(PageDrive::Publish publish) { publish_drive_ = std::move(publish); }
  /// Introduces the world to the pages; before the first step, and when the source changes.
  void start(const sim::World& world, std::optional<double> duration_s, const Source& source);
  void start(const sim::World& world, std::optional<double> duration_s) { start(world, duration_s, {}); }
  /// Shows an error on the pages.
  void problem(const std::string& text);
  /// Marks the next state as a jump in time, on the same branch.
  void jump() { jump_ = true; }
  /// Returns the number of pages.
  int clients() const { return server_.clients(); }
  /// Takes a message on a bus of the run.
  void message(std::string_view channel, std::span<const std::byte> payload, sim::Time at);
  /// Keeps the present poses for the past, and sends the present state, when a frame is due.
  void after_step(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control);
  /// Carries out the requests of the pages, and sends the status when it has changed.
  void serve(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control,
             const std::string& waits_for, const Execute& execute);
  /// Announces that the time of the world was set, and a branch started.  `continues`: at a step of this run.
  /// `programs`: what the programs of the branch do; empty: nothing is to be said of it.
  void moved(const sim::World& world, const sim::RunControl& control, bool continues, const std::string& programs = {});
  /// Announces the end of the run, and why.
  void ended(const sim::World& world, const sim::RunControl& control, const std::string& why);

 private:
  using Clock = std::chrono::steady_clock;

  void send_state(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control);
  void flush_traffic(const sim::World& world);
  void send_status(const sim::World& world, const sim::RunControl& control, const std::string& waits_for,
                   const std::string& ended);
  void handle(const bridges::ViewRequest& request, const Execute& execute);
  void serve_foxglove(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control,
                      const Execute& execute);
  void drive(const bridges::ViewRequest& request, const sim::World& world);
  void send_forms(const sim::World& world);

  bridges::WebServer server_;
  ViewMessages messages_{server_, ViewMessages::Frames::from_elsewhere};
  PageTraffic traffic_{server_, MessageFeed::Past::kept};
  FoxgloveView foxglove_{server_};
  const bool foxglove_control_;
  sim::Time message_time_{0};  // of the newest message
  PastView past_{server_};
  const std::string version_;
  PageDrive drive_;
  PageDrive::Publish publish_drive_;               // empty: pages do not drive
  std::optional<std::uint64_t> forms_generation_;  // of the world, of the last forms
  StateFrame frame_;
  bool jump_ = false;
  Clock::time_point next_frame_{}, next_status_{}, next_traffic_{};
  std::int64_t sent_step_ = -1;
  std::int64_t last_us_ = 0;  // time of the last step
  // For the rate of simulated time.
  Clock::time_point rate_since_{};
  sim::Time rate_from_{0};
  double rate_ = 0;
};

}  // namespace tools
