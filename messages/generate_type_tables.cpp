// SPDX-License-Identifier: BSD-3-Clause
// Generator that runs during the build.  From the .lcm files it writes a .cpp with their texts and a header that checks
// array lengths before encoding.  With --known FILE... the first files belong to a plugin, and those after --known are
// the ones of Shoal, which they may use.
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>

#include "shoal/message_schema.hpp"

namespace {

using shoal::Dimension;
using shoal::LcmSource;
using shoal::Member;
using shoal::MessageSchema;
using shoal::MessageTypes;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

/// Sources of the tables.
struct Input {
  std::vector<LcmSource> own;
  std::vector<LcmSource> known;  ///< of Shoal, when `own` belongs to a plugin
  bool is_plugin = false;
};

void write_texts(std::ostream& out, const std::vector<LcmSource>& sources) {
  for (const LcmSource& source : sources)
    out << "{\"" << source.file.substr(source.file.rfind('/') + 1) << "\", R\"lcm(" << source.text << ")lcm\"},\n";
}

void write_embedded(std::ostream& out, const Input& input) {
  out << "// Generated from the .lcm files.\n#include \"shoal/message_schema.hpp\"\n\n";
  if (input.is_plugin) {
    out << "[[maybe_unused]] static const bool added = shoal::add_lcm_sources({\n";
    write_texts(out, input.own);
    out << "});\n";
    return;
  }
  out << "namespace shoal {\n\nstd::span<const LcmSource> embedded_lcm_sources() {\n"
         "  static const std::vector<LcmSource> sources{\n";
  write_texts(out, input.own);
  out << "  };\n  return sources;\n}\n\n}  // namespace shoal\n";
}

std::string length_of(const MessageSchema& schema, const Dimension& dimension) {
  if (!dimension.is_variable()) return std::to_string(dimension.constant);
  for (const Member& member : schema.members)
    if (member.length_slot == dimension.length_slot) return "m." + member.name;
  return "0";
}

/// Vectors of vectors are checked level by level, from the outermost.
void write_member_check(std::ostream& out, const MessageSchema& schema, const Member& member) {
  std::string element = "m." + member.name;
  std::string indent = "  ";
  std::string closing;
  // lcm-gen makes plain C arrays when all sizes are constant; those cannot have a wrong size.
  const bool vectors = member.is_variable();
  for (std::size_t d = 0; d < member.dimensions.size(); ++d) {
    const std::string length = length_of(schema, member.dimensions[d]);
    if (vectors)
      out << indent << "shoal::require_length(" << element << ".size(), " << length << ", \"" << schema.name << "\", \""
          << member.name << "\");\n";
    const bool has_deeper_level = d + 1 < member.dimensions.size() || member.compound != nullptr;
    if (!has_deeper_level) break;
    const std::string inner = "e" + std::to_string(d);
    out << indent << "for (const auto& " << inner << " : " << element << ") {\n";
    closing = indent + "}\n" + closing;
    indent += "  ";
    element = inner;
  }
  if (member.compound != nullptr) out << indent << "check_array_lengths(" << element << ");\n";
  out << closing;
}

std::string cpp_name(const MessageSchema& schema) {
  return replaced(schema.name, ".", "::");
}

/// Returns the namespace of the type, in which the codec finds the check.
std::string namespace_of(const MessageSchema& schema) {
  return replaced(schema.name.substr(0, schema.name.rfind('.')), ".", "::");
}

const char* const require_length =
    "namespace shoal {\n\n"
    "template <class Length>\n"
    "void require_length(std::size_t size, Length length, const char* type, const char* member) {\n"
    "  if (length < 0 || size != static_cast<std::size_t>(length))\n"
    "    throw MessageError(std::string(type) + \": '\" + member + \"' has \" + std::to_string(size) +\n"
    "                       \" elements, its length member says \" + std::to_string(length));\n}\n\n"
    "}  // namespace shoal\n\n";

void write_length_checks(std::ostream& out, const std::vector<const MessageSchema*>& types, bool is_plugin) {
  out << "// Generated from the .lcm files.\n#pragma once\n\n#include <cstddef>\n#include <string>\n\n"
         "#include \"shoal/message_schema.hpp\"\n";
  if (is_plugin) out << "#include \"shoal/array_lengths.hpp\"\n";
  for (const MessageSchema* schema : types) out << "#include \"" << replaced(schema->name, ".", "/") << ".hpp\"\n";
  out << '\n' << (is_plugin ? "" : require_length);
  for (const MessageSchema* schema : types)
    out << "namespace " << namespace_of(*schema) << " { inline void check_array_lengths(const " << cpp_name(*schema)
        << "& m); }\n";
  for (const MessageSchema* schema : types) {
    out << "\nnamespace " << namespace_of(*schema) << " {\ninline void check_array_lengths([[maybe_unused]] const "
        << cpp_name(*schema) << "& m) {\n";
    for (const Member& member : schema->members)
      if (member.is_variable() || member.compound != nullptr) write_member_check(out, *schema, member);
    out << "}\n}\n";
  }
}

/// Reads the arguments and files.  Throws MessageError when a file cannot be read.
Input read_input(int argc, char** argv) {
  Input input;
  for (int i = 3; i < argc; ++i) {
    if (std::string(argv[i]) == "--known") {
      input.is_plugin = true;
      continue;
    }
    std::ifstream file(argv[i]);
    std::stringstream text;
    if (!file || !(text << file.rdbuf())) throw shoal::MessageError(std::string(argv[i]) + ": cannot be read");
    (input.is_plugin ? input.known : input.own).push_back({argv[i], text.str()});
  }
  return input;
}

std::vector<const MessageSchema*> own_types(const MessageTypes& all, const Input& input) {
  std::set<std::string> known;
  const MessageTypes known_types(input.known);
  for (const auto& [name, schema] : known_types.all()) known.insert(name);
  std::vector<const MessageSchema*> own;
  for (const auto& [name, schema] : all.all())
    if (!known.contains(name)) own.push_back(&schema);
  return own;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: generate_type_tables EMBEDDED_CPP ARRAY_LENGTHS_HPP LCM_FILE... [--known LCM_FILE...]\n";
    return 2;
  }
  try {
    const Input input = read_input(argc, argv);
    std::vector<LcmSource> sources = input.known;
    sources.insert(sources.end(), input.own.begin(), input.own.end());
    const MessageTypes types(sources);
    std::ofstream embedded(argv[1]);
    write_embedded(embedded, input);
    std::ofstream lengths(argv[2]);
    write_length_checks(lengths, own_types(types, input), input.is_plugin);
    if (!embedded.flush() || !lengths.flush()) throw shoal::MessageError("cannot write the tables");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
