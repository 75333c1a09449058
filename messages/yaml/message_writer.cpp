// SPDX-License-Identifier: BSD-3-Clause
#include "messages/yaml/message_writer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sim/config/message_text.hpp"
#include "sim/config/param_reader.hpp"

namespace shoal {

namespace {

using sim::ConfigNode;
using Kind = ConfigNode::Kind;

constexpr int max_depth = 32;  // limit of recursive types

/// Makes a map with one key, so that a value is read with the rules and messages of that key.
ConfigNode map_of(const std::string& key, const ConfigNode& value) {
  ConfigNode map;
  map.kind = Kind::map;
  map.place = value.place;
  map.entries.push_back({key, value.place, value});
  return map;
}

/// Members of a type in which NaN means "unchanged".
struct AsBefore {
  const char* type;
  std::vector<std::string> members;
};

const std::vector<AsBefore>& as_before_table() {
  // Zero in these members would be a command (drive to 0, dive to 0); YAML that leaves them out means 'as before'.
  static const std::vector<AsBefore> table{
      {"shoal.helm_command_t", {"speed_mps", "heading_rad", "depth_m", "altitude_m"}},
      {"shoal.station_command_t", {"x_m", "y_m", "depth_m", "heading_rad"}},
      {"shoal.waypoints_command_t", {"depth_m", "speed_mps"}},
      {"shoal.motion_command_t", {"from_s", "to_s", "rate"}},
      {"shoal.joint_frames_t", {"position"}},
      {"shoal.pan_tilt_zoom_command_t", {"pan_rad", "tilt_rad", "fov_rad", "pan_radps", "tilt_radps", "fov_radps"}},
  };
  return table;
}

bool nan_means_as_before(const MessageSchema& schema, const Member& member) {
  const std::vector<AsBefore>& table = as_before_table();
  return std::any_of(table.begin(), table.end(), [&](const AsBefore& row) {
    return schema.name == row.type &&
           std::find(row.members.begin(), row.members.end(), member.name) != row.members.end();
  });
}

bool is_nan(const ConfigNode& value) {
  if (value.kind != Kind::scalar || value.quoted) return false;
  for (const char* word : {".nan", ".NaN", ".NAN", "nan", "NaN"})
    if (value.scalar == word) return true;
  return false;
}

class Writer {
 public:
  explicit Writer(sim::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void write(const MessageSchema& schema, const ConfigNode& value, const std::string& who, int depth = 0) {
    if (depth > max_depth) return diagnostics_.error(value.place, who, "is nested deeper than 32");
    if (value.kind != Kind::map && value.kind != Kind::null)
      return diagnostics_.error(value.place, who, "must be a map of members, got " + sim::shown(value));
    refuse_unknown(schema, value, who);
    const std::vector<std::int64_t> lengths = lengths_of(schema, value, who);
    for (const Member& member : schema.members) {
      const ConfigNode* given = value.find(member.name);
      // The length follows from its array and need not be written.
      if (member.length_slot >= 0)
        write_length(member, lengths[static_cast<std::size_t>(member.length_slot)], given, who);
      else
        write_dimension(member, given ? *given : ConfigNode{},
                        {lengths, 0, member.name, who, depth, nan_means_as_before(schema, member)});
    }
  }

  void put_word(std::uint64_t word, std::size_t size) {
    for (std::size_t i = size; i-- > 0;) bytes_.push_back(static_cast<std::byte>(word >> (8 * i) & 0xff));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  /// Position of the writer within a member.
  struct Spot {
    const std::vector<std::int64_t>& lengths;
    std::size_t dimension;
    std::string name;
    const std::string& who;
    int depth;
    bool as_before;  // NaN is allowed, and missing values are NaN
  };

  void refuse_unknown(const MessageSchema& schema, const ConfigNode& value, const std::string& who) {
    std::vector<std::string> known;
    for (const Member& member : schema.members) known.push_back(member.name);
    for (const ConfigNode::Entry& entry : value.entries)
      if (std::find(known.begin(), known.end(), entry.key) == known.end())
        diagnostics_.error(entry.place, who,
                           "unknown member '" + sim::shortened(sim::printable(entry.key)) +
                               "'; members: " + sim::list_text(known) + sim::did_you_mean(entry.key, known));
  }

  /// Returns the length of each array, from the first list with this length; an explicit length must be equal.
  std::vector<std::int64_t> lengths_of(const MessageSchema& schema, const ConfigNode& value, const std::string& who) {
    std::vector<std::int64_t> lengths(static_cast<std::size_t>(schema.length_slots), -1);
    for (const Member& member : schema.members) {
      const ConfigNode* list = value.find(member.name);
      for (const Dimension& dimension : member.dimensions) {
        if (list == nullptr) break;
        const bool text = list->kind == Kind::scalar && member.type == WireType::byte;
        const auto size = static_cast<std::int64_t>(text ? list->scalar.size() : list->items.size());
        if (dimension.is_variable()) {
          std::int64_t& known = lengths[static_cast<std::size_t>(dimension.length_slot)];
          if (known >= 0 && known != size)
            diagnostics_.error(list->place, who,
                               "'" + member.name + "' has " + std::to_string(size) + " elements, but '" +
                                   dimension.text + "' is " + std::to_string(known) + " by an array before it");
          known = std::max(known, size);
        }
        list = list->items.empty() ? nullptr : &list->items.front();
      }
    }
    for (std::int64_t& length : lengths) length = std::max<std::int64_t>(length, 0);
    return lengths;
  }

  void write_length(const Member& member, std::int64_t length, const ConfigNode* given, const std::string& who) {
    put_word(static_cast<std::uint64_t>(length), wire_size(member.type));
    if (given == nullptr) return;
    std::int64_t reported = length;
    const ConfigNode map = map_of(member.name, *given);
    sim::ParamReader in(map, who, diagnostics_);
    in.read(member.name.c_str(), reported, sim::at_least(0), "");
    if (reported != length)
      in.error(member.name.c_str(),
               "'" + member.name + "' follows from its array, which has " + std::to_string(length) + " elements");
  }

  void write_dimension(const Member& member, const ConfigNode& value, Spot spot) {
    if (spot.dimension == member.dimensions.size()) return write_value(member, value, spot);
    const Dimension& dimension = member.dimensions[spot.dimension++];
    const std::int64_t size =
        dimension.is_variable() ? spot.lengths[static_cast<std::size_t>(dimension.length_slot)] : dimension.constant;
    const bool last = spot.dimension == member.dimensions.size();
    // Payloads of modems are bytes, and people write them as text.
    if (last && member.type == WireType::byte && value.kind == Kind::scalar) return write_text_bytes(value, size, spot);
    const auto given = static_cast<std::int64_t>(value.items.size());
    if (value.kind != Kind::null && (value.kind != Kind::list || given != size)) {
      diagnostics_.error(
          value.place, spot.who,
          "'" + spot.name + "' must be a list of " + std::to_string(size) + ", got " + sim::shown(value));
      return;
    }
    const std::string name = spot.name;
    for (std::int64_t i = 0; i < size; ++i) {
      spot.name = name + "[" + std::to_string(i) + "]";
      write_dimension(member, given == 0 ? ConfigNode{} : value.items[static_cast<std::size_t>(i)], spot);
    }
  }

  void write_text_bytes(const ConfigNode& value, std::int64_t size, const Spot& spot) {
    if (static_cast<std::int64_t>(value.scalar.size()) != size)
      diagnostics_.error(
          value.place, spot.who,
          "'" + spot.name + "' must be " + std::to_string(size) + " bytes, got " + std::to_string(value.scalar.size()));
    for (const char c : value.scalar) bytes_.push_back(static_cast<std::byte>(c));
  }

  void write_value(const Member& member, const ConfigNode& value, const Spot& spot) {
    if (member.type == WireType::compound)
      return write(*member.compound, value, spot.who.empty() ? spot.name : spot.who + ": " + spot.name, spot.depth + 1);
    const bool missing = value.kind == Kind::null;
    if (spot.as_before && (missing || is_nan(value)))
      return put_real(member.type, std::numeric_limits<double>::quiet_NaN());
    // Missing members are 0.
    const ConfigNode map = missing ? ConfigNode{} : map_of(spot.name, value);
    sim::ParamReader in(map, spot.who, diagnostics_);
    const char* key = spot.name.c_str();
    if (member.type == WireType::string) return write_string(in, key);
    if (member.type == WireType::boolean) {
      bool flag = false;
      in.read(key, flag, "");
      return put_word(flag ? 1 : 0, 1);
    }
    if (member.type == WireType::float32 || member.type == WireType::float64) return write_real(member.type, in, key);
    std::int64_t whole = 0;
    in.read(key, whole, range_of(member.type), "");
    put_word(static_cast<std::uint64_t>(whole), wire_size(member.type));
  }

  void write_string(sim::ParamReader& in, const char* key) {
    std::string text;
    in.read(key, text, "");
    if (text.find('\0') != std::string::npos) in.error(key, "'" + std::string(key) + "' must not contain a NUL");
    put_word(text.size() + 1, 4);
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
    bytes_.push_back(std::byte{0});
  }

  void write_real(WireType type, sim::ParamReader& in, const char* key) {
    double number = 0;
    const double max = type == WireType::float32 ? static_cast<double>(std::numeric_limits<float>::max())
                                                 : std::numeric_limits<double>::max();
    in.read(key, number, sim::between(-max, max), "");
    put_real(type, number);
  }

  void put_real(WireType type, double number) {
    if (type == WireType::float32)
      put_word(std::bit_cast<std::uint32_t>(static_cast<float>(number)), 4);
    else
      put_word(std::bit_cast<std::uint64_t>(number), 8);
  }

  static sim::Rule range_of(WireType type) {
    if (type == WireType::byte) return sim::between(0, 255);
    if (type == WireType::int64) return sim::any_number();
    const double half = std::ldexp(1.0, static_cast<int>(8 * wire_size(type)) - 1);
    return sim::between(-half, half - 1);
  }

  sim::Diagnostics& diagnostics_;
  std::vector<std::byte> bytes_;
};

}  // namespace

bool has_unchanged(std::string_view type) {
  const std::vector<AsBefore>& table = as_before_table();
  return std::any_of(table.begin(), table.end(), [&](const AsBefore& row) { return row.type == type; });
}

std::vector<std::byte> encode_message(const MessageTypes& types, const std::string& type, const sim::ConfigNode& value,
                                      sim::Diagnostics& diagnostics) {
  const MessageSchema* schema = types.find(type);
  if (schema == nullptr) {
    std::vector<std::string> known;
    for (const auto& [name, each] : types.all()) known.push_back(name);
    const std::string meant = sim::did_you_mean(type, known);
    diagnostics.error(value.place, "",
                      "unknown message type '" + sim::shortened(sim::printable(type)) + "'" +
                          (meant.empty() ? "; `shoal list messages` shows them" : meant));
    return {};
  }
  const std::size_t errors_before = diagnostics.lines().size();
  Writer writer(diagnostics);
  writer.put_word(schema->fingerprint, 8);
  writer.write(*schema, value, schema->name);
  if (diagnostics.lines().size() != errors_before) return {};
  return writer.take();
}

std::vector<std::byte> encode_own_message(const std::string& type, const sim::ConfigNode& value,
                                          sim::Diagnostics& diagnostics) {
  return encode_message(embedded_types(), type, value, diagnostics);
}

}  // namespace shoal
