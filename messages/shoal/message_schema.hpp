// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace shoal {

/// A message or a .lcm text that is not what it should be.
class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct MessageSchema;

enum class WireType { boolean, byte, int8, int16, int32, int64, float32, float64, string, compound };

/// Encoded bytes of one value; of a string at least.  0 for compounds.
std::size_t wire_size(WireType type);

struct Dimension {
  std::string text;           ///< as written between the brackets; it enters the fingerprint
  std::int64_t constant = 0;  ///< the size, unless a member gives it
  int length_slot = -1;       ///< which of the type's lengths gives the size; -1: constant
  bool is_variable() const { return length_slot >= 0; }
};

struct Member {
  std::string name;
  std::string type_name;  ///< as lcm-gen sees it: "double", or with package: "shoal.image_metadata_t"
  std::string comment;
  WireType type = WireType::byte;
  const MessageSchema* compound = nullptr;
  std::vector<Dimension> dimensions;
  int length_slot = -1;  ///< when this member is the length of an array
  bool is_variable() const;
};

/// One type of a .lcm file.
struct MessageSchema {
  std::string name;  ///< with package: "shoal.pose_t"
  std::string comment;
  bool is_enum = false;  ///< on the wire a single int32, member "value"
  std::vector<Member> members;
  std::uint64_t fingerprint = 0;
  std::size_t min_size = 0;  ///< encoded bytes without fingerprint when all arrays and strings are empty
  int length_slots = 0;
};

struct LcmSource {
  std::string file;  ///< for error messages
  std::string text;
};

/// A set of types whose members all are known.
class MessageTypes {
 public:
  /// Throws MessageError, `file:line:col: ...`.
  explicit MessageTypes(std::span<const LcmSource> sources);
  MessageTypes(MessageTypes&&) = default;
  MessageTypes& operator=(MessageTypes&&) = default;

  /// By full name, "shoal.pose_t".
  const MessageSchema* find(std::string_view name) const;
  /// Several types are equal on the wire when their members are; the first by name is found.
  const MessageSchema* find(std::uint64_t fingerprint) const;
  /// By name without package, and fingerprint: all that a generated class knows of itself.
  const MessageSchema* find(std::string_view short_name, std::uint64_t fingerprint) const;
  const std::map<std::string, MessageSchema, std::less<>>& all() const { return by_name_; }

 private:
  void resolve();

  std::map<std::string, MessageSchema, std::less<>> by_name_;  // nodes do not move: members point to them
  std::map<std::uint64_t, const MessageSchema*> by_fingerprint_;
};

/// Shoal's own types and those of plugins, known without any file.  What was found in it stays valid.
const MessageTypes& embedded_types();
/// Shoal's own.
std::span<const LcmSource> embedded_lcm_sources();
/// Adds the types of a plugin to embedded_types(): a call that lcm_generate writes.  Call before other threads look
/// at types.  Throws MessageError, such as for a type that exists already.
bool add_lcm_sources(const std::vector<LcmSource>& sources);
/// embedded_types() and those of the user's .lcm files.
MessageTypes types_with(const std::vector<std::string>& lcm_files);

/// Whether NaN and infinity are refused.  Commands: required; reports may hold NaN for "not measured".
enum class Finite { required, any };

/// What is wrong with an encoded message of this type, or nothing.  Never reads outside the payload, and takes time
/// proportional to its size, for any bytes.
std::optional<std::string> validate(const MessageSchema& schema, std::span<const std::byte> payload, Finite finite);

/// A `boolean`; any integer; float or double; string; a one-dimensional array of `byte`.
using FieldValue = std::variant<bool, std::int64_t, double, std::string_view, std::span<const std::byte>>;
/// Name as in C: "pos[0]", "metadata[1].key".
using FieldVisitor = std::function<void(std::string_view name, const FieldValue& value)>;

/// Validates, then shows every field in order.  Returns the error, in which case nothing was shown.
std::optional<std::string> visit_fields(const MessageSchema& schema, std::span<const std::byte> payload,
                                        const FieldVisitor& visitor);

/// The first eight bytes; 0 when there are fewer.
std::int64_t fingerprint(std::span<const std::byte> payload);

}  // namespace shoal
