// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "bridges/log/run_journal.hpp"
#include "sim/bus/byte_port.hpp"
#include "sim/world/world.hpp"
#include "tools/experiment/replay/replay_log.hpp"

namespace tools {

/// Ports that read what was read in the run.
class ReplayPorts {
 public:
  void add(const ReplayLog::Letter& letter) { mail_.add(letter.step, letter.channel, letter.payload); }
  sim::PortOpener opener() {
    return [this](const std::string&, const std::string& path) { return std::make_unique<Port>(*this, path); };
  }
  void attach(const sim::World& world) { world_ = &world; }

 private:
  class Port final : public sim::BytePort {
   public:
    Port(ReplayPorts& ports, std::string path) : ports_(ports), path_(std::move(path)) {}
    sim::Bytes read() override {
      return ports_.world_ != nullptr ? ports_.mail_.read(path_, ports_.world_->step_number()) : sim::Bytes{};
    }
    void write(std::span<const std::byte>) override {}
    std::uint64_t dropped_bytes() const override { return 0; }

   private:
    ReplayPorts& ports_;
    std::string path_;
  };

  const sim::World* world_ = nullptr;
  bridges::SerialMail mail_;
};

}  // namespace tools
