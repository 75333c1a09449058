// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "devices/common/serial_port.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// The other end of a serial port: what the test writes and reads.
struct PortEnd {
  std::string to_world, from_world;
  std::size_t room_bytes = 1 << 20;  ///< the oldest of what is more is dropped
  std::uint64_t dropped_bytes = 0;
};

class FakePort final : public sim::BytePort {
 public:
  explicit FakePort(std::shared_ptr<PortEnd> end) : end_(std::move(end)) {}
  sim::Bytes read() override {
    const auto* data = reinterpret_cast<const std::byte*>(end_->to_world.data());
    sim::Bytes bytes(data, data + end_->to_world.size());
    end_->to_world.clear();
    return bytes;
  }
  void write(std::span<const std::byte> bytes) override {
    std::string& text = end_->from_world;
    text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.size() <= end_->room_bytes) return;
    end_->dropped_bytes += text.size() - end_->room_bytes;
    text.erase(0, text.size() - end_->room_bytes);
  }
  std::uint64_t dropped_bytes() const override { return end_->dropped_bytes; }

 private:
  std::shared_ptr<PortEnd> end_;
};

/// A world whose serial ports end in the test, by their paths.
class WorldWithPorts {
 public:
  explicit WorldWithPorts(const std::string& yaml)
      : loaded(sim::load_world_text(yaml, "worlds/test.yaml", LoadedTestWorld::with_messages({}))),
        world(loaded.config, bus, [this](sim::PortKind, const std::string& path) {
          ends[path] = std::make_shared<PortEnd>();
          return std::make_unique<FakePort>(ends[path]);
        }) {}
  void run_for(double time_s) {
    const sim::Time end = world.now() + sim::from_seconds(time_s);
    while (world.now() < end) world.step();
  }

  std::map<std::string, std::shared_ptr<PortEnd>> ends;
  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
};

}  // namespace test
