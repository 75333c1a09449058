// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace experiment {

/// Returns a value as JSON for an error, shortened and printable.
std::string shown_json(const nlohmann::ordered_json& value);
/// Parses the text of a file.  Throws std::runtime_error: file, line, column, rule, what is there.
nlohmann::ordered_json parse_json(const std::string& text, const std::string& file);

/// Reads values of a JSON object with type checks.  Errors are std::runtime_error: file, key, rule, value.
class JsonReader {
 public:
  /// `where`: file, and the path of the object in it when that is not the root.
  JsonReader(const nlohmann::ordered_json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) throw std::runtime_error(where_ + ": must be an object, got " + shown_json(json));
  }

  bool has(const char* key) const { return json_.contains(key); }
  const nlohmann::ordered_json& at(const char* key) const {
    if (!has(key)) throw std::runtime_error(where_ + ": has no '" + key + "'");
    return json_.at(key);
  }
  std::string text(const char* key) const { return get<std::string>(key, at(key).is_string(), "text"); }
  double number(const char* key) const { return get<double>(key, at(key).is_number(), "a number"); }
  std::int64_t whole(const char* key) const {
    return get<std::int64_t>(key, at(key).is_number_integer(), "a whole number");
  }
  bool boolean(const char* key) const { return get<bool>(key, at(key).is_boolean(), "true or false"); }
  const nlohmann::ordered_json& list(const char* key) const {
    if (!at(key).is_array()) wrong(key, "a list");
    return at(key);
  }
  const nlohmann::ordered_json& object(const char* key) const {
    if (!at(key).is_object()) wrong(key, "an object");
    return at(key);
  }
  const std::string& where() const { return where_; }

 private:
  template <typename T>
  T get(const char* key, bool fits, const char* rule) const {
    if (!fits) wrong(key, rule);
    return at(key).get<T>();
  }
  [[noreturn]] void wrong(const char* key, const char* rule) const {
    throw std::runtime_error(where_ + ": '" + key + "' must be " + rule + ", got " + shown_json(at(key)));
  }

  const nlohmann::ordered_json& json_;
  std::string where_;
};

/// Returns a number; NaN for any other value, such as null.
inline double number_or_nan(const nlohmann::ordered_json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// Parses a file.  Throws std::runtime_error with its name and the reason.
nlohmann::ordered_json read_json_file(const std::string& path);

}  // namespace experiment
