// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/ros2/cdr_writer.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "shoal/message_codec.hpp"

namespace bridges::ros2 {

/// What earlier messages of a record tell a converter.
struct ConverterContext {
  /// Part of a scene whose shape is an asset.
  struct AssetPart {
    std::string asset, frame, name;
    std::int32_t id = 0;
    std::array<double, 7> pose{};  ///< in the frame: x, y, z, qw, qx, qy, qz
    std::array<float, 4> rgba{};
  };

  /// Coordinate frames of the bodies of the last `sim.scene`, by their numbers, and its revision.
  std::map<std::int32_t, std::string> body_frames;
  std::int32_t scene_revision = -1;
  /// Parts of the last `sim.scene`, and the contents of `sim.asset` by hash.
  std::vector<AssetPart> asset_parts;
  std::map<std::string, std::vector<std::uint8_t>, std::less<>> assets;
};

/// Conversion of the messages of an LCM type into a standard type of ROS 2.
struct Converter {
  std::string lcm_type;  ///< such as "shoal.gps_data_t"
  std::string ros_type;  ///< such as "sensor_msgs/msg/NavSatFix"
  std::string topic;     ///< "fix": /CHANNEL/fix; with a leading slash: this topic for all channels
  /// Converts a valid payload; returns false when the standard type cannot express the message.  May throw
  /// shoal::MessageError.
  std::function<bool(std::span<const std::byte> payload, std::string_view channel, ConverterContext& context,
                     std::vector<std::byte>& cdr)>
      convert;

  /// Topic of the converted messages of a channel.
  std::string topic_for(std::string_view channel) const;
};

/// Table of all converters, filled before main by SHOAL_ROS2_CONVERTER.
class ConverterTable {
 public:
  static ConverterTable& instance();
  /// Adds a converter.  Two with the same type and topic are a programming error.
  void add(Converter converter);
  /// Returns the converters of an LCM type, sorted by topic; each remains valid.
  std::vector<const Converter*> of(std::string_view lcm_type) const;
  /// Returns all, sorted by LCM type and topic.
  std::vector<const Converter*> all() const;

 private:
  std::vector<std::unique_ptr<Converter>> converters_;
};

namespace detail {

/// Adds a converter of the type with this name in package shoal.
bool add_converter(const char* message, const char* ros_type, const char* topic, decltype(Converter::convert) convert);

template <class Message>
bool add_converter(const char* ros_type, const char* topic,
                   bool (*write)(const Message& message, std::string_view channel, CdrWriter& out)) {
  return add_converter(Message::getTypeName(), ros_type, topic,
                       [write](std::span<const std::byte> payload, std::string_view channel, ConverterContext&,
                               std::vector<std::byte>& cdr) {
                         CdrWriter out(cdr);
                         return write(shoal::decode<Message>(payload, shoal::Finite::any), channel, out);
                       });
}

template <class Message>
bool add_converter(const char* ros_type, const char* topic,
                   bool (*write)(const Message& message, ConverterContext& context, CdrWriter& out)) {
  return add_converter(Message::getTypeName(), ros_type, topic,
                       [write](std::span<const std::byte> payload, std::string_view, ConverterContext& context,
                               std::vector<std::byte>& cdr) {
                         CdrWriter out(cdr);
                         return write(shoal::decode<Message>(payload, shoal::Finite::any), context, out);
                       });
}

}  // namespace detail

/// Registers a converter, in its own file of bridges/ros2/converters.  `write` is a function
/// `bool write(const Message&, std::string_view channel, CdrWriter&)`, which appends the standard message, or one that
/// takes a ConverterContext& in place of the channel.
#define SHOAL_ROS2_CONVERTER(write, ros_type, topic) \
  [[maybe_unused]] static const bool registered_##write = ::bridges::ros2::detail::add_converter(ros_type, topic, write)

}  // namespace bridges::ros2
