// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "sim/bus/bus.hpp"

namespace sim {

/// A stream of bytes to a program outside: a pseudo-terminal or a FIFO.  Never waits.
class BytePort {
 public:
  virtual ~BytePort() = default;
  /// What has arrived since the last call; often nothing.
  virtual Bytes read() = 0;
  /// Queues bytes; what the reader does not fetch is dropped, oldest first, and counted.
  virtual void write(std::span<const std::byte> bytes) = 0;
  virtual std::uint64_t dropped_bytes() const = 0;
};

/// A pseudo-terminal, or a pair of FIFOs PATH.in and PATH.out.
enum class PortKind { pty, fifo };

/// Opens a port.  Throws std::runtime_error that names the path.
using PortOpener = std::function<std::unique_ptr<BytePort>(PortKind kind, const std::string& path)>;

}  // namespace sim
