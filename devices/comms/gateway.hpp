// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <deque>
#include <string>
#include <vector>

#include "devices/comms/message_modem.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Gateway between two modems of one vehicle, such as the radio and the acoustic modem of a buoy.  A message received
/// by one is sent by the other after `delay_s`; it is never returned to its source, and the same bytes are not
/// forwarded twice within `repeat_s`, so that two gateways between the same networks do not form a loop.
class Gateway final : public sim::Sensor {
 public:
  static constexpr const char* meaning = "Gateway: passes messages between two modems of its vehicle.";
  static constexpr double default_rate_hz = 1;
  static constexpr const char* example = "between: [radio, sound]";
  struct Params {
    std::vector<std::string> between;
    std::vector<std::string> destinations{"", ""};
    double delay_s = 0;
    double repeat_s = 60;
    bool name_source = false;
    std::string only_prefix;
    int queue_messages = 64;
    void read(sim::ParamReader& in);
  };
  /// Counts of one direction: from the first modem to the second, or back.
  struct Counts {
    std::int64_t passed = 0, too_long = 0, repeated = 0, refused = 0;
    void visit_state(sim::StateArchive& archive) { archive(passed, too_long, repeated, refused); }
  };

  /// Throws ConfigError when `between` does not name two modems of the vehicle, or `destinations` no vehicles.
  Gateway(const Params& params, const sim::DeviceContext& context);
  void act(const sim::ActContext& context);
  void measure(const sim::SenseContext&) override { counts_ = counting_; }
  void disturb(double, sim::Random&) override {}
  void visit_state(sim::StateArchive& archive) override;
  const std::array<Counts, 2>& counts() const { return counts_; }

 private:
  struct Message {
    sim::Time due{0};
    std::size_t from = 0;  // or 1
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(due, from, data); }
  };
  struct Seen {
    sim::Time at{0};
    sim::Bytes data;
    void visit_state(sim::StateArchive& archive) { archive(at, data); }
  };

  void find_modems();
  void arrived(std::size_t from, sim::Time at, const std::string& source, const sim::Bytes& data);
  /// Returns whether `data` equals `seen`, with `name_source` also when vehicle names precede the bytes.
  bool is_same(const sim::Bytes& data, const sim::Bytes& seen) const;
  /// Returns whether the same message was forwarded within repeat_s.
  bool seen_before(sim::Time at, const sim::Bytes& data);
  void remember(sim::Time at, const sim::Bytes& data);

  Params params_;
  const sim::World& world_;
  const sim::Vehicle& vehicle_;
  const sim::DeviceFaults& faults_;
  const MessageModems& all_modems_;
  std::array<MessageModem*, 2> modems_{};  // found at the first step, because they may follow this device in the file
  std::deque<Message> waiting_;
  std::deque<Seen> seen_;
  std::array<Counts, 2> counting_, counts_;
};

}  // namespace devices
