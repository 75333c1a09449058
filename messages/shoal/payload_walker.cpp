// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "shoal/message_schema.hpp"
#include "shoal/wire_value.hpp"

namespace shoal {
namespace {

constexpr int max_depth = 32;                    // limit of recursive types, and of the recursion here
constexpr std::uint64_t max_empty_rows = 65536;  // limit of rows without bytes in the payload

std::string hex(std::uint64_t value) {
  std::array<char, 20> text;
  std::snprintf(text.data(), text.size(), "0x%016llx", static_cast<unsigned long long>(value));
  return text.data();
}

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Traversal of a payload.  Without a visitor it only validates.
class Walker {
 public:
  Walker(std::span<const std::byte> payload, Finite finite, const FieldVisitor* visitor)
      : begin_(payload.data()),
        at_(payload.data() + sizeof(std::uint64_t)),
        end_(payload.data() + payload.size()),
        finite_(finite),
        visitor_(visitor) {}

  bool walk(const MessageSchema& schema, int depth = 0) {
    if (depth > max_depth) return fail("", "is nested deeper than " + std::to_string(max_depth));
    std::array<std::int64_t, 64>
        lengths;  // lengths of the arrays of this type; not initialized, every element is set before use
    for (const Member& member : schema.members)
      if (!walk_member(member, lengths, depth)) return false;
    return true;
  }

  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }

  std::string error(const MessageSchema& schema) const {
    if (too_short_by_ > 0)
      return "payload of " + std::to_string(end_ - begin_) + " bytes is too short for " + schema.name + ": field '" +
             error_field_ + "' needs " + std::to_string(too_short_by_) + " more bytes";
    return "field '" + error_field_ + "' " + error_text_;
  }

 private:
  using Lengths = std::array<std::int64_t, 64>;

  bool fail(const std::string& field, const std::string& text) {
    error_field_ = field;
    error_text_ = text;
    return false;
  }

  bool fail_short(const std::string& field, std::uint64_t needed) {
    error_field_ = field;
    too_short_by_ = needed - remaining();
    return false;
  }

  bool walk_member(const Member& member, Lengths& lengths, int depth) {
    std::uint64_t count = 1;
    if (!member.dimensions.empty() && !element_count(member, lengths, count)) return false;
    if (member.type == WireType::compound) return walk_compounds(member, lengths, count, depth);
    if (member.type == WireType::string) return walk_strings(member, lengths, count);
    const std::size_t size = wire_size(member.type);
    // count <= 2^62 / size is guaranteed: element_count() refuses more.
    if (count * size > remaining()) return fail_short(member.name, count * size);
    if (member.length_slot >= 0) {
      lengths[static_cast<std::size_t>(member.length_slot)] = read_integer(member.type, at_);
    } else if (finite_ == Finite::required && (member.type == WireType::float32 || member.type == WireType::float64)) {
      if (!check_finite(member, lengths, count, size)) return false;
    }
    if (visitor_ != nullptr) show_primitives(member, lengths, count, size);
    at_ += count * size;
    return true;
  }

  /// Computes the product of the dimensions, limited to what the payload can contain.
  bool element_count(const Member& member, const Lengths& lengths, std::uint64_t& count) {
    const std::size_t element = member.compound != nullptr ? member.compound->min_size : wire_size(member.type);
    bool empty = false;
    std::uint64_t rows = 1;  // vectors that a decoder creates even when the array is empty
    for (const Dimension& dimension : member.dimensions) {
      const std::int64_t size =
          dimension.is_variable() ? lengths[static_cast<std::size_t>(dimension.length_slot)] : dimension.constant;
      if (size < 0)
        return fail(member.name, "has a negative size, " + std::to_string(size) + " ('" + dimension.text + "')");
      if (size == 0) empty = true;
      if (__builtin_mul_overflow(count, static_cast<std::uint64_t>(size), &count) || count > (1ull << 58))
        return fail(member.name, "is too large ('" + dimension.text + "' is " + std::to_string(size) + ")");
      if (!empty) rows = count;
    }
    if (empty) {
      if (rows > max_empty_rows) return fail(member.name, "has " + std::to_string(rows) + " empty rows");
      return true;
    }
    if (element == 0) {
      if (count > max_empty_rows) return fail(member.name, "has " + std::to_string(count) + " empty elements");
      return true;
    }
    if (count > remaining() / element) {
      // 2^58 * wire sizes of at most 8 do not overflow; for compounds the number is only a bound.
      std::uint64_t needed = 0;
      if (__builtin_mul_overflow(count, static_cast<std::uint64_t>(element), &needed))
        needed = std::numeric_limits<std::uint64_t>::max();
      return fail_short(member.name, needed);
    }
    return true;
  }

