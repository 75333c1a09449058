// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/bus/byte_port.hpp"

namespace bridges {

/// Opens a sim::BytePort for a program on this machine.
///   pty:  `path` becomes a symbolic link to a new pseudo-terminal in raw mode; any terminal program can open it.
///   fifo: `path`.in is a FIFO that programs write to, `path`.out one that they read from.
/// `path` is relative to `folder` and lies below it: missing folders are created, links in it are not followed. Links
/// and FIFOs are removed when the port closes, unless they have been replaced by then. Remains of a run that was killed
/// are replaced: a link in the form used by Shoal (`/dev/pts/./7`) whose terminal no run holds, or a FIFO of this user
/// with the sticky bit set and without a reader. Anything else at the path is an error. Throws std::runtime_error with
/// the path.
std::unique_ptr<sim::BytePort> open_serial_port(sim::PortKind kind, const std::string& folder, const std::string& path);
/// Opens a port at a trusted path; links in it are followed.
std::unique_ptr<sim::BytePort> open_serial_port(sim::PortKind kind, const std::string& path);

}  // namespace bridges
