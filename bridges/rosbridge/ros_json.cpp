// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/ros_json.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bridges/base/base64.hpp"
#include "bridges/base/json_text.hpp"
#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "bridges/web/web_error.hpp"

namespace bridges::rosbridge {
namespace {

using Json = nlohmann::json;
using Kind = RosType::Kind;
using Array = RosType::Array;

struct KindName {
  std::string_view name;
  Kind kind;
};

constexpr std::array kind_names{
    KindName{"bool", Kind::boolean},    KindName{"byte", Kind::uint8},    KindName{"char", Kind::uint8},
    KindName{"int8", Kind::int8},       KindName{"uint8", Kind::uint8},   KindName{"int16", Kind::int16},
    KindName{"uint16", Kind::uint16},   KindName{"int32", Kind::int32},   KindName{"uint32", Kind::uint32},
    KindName{"int64", Kind::int64},     KindName{"uint64", Kind::uint64}, KindName{"float32", Kind::float32},
    KindName{"float64", Kind::float64}, KindName{"string", Kind::text},
};

/// Calls `work` with a value of the type of a number or truth value.
template <class Work>
auto with_number(Kind kind, Work work) {
  switch (kind) {
    case Kind::int8:
      return work(std::int8_t{});
    case Kind::int16:
      return work(std::int16_t{});
    case Kind::uint16:
      return work(std::uint16_t{});
    case Kind::int32:
      return work(std::int32_t{});
    case Kind::uint32:
      return work(std::uint32_t{});
    case Kind::int64:
      return work(std::int64_t{});
    case Kind::uint64:
      return work(std::uint64_t{});
    case Kind::float32:
      return work(float{});
    case Kind::float64:
      return work(double{});
    default:
      return work(std::uint8_t{});
  }
}

/// Reads a line such as `float64[36] covariance  # comment`; constants and comments have no member.
std::optional<RosType::Member> member_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos || line.find('=') != std::string_view::npos) return std::nullopt;
  line.remove_prefix(begin);
  const std::size_t blank = line.find(' ');
  if (blank == std::string_view::npos) throw std::invalid_argument("no member: " + std::string(line));
  std::string_view type = line.substr(0, blank);
  RosType::Member member;
  member.name = line.substr(blank + 1, line.find_first_of(" \t", blank + 1) - blank - 1);
  if (const std::size_t bracket = type.find('['); bracket != std::string_view::npos) {
    const std::string_view count = type.substr(bracket + 1, type.size() - bracket - 2);
    member.array = count.empty() ? Array::sequence : Array::fixed;
    std::from_chars(count.data(), count.data() + count.size(), member.count);
    type = type.substr(0, bracket);
  }
  member.type = type;
  const auto* const known =
      std::find_if(kind_names.begin(), kind_names.end(), [&](const KindName& each) { return each.name == type; });
  member.kind = known == kind_names.end() ? Kind::compound : known->kind;
  return member;
}

/// Traversal of CDR, whose bytes may be anything: every function returns false where they end.
class JsonWriter {
 public:
  JsonWriter(const RosType& type, std::string_view cdr, std::string& text)
      : definitions_(type.definitions()), cdr_(cdr), out_(text) {}

  bool write(const RosType::Definition& definition) {
    out_ += '{';
    for (const RosType::Member& member : definition.members) {
      if (&member != &definition.members.front()) out_ += ',';
      out_ += '"';
      out_ += member.name;
      out_ += "\":";
      if (!write(member)) return false;
    }
    out_ += '}';
    return true;
  }

