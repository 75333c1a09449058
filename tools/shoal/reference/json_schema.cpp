// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/reference/json_schema.hpp"

#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "sim/base/number.hpp"
#include "sim/world_file/world_config.hpp"
#include "tools/shoal/reference/reference_pages.hpp"

namespace tools {

namespace {

using Json = nlohmann::ordered_json;
using sim::ParamInfo;
using sim::ParamKind;
using Table = std::vector<ParamInfo>;

// A scalar of a vehicle file that contains this is replaced before it is checked.
const char* const parameter = R"(\$\{[^}]+\})";
const char* const name_pattern = "^[A-Za-z0-9_-]+$";

/// Writes 30 instead of 30.0.
Json json_number(double value) {
  const bool whole = std::abs(value) < 1e15 && value == std::trunc(value);
  return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json json_scalar(const std::string& text, ParamKind kind) {
  switch (kind) {
    case ParamKind::boolean:
      return text == "true";
    case ParamKind::integer:
      return std::strtoll(text.c_str(), nullptr, 10);
    case ParamKind::number:
    case ParamKind::vector:
    case ParamKind::numbers:
      return json_number(sim::read_number(text).value_or(0));
    default:
      return text;
  }
}

/// Returns the default in JSON; null when there is none.
Json json_default(const ParamInfo& info) {
  if (!info.word.empty() && info.initial == info.word) return info.word;
  sim::Diagnostics ignored;
  const sim::ConfigNode node = sim::parse_config_text(info.initial, "default", ignored);
  switch (node.kind) {
    case sim::ConfigNode::Kind::null:
      return nullptr;
    case sim::ConfigNode::Kind::scalar:
      return json_scalar(node.scalar, info.kind);
    case sim::ConfigNode::Kind::map:
      return Json::object();
    case sim::ConfigNode::Kind::list:
      Json list = Json::array();
      for (const sim::ConfigNode& item : node.items) list.push_back(json_scalar(item.scalar, info.kind));
      return list;
  }
  return nullptr;
}

Json number_schema(const char* type, const sim::Rule& range) {
  Json schema{{"type", {type}}};
  if (std::isfinite(range.low)) schema[range.low_open ? "exclusiveMinimum" : "minimum"] = json_number(range.low);
  if (std::isfinite(range.high)) schema[range.high_open ? "exclusiveMaximum" : "maximum"] = json_number(range.high);
  return schema;
}

Json reference_to(const std::string& definition) {
  return {{"$ref", "#/definitions/" + definition}};
}

/// Key whose value is described by other tables.
struct Special {
  Json value;     ///< schema of the value
  Json required;  ///< required keys of the value
};

/// Converts tables to schemas.  Required keys are separate from permitted ones, because a file that includes another
/// may find them there.
class SchemaWriter {
 public:
  /// `with_parameters`: every value may contain a ${name}.  `definitions`: receives the tables that have a name.
  SchemaWriter(bool with_parameters, std::map<std::string, Special> specials, Json& definitions)
      : with_parameters_(with_parameters), specials_(std::move(specials)), definitions_(definitions) {}

  /// Returns keys, types and ranges.
  Json keys(const Table& table) const {
    Json schema{{"type", {"object"}}, {"properties", Json::object()}, {"additionalProperties", false}};
    for (const ParamInfo& info : table) schema["properties"][info.key] = entry(info);
    return schema;
  }

  /// Returns the required keys; an empty object when there are none.
  Json required(const Table& table) const {
    Json schema = Json::object();
    for (const ParamInfo& info : table) {
      if (info.required) schema["required"].push_back(info.key);
      if (!info.definition.empty()) continue;  // its own definition contains its required keys
      const Special* special = special_of(info);
      Json inner = special ? special->required : required(info.children);
      if (inner.empty()) continue;
      schema["properties"][info.key] = info.kind == ParamKind::maps ? Json{{"items", inner}} : inner;
    }
    return schema;
  }

  /// Returns one key with its description and its default.
  Json entry(const ParamInfo& info) const {
    Json schema{
        {"description", info.meaning + (info.choices.empty() && !info.rule.empty() ? " (" + info.rule + ")" : "")}};
    if (!info.required)
      if (const Json value = json_default(info); !value.is_null()) schema["default"] = value;
    schema.update(value(info));
    return schema;
  }

  /// Returns one word of a list.
  Json words(const std::vector<std::string>& choices) const {
    if (!with_parameters_) return {{"enum", choices}};
    return {{"anyOf", {Json{{"enum", choices}}, Json{{"type", "string"}, {"pattern", parameter}}}}};
  }

 private:
  /// Returns null for a key of the same name whose value is a word, such as the `model` of absorption.
  const Special* special_of(const ParamInfo& info) const {
    if (!info.choices.empty()) return nullptr;
    const auto found = specials_.find(info.key);
    return found == specials_.end() ? nullptr : &found->second;
  }

  Json value(const ParamInfo& info) const {
    if (const Special* special = special_of(info))
      return info.kind == ParamKind::maps ? with_exceptions(list_of(special->value), info) : special->value;
    if (!info.choices.empty()) return words(info.choices);
    if (info.kind == ParamKind::any) return Json::object();
    if (!info.word.empty()) return number_or_word(info);
    return with_exceptions(plain_value(info), info);
  }

  Json plain_value(const ParamInfo& info) const {
    switch (info.kind) {
      // Scalars.
      case ParamKind::boolean:
        return {{"type", {"boolean"}}};
      case ParamKind::integer:
        return number_schema("integer", info.range);
      case ParamKind::number:
        return number_schema("number", info.range);
      // Lists of values.
      case ParamKind::vector: {
        Json schema = list_of(number_schema("number", info.range));
        schema["minItems"] = schema["maxItems"] = 3;
        return schema;
      }
      case ParamKind::numbers:
        return list_of(number_schema("number", info.range));
      case ParamKind::texts:
        return list_of(info.pattern.empty() ? text() : text_like(info));
      case ParamKind::paths:
        return list_of(text());
      // Maps.
      case ParamKind::map:
        return map_of(info);
      case ParamKind::maps:
        return list_of(item_of(info));
      case ParamKind::lists:
        return list_of(list_of(item_of(info)));
      case ParamKind::raw:
        return {{"type", {"object"}}};
      default:
        return text();
    }
  }

  /// YAML reads a plain 12 as a number; it is accepted where a text is expected.
  static Json text() { return {{"type", {"string", "number", "boolean"}}}; }

  Json number_or_word(const ParamInfo& info) const {
    Json number = number_schema(info.kind == ParamKind::integer ? "integer" : "number", info.range);
    Json schema{{"oneOf", {std::move(number), Json{{"const", info.word}}}}};
    if (with_parameters_) schema["oneOf"].push_back({{"type", "string"}, {"pattern", parameter}});
    return schema;
  }

  /// Returns one map of a list; named maps are stored once in the definitions.
  Json item_of(const ParamInfo& info) const {
    if (info.definition.empty()) return map_of(info);
    if (!info.children.empty()) definitions_[info.definition] = one_of_keys(info.children);
    return reference_to(info.definition);
  }

  /// Returns a map with one of these keys, each of which is a map, or the value of its first key.
  Json one_of_keys(const Table& table) const {
    Json schema = keys({});
    schema["minProperties"] = schema["maxProperties"] = 1;
    for (const ParamInfo& info : table) {
      Json map = keys(info.children);
      map.update(required(info.children));
      Json& key = schema["properties"][info.key];
      key = {{"description", info.meaning}};
      const ParamInfo& main = info.children.front();
      const Json alone = main.kind == ParamKind::any ? text() : value(main);
      key.update(info.main_alone ? Json{{"anyOf", {alone, map}}} : map);
    }
    return schema;
  }

  static Json text_like(const ParamInfo& info) {
    return {{"type", {"string"}}, {"pattern", info.pattern}, {"examples", info.examples}};
  }

  /// Returns a map that contains itself, for one without known keys: any keys.
  Json map_of(const ParamInfo& info) const {
    return info.children.empty() ? Json{{"type", {"object"}}} : keys(info.children);
  }

  Json list_of(Json item) const {
    allow_parameter(item);
    return {{"type", {"array"}}, {"items", item}};
  }

  Json with_exceptions(Json schema, const ParamInfo& info) const {
    if (info.kind == ParamKind::name) schema["pattern"] = name_pattern;
    if (info.may_be_null) schema["type"].push_back("null");
    allow_parameter(schema);
    return schema;
  }

  /// In JSON Schema a pattern applies to strings only, and a minimum to numbers only, so that both can be combined.
  void allow_parameter(Json& schema) const {
    if (!with_parameters_ || !schema.contains("type")) return;
    if (schema["type"][0] != "string") {
      schema["type"].push_back("string");
      schema["pattern"] = parameter;
    } else if (schema.contains("pattern")) {
      schema["pattern"] = std::string(name_pattern) + "|" + parameter;
    }
  }

  bool with_parameters_;
  std::map<std::string, Special> specials_;
  Json& definitions_;
};

Json when_type_is(const std::string& type, Json then) {
  return {{"if", {{"properties", {{"type", {{"const", type}}}}}, {"required", {"type"}}}}, {"then", std::move(then)}};
}

/// Returns the keys of one device type: its own, and those of every device, which are checked in the definition
/// `device`.
Json device_type_schema(const SchemaWriter& writer, const sim::DeviceType& type, const Table& common) {
  Json schema = writer.keys(params_of(type));
  schema.erase("type");
  for (const ParamInfo& info : common) schema["properties"][info.key] = Json::object();
  if (type.default_rate_hz > 0) schema["properties"]["rate_hz"]["default"] = json_number(type.default_rate_hz);
  schema["description"] = type.meaning;
  return schema;
}

/// Returns an item of `devices:`.  Its keys depend on its type.
Special device_special(Json& definitions) {
  // Keys of all devices.
  const SchemaWriter writer(true, {}, definitions);
  const Table common = common_params();
  Json device = writer.keys(common);
  Json any_type = writer.required(common);
  // Keys of each type.
  std::vector<std::string> names;
  for (const sim::DeviceType* type : sim::DeviceRegistry::instance().all()) {
    names.push_back(type->name);
    definitions["device_" + type->name] = device_type_schema(writer, *type, common);
    device["allOf"].push_back(when_type_is(type->name, reference_to("device_" + type->name)));
    if (const Json own = writer.required(params_of(*type)); !own.empty())
      any_type["allOf"].push_back(when_type_is(type->name, own));
  }
  // Words of the key `type`.
  Json& type_key = device["properties"]["type"];
  type_key = {{"description", type_key["description"]}};
  type_key.update(writer.words(names));
  // The permitted keys depend on the type.
  device.erase("additionalProperties");
  device["type"] = {"object", "string"};
  device["pattern"] = parameter;
  definitions["device"] = device;
  definitions["device_required"] = any_type;
  return {reference_to("device"), reference_to("device_required")};
}

const Json include_schema{
    {"description", "file, or list of files, over which this one is merged; relative to this file"},
    {"type", {"string", "array"}},
    {"items", {{"type", "string"}}}};

/// Returns a whole file: keys of `table`, or an `include`, which may supply the missing ones.
Json file_schema(const std::string& file, const SchemaWriter& writer, const Table& table, Json& definitions) {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"$comment", "Generated: shoal describe --schema " + file + ".  Do not edit."},
              {"title", "Shoal " + file + " file"}};
  Json keys = writer.keys(table);
  keys["properties"]["include"] = include_schema;
  schema.update(keys);
  schema["if"] = {{"required", {"include"}}};
  schema["then"] = true;
  schema["else"] = writer.required(table);
  schema["definitions"] = std::move(definitions);
  return schema;
}

Json vehicle_schema() {
  Json definitions = Json::object();
  const Special device = device_special(definitions);
  const SchemaWriter writer(true, {{"devices", device}}, definitions);
  return file_schema("vehicle", writer, params_of<sim::VehicleConfig>(), definitions);
}

Json world_schema() {
  Json definitions = Json::object();
  const Special device = device_special(definitions);
  const SchemaWriter vehicle(true, {{"devices", device}}, definitions);
  const Table vehicle_table = params_of<sim::VehicleConfig>();
  definitions["vehicle"] = vehicle.keys(vehicle_table);
  definitions["vehicle_required"] = vehicle.required(vehicle_table);
  // A reference hides its siblings, such as the description, so it is placed in an allOf.
  const Special model{{{"allOf", {reference_to("vehicle")}}}, reference_to("vehicle_required")};
  const SchemaWriter writer(false, {{"devices", device}, {"model", model}}, definitions);
  Json schema = file_schema("world", writer, params_of<sim::WorldConfig>(), definitions);
  for (const char* key : {"processes", "bridges"})
    add_program_schemas(schema["properties"][key]["items"], schema["definitions"]);
  return schema;
}

}  // namespace

