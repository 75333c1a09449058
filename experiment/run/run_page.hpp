// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/view/view_publisher.hpp"
#include "sim/run/run_control.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Options of the live page.
struct ViewOptions {
  std::string host = "127.0.0.1";    ///< address to listen on; any but loopback lets other machines see the run
  std::uint16_t port = 8765;         ///< first port to try
  int port_tries = 20;               ///< 1: this port or none
  std::vector<std::string> origins;  ///< web sites whose pages may connect
  std::string token = {};            ///< what a page needs to steer; empty: 128 random bits
  std::string page_directory;        ///< folder with the page; empty: the page in the program
  bool foxglove_control = false;     ///< clients of Foxglove may control the run or the playback
  bool rosbridge = false;            ///< clients of rosbridge v2 connect without a subprotocol
  bool rosbridge_control = false;    ///< they may command vehicles and control the run
  std::string drive_profile;         ///< file of the profile by which pages drive; empty: that of the program
  std::function<void(const std::string& url)> opened = {};  ///< receives the address of the page of a run
};

/// Live page of a run, as the run sees it: `RunView` is one, which a program without a web server lacks.
class RunPage {
 public:
  using Make = std::function<std::unique_ptr<RunPage>()>;
  /// Publishes a command of a vehicle, as a message from outside.
  using Publish =
      std::function<void(const std::string& vehicle, const std::string& channel, std::span<const std::byte> payload)>;
  /// Answer to a request: whether it was carried out, and the text of the reply.
  struct Answer {
    bool ok = true;
    std::string text;
  };
  /// Executes a request of `sim.control`; none: it is still undecided.
  using Execute = std::function<Answer(const std::string& command, double value, const std::string& text)>;
  /// Returns the reply to a request.  Throws std::runtime_error with the reason when it is refused.
  using CarryOut = std::function<std::string(const std::string& command, double value, const std::string& text)>;
  static Execute answering(CarryOut carry_out) {
    return [carry_out = std::move(carry_out)](const std::string& command, double value, const std::string& text) {
      try {
        return Answer{true, carry_out(command, value, text)};
      } catch (const std::runtime_error& error) {
        return Answer{false, error.what()};
      }
    };
  }
  /// Kind of run, unless it is an ordinary one.
  struct Source {
    std::string record;       ///< `recorded`: a record that is run again; `branched`: it has left its record
    std::string programs;     ///< where the messages of programs come from; empty: from programs
    bool may_launch = false;  ///< a branch of the record can start the programs of its world again
  };

  virtual ~RunPage() = default;
  virtual std::string url() const = 0;
  /// Gives the address to `ViewOptions::opened`.
  virtual void announce() const = 0;
  /// Lets pages drive vehicles: `publish` gives their commands to the run.
  virtual void allow_drive(Publish publish) = 0;
  /// Introduces the world to the pages; before the first step, and when the source changes.
  virtual void start(const sim::World& world, std::optional<double> duration_s, const Source& source) = 0;
  /// Takes a message on a bus of the run.
  virtual void message(std::string_view channel, std::span<const std::byte> payload, sim::Time at) = 0;
  /// Keeps the present poses for the past, and sends the present state, when a frame is due.
  virtual void after_step(const sim::World& world, const bridges::ViewPublisher& publisher,
                          const sim::RunControl& control) = 0;
  /// Carries out the requests of the pages, and sends the status when it has changed.
  virtual void serve(const sim::World& world, const bridges::ViewPublisher& publisher, const sim::RunControl& control,
                     const std::string& waits_for, const Execute& execute) = 0;
  /// Announces that the time of the world was set, and a branch started.  `continues`: at a step of this run.
  /// `programs`: what the programs of the branch do; empty: nothing is to be said of it.
  virtual void moved(const sim::World& world, const sim::RunControl& control, bool continues,
                     const std::string& programs) = 0;
  /// Announces the end of the run, and why.  `log`: the record of the run; empty: none.
  virtual void ended(const sim::World& world, const sim::RunControl& control, const std::string& why,
                     const std::string& log) = 0;
};

}  // namespace experiment
