// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "sim/bus/bus.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/stage.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class PublishAction final : public Action {
 public:
  static constexpr const char* meaning = "publishes a message";
  static constexpr const char* main_key = "channel";
  static constexpr bool main_alone = false;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    read_channel(in, main);
    in.require("type");
    in.read("type", type_, "message type, such as shoal.twist_command_t");
    in.read_raw(
        "value", value_,
        "member: value; members that are missing are 0, or NaN in commands where that means as before; utime is "
        "the time");
    if (in.describing() || value_.kind != ConfigNode::Kind::null) return;
    // No value means a message whose members are all at their defaults.
    value_.kind = ConfigNode::Kind::map;
    value_.place = in.node()->place;
  }

  /// Encodes the message.
  void check(const ActionCheck& check) override {
    const EncodeMessage& encode = check.world().encode_message;
    if (!encode) return check.error("messages cannot be encoded here");
    check_device(check);
    Diagnostics found(check.entry().who);
    payload_ = encode(type_, value_, found);
    for (const std::string& line : found.lines()) check.diagnostics().error({}, "", line);
    if (found.ok() && value_.find("utime") == nullptr) stamp_utime_ = starts_with_utime(encode, check.entry().place);
  }

  void carry_out(const ActionRun& run) const override {
    Bytes payload = payload_;
    if (stamp_utime_) set_utime(payload, run.stage.config().epoch_us + run.stage.now().count());
    run.stage.publish(channel_, payload);
  }

  void add_channels(std::set<std::string>& channels) const override { channels.insert(channel_); }

 private:
  /// Reports a message of a type that the device with this command channel does not take.
  void check_device(const ActionCheck& check) const {
    for (const VehicleInstance& vehicle : check.world().vehicles)
      for (const DeviceConfig& device : vehicle.config->devices) {
        if (device.device_type == nullptr || !device.device_type->takes_commands()) continue;
        if (device_channel(check.world().channels, vehicle.name, device, ChannelKind::command) != channel_) continue;
        const std::string accepted = device.device_type->command_messages;
        if ((", " + accepted + ",").find(", " + type_ + ",") == std::string::npos)
          check.error("device '" + vehicle.name + "/" + device.name + "' takes " + accepted + " on '" + channel_ +
                      "', not '" + shortened(printable(type_)) + "'");
      }
  }

  void read_channel(ParamReader& in, const char* key) {
    in.read(key, channel_, "the message's channel, 1 to 63 characters");
    if (!in.has(key)) return;
    if (channel_.empty() || channel_.size() > Bus::max_channel_length)
      in.error(key, "a channel must have 1 to 63 characters, got " + std::to_string(channel_.size()));
    else if (channel_.starts_with("sim.") || printable(channel_) != channel_)
      in.error(key, "channel '" + printable(channel_) +
                        "' cannot be published on: sim.* belongs to the simulator, and names are printable");
  }

  /// Returns whether the first member is `int64_t utime`, by encoding different values, because sim/ does not depend on
  /// message types.
  bool starts_with_utime(const EncodeMessage& encode, const SourcePlace& place) const {
    ConfigNode stamped = value_;
    stamped.entries.push_back({"utime", place, scalar_node("1", place)});
    Diagnostics ignored;
    const Bytes with = encode(type_, stamped, ignored);
    if (!ignored.ok() || !utime_of(payload_)) return false;
    Bytes expected = payload_;
    set_utime(expected, 1);
    return with == expected;
  }

  std::string channel_;
  std::string type_;
  ConfigNode value_;
  Bytes payload_;
  bool stamp_utime_ = false;  ///< whether the first member is a time stamp without a given value
};

SHOAL_ACTION("publish", PublishAction);

}  // namespace

}  // namespace sim
