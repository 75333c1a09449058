// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "viewer/film/film_writer.hpp"

namespace viewer {

/// Writer that encodes in its own thread, while the next frame is rendered.  An error of the other writer is
/// thrown by the next call.
class BackgroundWriter final : public FilmWriter {
 public:
  explicit BackgroundWriter(std::unique_ptr<FilmWriter> writer);
  /// Drops the frames that wait.
  ~BackgroundWriter() override;

  /// Copies the frame; waits while two are waiting.
  void add(const sim::Image8& frame) override;
  void finish() override;

 private:
  static constexpr std::size_t max_waiting = 2;

  void write();
  void stop();

  std::unique_ptr<FilmWriter> writer_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<sim::Image8> waiting_;  // the first is being written
  std::exception_ptr error_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace viewer
