// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bridges::rosbridge {

/// Type of ROS 2, read from its `ros2msg` text: what a message in CDR consists of.
class RosType {
 public:
  enum class Kind {
    boolean,
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    int64,
    uint64,
    float32,
    float64,
    text,
    compound
  };
  enum class Array { none, fixed, sequence };
  struct Member {
    std::string name;
    std::string type;  ///< as in the text, without brackets
    Kind kind = Kind::uint8;
    std::size_t compound = 0;  ///< index of its definition
    Array array = Array::none;
    std::size_t count = 1;  ///< of a fixed array
    bool is_binary() const { return array != Array::none && kind == Kind::uint8; }
  };
  struct Definition {
    std::string name;  ///< such as `sensor_msgs/LaserScan`
    std::vector<Member> members;
  };

  /// `name`: such as `sensor_msgs/msg/LaserScan`.  `schema`: its definition and those of all types that it uses, as
  /// ros2::schema_text() and ros2::standard_schema_text() have them.  Throws std::invalid_argument for another text.
  RosType(std::string_view name, std::string_view schema);

  /// Returns the definition of the type, then those of the types that it uses.
  const std::vector<Definition>& definitions() const { return definitions_; }

 private:
  void resolve();

  std::vector<Definition> definitions_;
};

/// Returns the name of a type without `msg`: `sensor_msgs/LaserScan`, which clients of ROS 1 write.
std::string short_name(std::string_view type);

/// Appends a message in CDR as JSON, as clients of rosbridge expect it: arrays of bytes as text in base64, and `null`
/// for a number that is not finite.  Returns false, and appends `null`, if the bytes are not of this type.
bool append_json(const RosType& type, std::string_view cdr, std::string& text);

/// Largest message that cdr_of_json() makes.
inline constexpr std::size_t max_client_cdr_bytes = std::size_t{1} << 20;

/// Returns a message of a client in CDR.  Missing members are 0, false or empty; missing numbers with a fraction are
/// `missing`.  `null` is NaN.  Arrays of bytes may be lists of numbers or text in base64.  Throws WebError with the
/// member and the rule for members that the type does not have, and for values of another type or out of range.
std::vector<std::byte> cdr_of_json(const RosType& type, const nlohmann::json& message, double missing = 0);

}  // namespace bridges::rosbridge