  bool walk_compounds(const Member& member, const Lengths& lengths, std::uint64_t count, int depth) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::size_t path_size = path_.size();
      if (visitor_ != nullptr) path_ += element_name(member, lengths, i) + ".";
      if (!walk(*member.compound, depth + 1)) {
        error_field_ = element_name(member, lengths, i) + (error_field_.empty() ? "" : "." + error_field_);
        return false;
      }
      path_.resize(path_size);
    }
    return true;
  }

  bool walk_strings(const Member& member, const Lengths& lengths, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (remaining() < 4) return fail_short(element_name(member, lengths, i), 4);
      const auto length = static_cast<std::int32_t>(big_endian<std::uint32_t>(at_));
      // The length counts the final NUL, so that even an empty string has 1.
      if (length < 1)
        return fail(element_name(member, lengths, i),
                    "has the string length " + std::to_string(length) + ", must be >= 1");
      const std::size_t size = 4 + static_cast<std::size_t>(length);
      if (size > remaining()) return fail_short(element_name(member, lengths, i), size);
      if (at_[size - 1] != std::byte{0})
        return fail(element_name(member, lengths, i), "is a string without a final NUL");
      if (visitor_ != nullptr)
        show(element_name(member, lengths, i),
             std::string_view(reinterpret_cast<const char*>(at_ + 4), static_cast<std::size_t>(length) - 1));
      at_ += size;
    }
    return true;
  }

  bool check_finite(const Member& member, const Lengths& lengths, std::uint64_t count, std::size_t size) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const double value = read_real(member.type, at_ + i * size);
      if (!std::isfinite(value)) return fail(element_name(member, lengths, i), "must be finite, got " + text_of(value));
    }
    return true;
  }

  void show_primitives(const Member& member, const Lengths& lengths, std::uint64_t count, std::size_t size) {
    // Bytes are shown as a block: they are images and payloads of modems.
    if (member.type == WireType::byte && member.dimensions.size() == 1) {
      show(member.name, std::span(at_, static_cast<std::size_t>(count)));
      return;
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::byte* at = at_ + i * size;
      const std::string name = element_name(member, lengths, i);
      if (member.type == WireType::boolean)
        show(name, *at != std::byte{0});
      else if (member.type == WireType::float32 || member.type == WireType::float64)
        show(name, read_real(member.type, at));
      else
        show(name, read_integer(member.type, at));
    }
  }

  void show(const std::string& name, const FieldValue& value) {
    if (path_.empty())
      (*visitor_)(name, value);
    else
      (*visitor_)(path_ + name, value);
  }

  /// Returns the name with the indices of the i-th element, with the last index varying fastest.
  static std::string element_name(const Member& member, const Lengths& lengths, std::uint64_t i) {
    std::string indices;
    for (auto it = member.dimensions.rbegin(); it != member.dimensions.rend(); ++it) {
      const auto size = static_cast<std::uint64_t>(
          it->is_variable() ? lengths[static_cast<std::size_t>(it->length_slot)] : it->constant);
      indices = "[" + std::to_string(i % size) + "]" + indices;
      i /= size;
    }
    return member.name + indices;
  }

  const std::byte* begin_;
  const std::byte* at_;
  const std::byte* end_;
  Finite finite_;
  const FieldVisitor* visitor_;
  std::string path_;
  std::string error_field_, error_text_;
  std::uint64_t too_short_by_ = 0;
};

}  // namespace

std::int64_t fingerprint(std::span<const std::byte> payload) {
  if (payload.size() < sizeof(std::uint64_t)) return 0;
  return static_cast<std::int64_t>(big_endian<std::uint64_t>(payload.data()));
}

namespace {

std::optional<std::string> walk_all(const MessageSchema& schema, std::span<const std::byte> payload, Finite finite,
                                    const FieldVisitor* visitor) {
  const std::string bytes = "payload of " + std::to_string(payload.size()) + " bytes is too ";
  if (payload.size() < sizeof(std::uint64_t)) return bytes + "short for any message";
  const auto got = static_cast<std::uint64_t>(fingerprint(payload));
  if (got != schema.fingerprint)
    return "fingerprint " + hex(got) + " is not " + schema.name + " (" + hex(schema.fingerprint) + ")";
  Walker walker(payload, finite, visitor);
  if (!walker.walk(schema)) return walker.error(schema);
  if (walker.remaining() > 0)
    return bytes + "long for " + schema.name + ": " + std::to_string(walker.remaining()) +
           " bytes follow the last field";
  return std::nullopt;
}

}  // namespace

std::optional<std::string> validate(const MessageSchema& schema, std::span<const std::byte> payload, Finite finite) {
  return walk_all(schema, payload, finite, nullptr);
}

std::optional<std::string> visit_fields(const MessageSchema& schema, std::span<const std::byte> payload,
                                        const FieldVisitor& visitor) {
  if (auto error = validate(schema, payload, Finite::any)) return error;
  return walk_all(schema, payload, Finite::any, &visitor);
}

}  // namespace shoal
