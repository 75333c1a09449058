// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "bridges/log/run_journal.hpp"
#include "experiment/replay/replay_log.hpp"
#include "sim/bus/byte_port.hpp"

namespace experiment {

/// Serial ports that return the bytes that were read in the recorded run.
class ReplayPorts {
 public:
  void add(const ReplayLog::Input& input) { inputs_.add(input.step, input.channel, input.payload); }
  void clear() { inputs_.clear(); }
  sim::PortOpener opener() {
    return [this](sim::PortKind, const std::string& path) { return std::make_unique<Port>(*this, path); };
  }
  /// Sets the step whose recorded bytes the ports return from now on.
  void begin_step(std::int64_t step) { step_ = step; }

 private:
  class Port final : public sim::BytePort {
   public:
    Port(ReplayPorts& ports, std::string path) : ports_(ports), path_(std::move(path)) {}
    sim::Bytes read() override { return ports_.inputs_.read(path_, ports_.step_); }
    void write(std::span<const std::byte>) override {}
    std::uint64_t dropped_bytes() const override { return 0; }

   private:
    ReplayPorts& ports_;
    std::string path_;
  };

  std::int64_t step_ = 0;
  bridges::SerialInputs inputs_;
};

}  // namespace experiment
