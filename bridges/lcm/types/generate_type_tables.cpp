// Runs while building.  Writes, from the .lcm files, a .cpp that holds their texts and a header that checks
// array lengths before encoding.
#include <fstream>
#include <iostream>
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

void write_embedded(std::ostream& out, const std::vector<LcmSource>& sources) {
  out << "// Generated from the .lcm files.\n#include \"shoal/message_schema.hpp\"\n\nnamespace shoal {\n\n"
         "std::span<const LcmSource> embedded_lcm_sources() {\n  static const std::vector<LcmSource> "
         "sources{\n";
  for (const LcmSource& source : sources)
    out << "{\"" << source.file.substr(source.file.rfind('/') + 1) << "\", R\"lcm(" << source.text << ")lcm\"},\n";
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
      out << indent << "require_length(" << element << ".size(), " << length << ", \"" << schema.name << "\", \""
          << member.name << "\");\n";
    const bool goes_deeper = d + 1 < member.dimensions.size() || member.compound != nullptr;
    if (!goes_deeper) break;
    const std::string inner = "e" + std::to_string(d);
    out << indent << "for (const auto& " << inner << " : " << element << ") {\n";
    closing = indent + "}\n" + closing;
    indent += "  ";
    element = inner;
  }
  if (member.compound != nullptr) out << indent << "check_array_lengths(" << element << ");\n";
  out << closing;
}

void write_length_checks(std::ostream& out, const MessageTypes& types) {
  out << "// Generated from the .lcm files.\n#pragma once\n\n#include <cstddef>\n#include <string>\n\n"
         "#include \"shoal/message_schema.hpp\"\n";
  for (const auto& [name, schema] : types.all()) out << "#include \"" << replaced(name, ".", "/") << ".hpp\"\n";
  out << "\nnamespace shoal {\n\n"
         "template <class Length>\n"
         "void require_length(std::size_t size, Length length, const char* type, const char* member) {\n"
         "  if (length < 0 || size != static_cast<std::size_t>(length))\n"
         "    throw MessageError(std::string(type) + \": '\" + member + \"' has \" + std::to_string(size) +\n"
         "                       \" elements, its length member says \" + std::to_string(length));\n}\n\n";
  for (const auto& [name, schema] : types.all())
    out << "inline void check_array_lengths(const " << replaced(name, ".", "::") << "& m);\n";
  for (const auto& [name, schema] : types.all()) {
    out << "\ninline void check_array_lengths([[maybe_unused]] const " << replaced(name, ".", "::") << "& m) {\n";
    for (const Member& member : schema.members)
      if (member.is_variable() || member.compound != nullptr) write_member_check(out, schema, member);
    out << "}\n";
  }
  out << "\n}  // namespace shoal\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: generate_type_tables EMBEDDED_CPP ARRAY_LENGTHS_HPP LCM_FILE...\n";
    return 2;
  }
  try {
    std::vector<LcmSource> sources;
    for (int i = 3; i < argc; ++i) {
      std::ifstream file(argv[i]);
      std::stringstream text;
      text << file.rdbuf();
      sources.push_back({argv[i], text.str()});
    }
    const MessageTypes types(sources);
    std::ofstream embedded(argv[1]);
    write_embedded(embedded, sources);
    std::ofstream lengths(argv[2]);
    write_length_checks(lengths, types);
    if (!embedded.flush() || !lengths.flush()) throw shoal::MessageError("cannot write the tables");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
