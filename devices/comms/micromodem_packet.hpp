// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/time.hpp"
#include "sim/bus/bus.hpp"
#include "sim/state/state_archive.hpp"

namespace devices {

/// What goes through the water between two Micro-Modems.
struct MicromodemPacket {
  enum class Kind { cycle_init, data, ack, ping, ping_reply, mini };
  struct Frame {
    bool ack = false;  ///< asks for an acknowledgement
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(ack, data); }
  };

  Kind kind = Kind::mini;
  int source = 0, destination = 0;
  int rate = 0;               ///< of a cycle
  bool ack = false;           ///< the cycle asks for acknowledgements
  int frame_count = 0;        ///< of the cycle
  int value = 0;              ///< of a mini-packet; of an acknowledgement: bit i stands for frame i
  std::vector<Frame> frames;  ///< of data

  bool is_short() const { return kind != Kind::data; }
  int data_bytes() const;
  /// All but the data, as text for Signal::code; the data one after the other, for Signal::payload.
  std::string code() const;
  sim::Bytes payload() const;
  /// Nothing when it is of no Micro-Modem.
  static std::optional<MicromodemPacket> read(const std::string& code, const sim::Bytes& payload);
};

}  // namespace devices
