#pragma once

#include "sim/bus/byte_port.hpp"

namespace bridges {

/// Opens a sim::BytePort for a program on this machine.
///   pty:  `path` becomes a symbolic link to a new pseudo-terminal in raw mode; any terminal program can open it.
///   fifo: `path`.in is a FIFO that programs write to, `path`.out one that they read from.
/// Both are removed when the port closes.  What a dead run left behind (a link to a terminal that is gone or belongs to
/// another program now, a FIFO) is replaced; anything else at the path is an error.  Throws std::runtime_error that
/// names the path.
std::unique_ptr<sim::BytePort> open_serial_port(const std::string& kind, const std::string& path);

}  // namespace bridges