 private:
  bool write(const RosType::Member& member) {
    if (member.array == Array::none) return write_value(member);
    std::size_t count = member.count;
    if (member.array == Array::sequence && !read_count(count)) return false;
    if (member.is_binary()) return write_bytes(count);
    out_ += '[';
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) out_ += ',';
      if (!write_value(member)) return false;
    }
    out_ += ']';
    return true;
  }

  bool write_value(const RosType::Member& member) {
    if (member.kind == Kind::compound) return write(definitions_[member.compound]);
    if (member.kind == Kind::text) return write_text();
    return with_number(member.kind, [&](auto value) {
      if (!read(value)) return false;
      if (member.kind == Kind::boolean)
        out_ += value != 0 ? "true" : "false";
      else
        append(value);
      return true;
    });
  }

  template <class T>
  void append(T value) {
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) {
        out_ += "null";
        return;
      }
    std::array<char, 32> text;
    out_.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
  }

  bool write_text() {
    std::size_t size = 0;
    if (!read_count(size) || size == 0) return false;
    append_text(cdr_.substr(at_, size - 1));
    at_ += size;
    return true;
  }

  void append_text(std::string_view text) {
    const auto is_plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
    if (!std::all_of(text.begin(), text.end(), is_plain)) {
      out_ += json_text(Json(text));
      return;
    }
    out_ += '"';
    out_ += text;
    out_ += '"';
  }

  bool write_bytes(std::size_t count) {
    if (count > cdr_.size() - at_) return false;
    out_ += '"';
    out_ += base64(cdr_.substr(at_, count));
    out_ += '"';
    at_ += count;
    return true;
  }

  /// Reads a number, which is aligned to its size after the header.
  template <class T>
  bool read(T& value) {
    const std::size_t over = (at_ - ros2::CdrWriter::header_bytes) % sizeof value;
    const std::size_t begin = over == 0 ? at_ : at_ + sizeof value - over;
    if (begin + sizeof value > cdr_.size()) return false;
    std::memcpy(&value, cdr_.data() + begin, sizeof value);
    at_ = begin + sizeof value;
    return true;
  }
  /// Reads the count of a sequence, or the length of a string: each element has a byte at least.
  bool read_count(std::size_t& count) {
    std::uint32_t value = 0;
    if (!read(value)) return false;
    count = value;
    return count <= cdr_.size() - at_;
  }

  const std::vector<RosType::Definition>& definitions_;
  std::string_view cdr_;
  std::size_t at_ = ros2::CdrWriter::header_bytes;
  std::string& out_;
};

/// Writer of a client's message.  `where`: the member, such as `linear.x`.
class CdrEncoder {
 public:
  CdrEncoder(const RosType& type, double missing, std::vector<std::byte>& bytes)
      : definitions_(type.definitions()), missing_(missing), out_(bytes) {}

  /// `message`: null for one whose members are all missing.
  void write(const RosType::Definition& definition, const Json* message, const std::string& where) {
    if (message != nullptr) check_members(definition, *message, where);
    for (const RosType::Member& member : definition.members) {
      const Json* value = nullptr;
      if (message != nullptr)
        if (const auto found = message->find(member.name); found != message->end()) value = &*found;
      const std::string place = where.empty() ? member.name : where + "." + member.name;
      write_member(member, value, place);
      if (out_.size() > max_client_cdr_bytes)
        refuse(place, "the message must have at most " + std::to_string(max_client_cdr_bytes) + " bytes in CDR");
    }
  }

 private:
  [[noreturn]] static void refuse(const std::string& where, const std::string& rule) {
    throw WebError("'msg" + (where.empty() ? "" : "." + where) + "': " + rule);
  }
  [[noreturn]] static void expect(const std::string& where, const std::string& what, const Json& got) {
    refuse(where, "must be " + what + ", got " + json_text(got).substr(0, 40));
  }

  static void check_members(const RosType::Definition& definition, const Json& message, const std::string& where) {
    if (!message.is_object()) expect(where, "an object", message);
    for (const auto& [key, value] : message.items())
      if (std::none_of(definition.members.begin(), definition.members.end(),
                       [&, &name = key](const RosType::Member& member) { return member.name == name; }))
        refuse(where, definition.name + " has no member " + json_text(Json(key)).substr(0, 80));
  }

  void write_member(const RosType::Member& member, const Json* value, const std::string& where) {
    if (member.array == Array::none) return write_value(member, value, where);
    if (member.is_binary() && value != nullptr && value->is_string()) return write_base64(member, *value, where);
    if (value != nullptr && !value->is_array()) expect(where, "a list", *value);
    const std::size_t given = value == nullptr ? 0 : value->size();
    if (member.array == Array::fixed && value != nullptr && given != member.count)
      refuse(where, "must have " + std::to_string(member.count) + " values, got " + std::to_string(given));
    if (member.array == Array::sequence) out_.put_count(given);
    const std::size_t count = member.array == Array::fixed ? member.count : given;
    for (std::size_t i = 0; i < count; ++i) {
      write_value(member, value == nullptr ? nullptr : &(*value)[i], where);
      if (out_.size() > max_client_cdr_bytes) return;  // write() reports it
    }
  }