std::string study_schema(const std::vector<sim::ParamInfo>& table) {
  // Seeds have four forms, which the table of keys cannot express.
  const Json seed = number_schema("integer", sim::at_least(0));
  const Json range{{"type", "string"}, {"pattern", "^[0-9]+( *- *[0-9]+)?$"}};
  const Json one_seed{{"anyOf", {seed, range}}};
  Json count{{"type", "object"}, {"required", {"count"}}, {"additionalProperties", false}};
  count["properties"] = {{"first", seed}, {"count", number_schema("integer", sim::at_least(1))}};
  const Json list{{"type", "array"}, {"items", one_seed}, {"minItems", 1}};
  const Special seeds{{{"anyOf", {seed, range, list, count}}}, Json::object()};
  Json definitions = Json::object();
  const SchemaWriter writer(false, {{"seeds", seeds}}, definitions);
  return file_schema("study", writer, table, definitions).dump(1) + "\n";
}

std::string motion_schema(const std::vector<sim::ParamInfo>& table) {
  const Json values{{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
  Json definitions = Json::object();
  const SchemaWriter writer(false, {{"joints", {values, Json::object()}}}, definitions);
  return file_schema("motion", writer, table, definitions).dump(1) + "\n";
}

std::string drive_schema(const std::vector<sim::ParamInfo>& table) {
  Json definitions = Json::object();
  const SchemaWriter writer(false, {}, definitions);
  return file_schema("drive", writer, table, definitions).dump(1) + "\n";
}

std::string json_schema(const std::string& file) {
  if (file == "world") return world_schema().dump(1) + "\n";
  if (file == "vehicle") return vehicle_schema().dump(1) + "\n";
  throw std::out_of_range("no schema of '" + file + "'; files: world, vehicle");
}

}  // namespace tools
