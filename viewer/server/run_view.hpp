// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "experiment/run/run_page.hpp"
#include "viewer/log/state_frame.hpp"
#include "viewer/server/page_drive.hpp"
#include "viewer/server/page_session.hpp"
#include "viewer/server/past_view.hpp"

namespace viewer {

/// Live page of a run: sends the state of the world at up to 30 Hz of wall time, and passes requests of the pages on.
/// The run does not depend on it; without a page it does nothing.
class RunView final : public experiment::RunPage {
 public:
  /// Starts the server.  Throws bridges::WebError, and sim::ConfigError for the profile.
  RunView(const experiment::ViewOptions& options, const std::string& version);

  std::string url() const override { return session_.server.url(); }
  void announce() const override;
  void allow_drive(Publish publish) override { publish_drive_ = std::move(publish); }
  void start(const sim::World& world, std::optional<double> duration_s, const Source& source) override;
  void start(const sim::World& world, std::optional<double> duration_s) { start(world, duration_s, {}); }
  /// Shows an error on the pages.
  void problem(const std::string& text);
  /// Marks the next state as a jump in time, on the same branch.
  void jump() { jump_ = true; }
  /// Returns the number of pages.
  int clients() const { return session_.server.clients(); }
  void message(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override;
  void after_step(const sim::World& world, const bridges::ViewPublisher& publisher,
                  const sim::RunControl& control) override;
  void serve(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control,
             const std::string& waits_for, const Execute& execute) override;
  void moved(const sim::World& world, const sim::RunControl& control, bool continues,
             const std::string& programs = {}) override;
  void ended(const sim::World& world, const sim::RunControl& control, const std::string& why,
             const std::string& log) override;

 private:
  using Clock = std::chrono::steady_clock;

  void send_state(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control);
  void flush_traffic(const sim::World& world);
  void send_status(const sim::World& world, const sim::RunControl& control, const std::string& waits_for,
                   const std::string& ended, const std::string& log = {});
  void handle(const bridges::ViewRequest& request, const Execute& execute);
  void serve_foxglove(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control,
                      const Execute& execute);
  void drive(const bridges::ViewRequest& request, const sim::World& world);
  void send_forms(const sim::World& world);

  PageSession session_;
  const std::function<void(const std::string& url)> opened_;
  const bool foxglove_control_;
  sim::Time message_time_{0};  // of the newest message
  PastView past_{session_.server};
  const std::string version_;
  PageDrive drive_;
  Publish publish_drive_;                          // empty: pages do not drive
  std::optional<std::uint64_t> forms_generation_;  // of the world, of the last forms
  StateFrame frame_;
  bool jump_ = false;
  Clock::time_point next_frame_{}, next_status_{}, next_traffic_{};
  std::int64_t sent_step_ = -1;
  std::int64_t last_us_ = 0;  // time of the last step
  // Used to measure the rate of simulated time.
  Clock::time_point rate_since_{};
  sim::Time rate_from_{0};
  double rate_ = 0;
};

/// Returns the function that starts such a page; `options` must outlive it.
experiment::RunPage::Make run_page(const experiment::ViewOptions& options);

}  // namespace viewer
