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

/// Error of an invalid message or .lcm text.
class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct MessageSchema;

enum class WireType { boolean, byte, int8, int16, int32, int64, float32, float64, string, compound };

/// Returns the encoded bytes of one value; the minimum for a string, 0 for compounds.
std::size_t wire_size(WireType type);

struct Dimension {
  std::string text;           ///< as written between the brackets; it enters the fingerprint
  std::int64_t constant = 0;  ///< constant size, unless a member gives it
  int length_slot = -1;       ///< index of the length that gives the size; -1: constant
  bool is_variable() const { return length_slot >= 0; }
};

struct Member {
  std::string name;
  std::string type_name;  ///< name in lcm-gen: "double", or with package: "shoal.image_metadata_t"
  std::string comment;
  WireType type = WireType::byte;
  const MessageSchema* compound = nullptr;
  std::vector<Dimension> dimensions;
  int length_slot = -1;  ///< index of the length, when this member is the length of an array
  bool is_variable() const;
};

/// Schema of one type of a .lcm file.
struct MessageSchema {
  std::string name;  ///< with package: "shoal.pose_t"
  std::string comment;
  bool is_enum = false;  ///< encoded as a single int32, member "value"
  std::vector<Member> members;
  std::uint64_t fingerprint = 0;
  std::size_t min_size = 0;  ///< encoded bytes without fingerprint when all arrays and strings are empty
  int length_slots = 0;
};

struct LcmSource {
  std::string file;  ///< for error messages
  std::string text;
};

/// Complete set of types: the types of all members are in it.
class MessageTypes {
 public:
  /// Parses the sources.  Throws MessageError, `file:line:col: ...`.
  explicit MessageTypes(std::span<const LcmSource> sources);
  MessageTypes(MessageTypes&&) = default;
  MessageTypes& operator=(MessageTypes&&) = default;

  /// Returns a type by its full name, such as "shoal.pose_t"; null when there is none.
  const MessageSchema* find(std::string_view name) const;
  /// Returns a type by its fingerprint; the first by name of several types with equal members.
  const MessageSchema* find(std::uint64_t fingerprint) const;
  /// Returns a type by its name without package and its fingerprint, the data available from a generated class.
  const MessageSchema* find(std::string_view short_name, std::uint64_t fingerprint) const;
  const std::map<std::string, MessageSchema, std::less<>>& all() const { return by_name_; }

 private:
  void resolve();

  std::map<std::string, MessageSchema, std::less<>> by_name_;  // map nodes have stable addresses: members point to them
  std::map<std::uint64_t, const MessageSchema*> by_fingerprint_;
};

/// Returns the types of Shoal and of plugins, which need no files.  Pointers to them remain valid.
const MessageTypes& embedded_types();
/// Returns the sources of the types of Shoal.
std::span<const LcmSource> embedded_lcm_sources();
/// Adds the types of a plugin to embedded_types(); called by code from lcm_generate.  Must be called before other
/// threads use types.  Throws MessageError, such as for a type that exists already.
bool add_lcm_sources(const std::vector<LcmSource>& sources);
/// Returns embedded_types() and the types of .lcm files of the user.
MessageTypes types_with(const std::vector<std::string>& lcm_files);

/// Policy for NaN and infinity.  `required` refuses them, as for commands; reports may contain NaN for "not measured".
enum class Finite { required, any };

/// Validates an encoded message of this type.  Returns the error, or none.  Never reads outside of the payload, and
/// takes time proportional to its size, for any bytes.
std::optional<std::string> validate(const MessageSchema& schema, std::span<const std::byte> payload, Finite finite);

/// Value of a field: `boolean`; any integer; float or double; string; one-dimensional array of `byte`.
using FieldValue = std::variant<bool, std::int64_t, double, std::string_view, std::span<const std::byte>>;
/// Callback for a field, with its name as in C: "pos[0]", "metadata[1].key".
using FieldVisitor = std::function<void(std::string_view name, const FieldValue& value)>;

/// Validates a message, then visits every field in order.  Returns the error, in which case no field was visited.
std::optional<std::string> visit_fields(const MessageSchema& schema, std::span<const std::byte> payload,
                                        const FieldVisitor& visitor);

/// Returns the fingerprint, the first eight bytes; 0 when there are fewer.
std::int64_t fingerprint(std::span<const std::byte> payload);

}  // namespace shoal
