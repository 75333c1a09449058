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

/// Parameters of a serial connection of other programs to a device, in addition to the bus.
struct SerialParams {
  sim::PortKind kind = sim::PortKind::pty;
  std::string path;
  void read(sim::ParamReader& in);
};

/// Parameters of a serial connection that carries messages.
struct SerialMessageParams : SerialParams {
  enum class Framing {
    line,  ///< each line is a message
    raw,   ///< the bytes received within a step are a message
  };

  Framing framing = Framing::line;
  void read(sim::ParamReader& in);
};

/// Returns the number of bytes of the serial ports of a world that no program has read since its start.  It depends on
/// the connected programs, and is not part of the state.
std::uint64_t serial_dropped_bytes(const sim::World& world);

/// Serial port of a device; inactive when the program that builds the world supplies no ports.
class SerialPort {
 public:
  /// Throws std::runtime_error with device and path.
  SerialPort(const SerialParams& params, const sim::DeviceContext& context);

  sim::Bytes read();
  /// Never blocks: unread bytes are eventually dropped, oldest first.  The world reports it once.
  void write(std::span<const std::byte> bytes);
  void write(const std::string& text);

 private:
  sim::DeviceHost& host_;
  std::string who_, path_;
  std::unique_ptr<sim::BytePort> port_;
  std::uint64_t dropped_bytes_ = 0;  // already counted
};

/// Counts and reports data from a serial port that are too long for a message as a bad message.
void warn_of_length(sim::WorldWarnings& warnings, const std::string& device, std::size_t max_bytes);

/// Messages through a serial port: lines, or the bytes received within a step.
class SerialMessages {
 public:
  SerialMessages(const SerialMessageParams& params, const sim::DeviceContext& context);

  /// Returns the messages received since the last call.  A message that is too long has max_bytes + 1 bytes.
  std::vector<sim::Bytes> take(std::size_t max_bytes);
  void write(sim::Bytes data);
  /// Visits the received part of an unfinished line.  Bytes in the port itself are outside of the simulator.
  void visit_state(sim::StateArchive& archive) { archive(line_, cut_); }

 private:
  SerialPort port_;
  bool lines_;
  sim::Bytes line_;   // not yet complete
  bool cut_ = false;  // the line was longer than line_
};

}  // namespace devices