  void write_base64(const RosType::Member& member, const Json& value, const std::string& where) {
    const auto bytes = bytes_of_base64(value.get_ref<const std::string&>());
    if (!bytes) refuse(where, "must be a list of bytes, or text in base64");
    if (member.array == Array::fixed && bytes->size() != member.count)
      refuse(where, "must have " + std::to_string(member.count) + " bytes, got " + std::to_string(bytes->size()));
    if (member.array == Array::sequence) out_.put_count(bytes->size());
    std::copy_n(reinterpret_cast<const std::byte*>(bytes->data()), bytes->size(), out_.room(bytes->size(), 1));
  }

  void write_value(const RosType::Member& member, const Json* value, const std::string& where) {
    switch (member.kind) {
      case Kind::compound:
        return write(definitions_[member.compound], value, where);
      case Kind::text:
        if (value != nullptr && !value->is_string()) expect(where, "a text", *value);
        return out_.put(value == nullptr ? std::string_view() : std::string_view(value->get_ref<const std::string&>()));
      case Kind::boolean:
        if (value != nullptr && !value->is_boolean()) expect(where, "true or false", *value);
        return out_.put(static_cast<std::uint8_t>(value != nullptr && value->get<bool>()));
      case Kind::float32:
        return out_.put(static_cast<float>(real(value, where)));
      case Kind::float64:
        return out_.put(real(value, where));
      default:
        return with_number(member.kind, [&](auto number) { out_.put(integer(value, where, number)); });
    }
  }

  double real(const Json* value, const std::string& where) const {
    if (value == nullptr) return missing_;
    if (value->is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value->is_number()) expect(where, "a number or null", *value);
    return value->get<double>();
  }

  /// Clients in JavaScript cannot tell 1.0 from 1, so that a number without a fraction is an integer.
  template <class T>
  static T integer(const Json* value, const std::string& where, T /*type*/) {
    using Limits = std::numeric_limits<T>;
    if (value == nullptr) return 0;
    const std::string rule =
        "an integer from " + std::to_string(Limits::min()) + " to " + std::to_string(Limits::max());
    if (value->is_number_unsigned() && value->get<std::uint64_t>() <= static_cast<std::uint64_t>(Limits::max()))
      return static_cast<T>(value->get<std::uint64_t>());
    if (value->is_number_integer() && !value->is_number_unsigned() && std::is_signed_v<T> &&
        value->get<std::int64_t>() >= static_cast<std::int64_t>(Limits::min()))
      return static_cast<T>(value->get<std::int64_t>());
    constexpr double exact = 9007199254740992;  // 2^53
    if (value->is_number_float()) {
      const double number = value->get<double>();
      if (std::abs(number) <= exact && number == std::floor(number) && number >= static_cast<double>(Limits::min()) &&
          number <= static_cast<double>(Limits::max()))
        return static_cast<T>(number);
    }
    expect(where, rule, *value);
  }

  const std::vector<RosType::Definition>& definitions_;
  const double missing_;
  ros2::CdrWriter out_;
};

}  // namespace

RosType::RosType(std::string_view name, std::string_view schema) {
  definitions_.push_back({short_name(name), {}});
  while (!schema.empty()) {
    const std::size_t end = std::min(schema.find('\n'), schema.size());
    const std::string_view line = schema.substr(0, end);
    schema.remove_prefix(std::min(end + 1, schema.size()));
    if (line.starts_with("===")) continue;
    if (line.starts_with("MSG: "))
      definitions_.push_back({std::string(line.substr(5)), {}});
    else if (auto member = member_of(line))
      definitions_.back().members.push_back(std::move(*member));
  }
  resolve();
}

void RosType::resolve() {
  for (Definition& definition : definitions_)
    for (Member& member : definition.members) {
      if (member.kind != Kind::compound) continue;
      const auto used = std::find_if(definitions_.begin(), definitions_.end(),
                                     [&](const Definition& each) { return each.name == member.type; });
      if (used == definitions_.end()) throw std::invalid_argument("no definition of " + member.type);
      member.compound = static_cast<std::size_t>(used - definitions_.begin());
    }
}

std::string short_name(std::string_view type) {
  std::string name(type);
  if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  return name;
}

bool append_json(const RosType& type, std::string_view cdr, std::string& text) {
  const std::size_t begin = text.size();
  if (cdr.size() >= ros2::CdrWriter::header_bytes && JsonWriter(type, cdr, text).write(type.definitions().front()))
    return true;
  text.replace(begin, std::string::npos, "null");
  return false;
}

std::vector<std::byte> cdr_of_json(const RosType& type, const Json& message, double missing) {
  std::vector<std::byte> bytes;
  CdrEncoder(type, missing, bytes).write(type.definitions().front(), &message, "");
  return bytes;
}

}  // namespace bridges::rosbridge
