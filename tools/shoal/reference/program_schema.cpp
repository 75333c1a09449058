// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "sim/config/config_node.hpp"
#include "sim/program/find_program.hpp"
#include "tools/shoal/reference/json_schema.hpp"

namespace tools {

namespace {

using Json = nlohmann::ordered_json;

/// Writes 30 instead of 30.0.
Json json_bound(double value) {
  const bool whole = std::abs(value) < 1e15 && value == std::trunc(value);
  return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

Json number_schema(const sim::ArgDeclaration& arg) {
  Json schema{{"type", arg.type == sim::ArgType::integer ? "integer" : "number"}};
  if (std::isfinite(arg.range.low)) schema["minimum"] = json_bound(arg.range.low);
  if (std::isfinite(arg.range.high)) schema["maximum"] = json_bound(arg.range.high);
  return schema;
}

Json tuple_schema(const sim::ArgDeclaration& arg) {
  return {{"type", "array"},
          {"items", number_schema(arg)},
          {"minItems", arg.needed_columns()},
          {"maxItems", arg.columns.size()}};
}

/// YAML reads a plain 6 as a number; it is accepted where a word is expected.
Json words_schema(const std::vector<std::string>& words) {
  Json all = Json::array();
  for (const std::string& word : words) {
    all.push_back(word);
    if (word.find_first_not_of("0123456789") == std::string::npos) all.push_back(Json(std::stoll(word)));
  }
  return {{"enum", all}};
}

Json value_schema(const sim::ArgDeclaration& arg) {
  switch (arg.type) {
    case sim::ArgType::number:
    case sim::ArgType::integer:
      return number_schema(arg);
    case sim::ArgType::text:
      // YAML reads a text such as 12 or true as another type; the argument gets what is written.
      return {{"type", {"string", "number", "boolean"}}};
    case sim::ArgType::flag:
      return {{"type", "boolean"}};
    case sim::ArgType::choice:
      return words_schema(arg.choices);
    case sim::ArgType::numbers:
      return {{"type", "array"}, {"items", number_schema(arg)}};
    case sim::ArgType::tuple:
      return tuple_schema(arg);
    case sim::ArgType::tuples:
      return {{"type", "array"}, {"items", tuple_schema(arg)}};
  }
  return Json::object();
}

}  // namespace

std::vector<sim::ProgramDeclaration> shipped_declarations() {
  std::vector<sim::ProgramDeclaration> declarations;
  const std::vector<std::string> folders = sim::program_folders();
  if (folders.empty()) return declarations;
  for (const std::string& name : sim::declared_programs(folders.front())) {
    if (!name.starts_with("shoal-")) continue;
    sim::Diagnostics diagnostics;
    declarations.push_back(
        sim::read_declaration_file(folders.front() + "/" + name + sim::declaration_ending, diagnostics));
    diagnostics.throw_if_any();
  }
  return declarations;
}

nlohmann::ordered_json args_schema(const sim::ProgramDeclaration& declaration) {
  // A program without arguments may have an empty `args:`, which is null in YAML.
  Json schema{{"type", {"object", "null"}}, {"properties", Json::object()}, {"additionalProperties", false}};
  for (const sim::ArgDeclaration& arg : declaration.args) {
    std::string meaning = arg.meaning;
    if (arg.initial) meaning += " (default " + sim::to_flow_yaml(*arg.initial) + ")";
    Json value{{"description", meaning}};
    value.update(value_schema(arg));
    schema["properties"][arg.name] = std::move(value);
    if (!arg.needs.empty()) schema["dependencies"][arg.name] = arg.needs;
  }
  return schema;
}

void add_program_schemas(nlohmann::ordered_json& process, nlohmann::ordered_json& definitions) {
  for (const sim::ProgramDeclaration& declaration : shipped_declarations()) {
    const std::string name = "args_" + declaration.program;
    definitions[name] = args_schema(declaration);
    const Json then{{"properties", {{"args", {{"$ref", "#/definitions/" + name}}}}}};
    process["allOf"].push_back(
        {{"if", {{"properties", {{"program", {{"const", declaration.program}}}}}, {"required", {"program"}}}},
         {"then", then}});
  }
}

}  // namespace tools
