// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/bus/byte_port.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/state/state_archive.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// A connection of other programs to a modem, in addition to the bus.
struct SerialParams {
  sim::PortKind kind = sim::PortKind::pty;
  std::string path;
  void read(sim::ParamReader& in);
};

/// The same for bytes that are messages.
struct SerialMessageParams : SerialParams {
  enum class Framing {
    line,  ///< a message is a line
    raw,   ///< a message is what came within a step
  };

  Framing framing = Framing::line;
  void read(sim::ParamReader& in);
};

/// Bytes of the serial ports of a world that no program read, since its start.  It depends on the programs at their
/// other ends, and is no part of the state.
std::uint64_t serial_dropped_bytes(const sim::World& world);

/// The port of a device; without one where the program that builds the world offers none.
class SerialPort {
 public:
  /// Throws std::runtime_error that names device and path.
  SerialPort(const SerialParams& params, const sim::DeviceContext& context);

  sim::Bytes read();
  /// Never blocks: unread bytes are eventually dropped, oldest first.  The world reports it once.
  void write(std::span<const std::byte> bytes);
  void write(const std::string& text);

 private:
  sim::DeviceHost& host_;
  std::string who_, path_;
  std::unique_ptr<sim::BytePort> port_;
  std::uint64_t dropped_bytes_ = 0;  // that were counted already
};

/// What came by a serial port is too long for a message: counted as a bad message.
void warn_of_length(sim::WorldWarnings& warnings, const std::string& device, std::size_t max_bytes);

/// Messages through a serial port: lines, or what came within a step.
class SerialMessages {
 public:
  SerialMessages(const SerialMessageParams& params, const sim::DeviceContext& context);

  /// What has come since the last call.  A message that is too long has max_bytes + 1 bytes.
  std::vector<sim::Bytes> take(std::size_t max_bytes);
  void write(sim::Bytes data);
  /// The received part of an unfinished line.  What is in the port itself is beyond the simulator.
  void visit_state(sim::StateArchive& archive) { archive(line_, cut_); }

 private:
  SerialPort port_;
  bool lines_;
  sim::Bytes line_;   // not yet ended
  bool cut_ = false;  // more of it came than is in line_
};

}  // namespace devices
