// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "shoal/message_codec.hpp"

namespace bridges::ros2 {

/// Point of the surface of a body.
struct SurfacePoint {
  std::array<float, 3> position_m{};
  std::uint32_t rgb = 0;  ///< 0xrrggbb
};

/// Context that earlier messages of a record give a converter.
struct ConverterContext {
  /// Part of a scene whose shape is an asset.
  struct AssetPart {
    std::string asset, frame, name;
    std::int32_t id = 0;
    std::array<double, 7> pose{};  ///< in the frame: x, y, z, qw, qx, qy, qz
    std::array<float, 4> rgba{};
  };

  /// Device of the last `sim.scene`; as it is here, one that is not known.
  struct Device {
    std::string vehicle, parent;    ///< parent: frame in which it is mounted
    std::array<double, 7> pose{};   ///< in the parent: x, y, z, qw, qx, qy, qz
    std::array<double, 3> axis{1};  ///< of a beam, in its own frame
    float range_min_m = 0;
    float range_max_m = std::numeric_limits<float>::infinity();
    float opening_rad = 0;  ///< of a beam, full angle
    bool is_camera = false;
    /// Returns whether its beam is not along x.
    bool is_turned() const { return axis[0] < 1 - 1e-9; }
  };

  /// Returns the device that reports on a channel or on its truth channel.
  const Device& device_of(std::string_view channel) const {
    static const Device unknown;
    const auto known = devices.find(frame_of(channel));
    return known == devices.end() ? unknown : known->second;
  }

  std::map<std::string, Device, std::less<>> devices;            ///< by frame
  std::map<std::string, std::array<double, 7>> odometry_frames;  ///< poses in the world of where wheel odometry starts
  /// Coordinate frames of the bodies of the last `sim.scene`, by their numbers, and its revision.
  std::map<std::int32_t, std::string> body_frames;
  std::int32_t scene_revision = -1;
  /// Parts of the last `sim.scene`, and the contents of `sim.asset` by hash.
  std::vector<AssetPart> asset_parts;
  std::map<std::string, std::vector<std::uint8_t>, std::less<>> assets;

  /// Points of the surfaces of the last `sim.scene`.
  struct Surfaces {
    std::map<std::int32_t, std::vector<SurfacePoint>> moving;  ///< by the number of the body, in its frame
    std::vector<SurfacePoint> fixed;                           ///< in the world
  };
  /// Returns them, from the scene and the assets so far.
  const Surfaces& surfaces();
  /// Forgets them; `scene`: JSON of the next ones, none: as before.
  void renew_surfaces(const std::optional<std::string>& scene = {});
  std::optional<std::int64_t> moving_surfaces_utime;  ///< when they were sent
  bool fixed_surfaces_are_sent = false;

 private:
  std::string scene_;
  std::optional<Surfaces> surfaces_;
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

/// Adds a function that takes a message, channel or context or both, and a writer.
template <class Message, class... Inputs>
bool add_converter(const char* ros_type, const char* topic, bool (*write)(const Message& message, Inputs... inputs)) {
  return add_converter(
      Message::getTypeName(), ros_type, topic,
      [write](std::span<const std::byte> payload, std::string_view channel, ConverterContext& context,
              std::vector<std::byte>& cdr) {
        CdrWriter out(cdr);
        const Message message = shoal::decode<Message>(payload, shoal::Finite::any);
        if constexpr (std::is_invocable_v<decltype(write), const Message&, std::string_view, ConverterContext&,
                                          CdrWriter&>)
          return write(message, channel, context, out);
        else if constexpr (std::is_invocable_v<decltype(write), const Message&, ConverterContext&, CdrWriter&>)
          return write(message, context, out);
        else
          return write(message, channel, out);
      });
}

}  // namespace detail

/// Registers a converter, in its own file of bridges/ros2/converters.  `write` is a function
/// `bool write(const Message&, std::string_view channel, CdrWriter&)`, which appends the standard message; a
/// ConverterContext& may be in place of the channel, or after it.
#define SHOAL_ROS2_CONVERTER(write, ros_type, topic) \
  [[maybe_unused]] static const bool registered_##write = ::bridges::ros2::detail::add_converter(ros_type, topic, write)

}  // namespace bridges::ros2
