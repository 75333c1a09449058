// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "sim/bus/bus.hpp"

namespace sim {

/// Byte stream to an external program: a pseudo-terminal or a pair of FIFOs.  Never blocks.
class BytePort {
 public:
  virtual ~BytePort() = default;
  /// Returns the bytes that have arrived since the last call; often none.
  virtual Bytes read() = 0;
  /// Queues bytes.  Bytes that the reader does not fetch are dropped, oldest first, and counted.
  virtual void write(std::span<const std::byte> bytes) = 0;
  virtual std::uint64_t dropped_bytes() const = 0;
};

/// Kind of port: a pseudo-terminal, or a pair of FIFOs PATH.in and PATH.out.
enum class PortKind { pty, fifo };

/// Function that opens a port.  Throws std::runtime_error with the path.
using PortOpener = std::function<std::unique_ptr<BytePort>(PortKind kind, const std::string& path)>;

}  // namespace sim
