// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// Packet transmitted through the water between two Micro-Modems.
struct MicromodemPacket {
  enum class Kind { cycle_init, data, ack, ping, ping_reply, mini };
  struct Frame {
    bool ack = false;  ///< requests an acknowledgement
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(ack, data); }
  };

  Kind kind = Kind::mini;
  int source = 0, destination = 0;
  int rate = 0;               ///< rate of a cycle
  bool ack = false;           ///< the cycle requests acknowledgements
  int frame_count = 0;        ///< of the cycle
  int value = 0;              ///< value of a mini-packet; in an acknowledgement, bit i denotes frame i
  std::vector<Frame> frames;  ///< of data

  bool is_short() const { return kind != Kind::data; }
  int data_bytes() const;
  /// Return all fields except the data as text for Signal::code, and the concatenated data for Signal::payload.
  std::string code() const;
  sim::Bytes payload() const;
  /// Decodes a packet; none when it is not from a Micro-Modem.
  static std::optional<MicromodemPacket> read(const std::string& code, const sim::Bytes& payload);
};

}  // namespace devices
