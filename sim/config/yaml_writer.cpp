// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <string_view>

#include "sim/config/config_node.hpp"

namespace sim {

namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t max_flow_width = 80;
// yaml-cpp reads `key:` only when the key is at most 1024 bytes long; longer ones need the `? key` form.
constexpr std::size_t max_simple_key = 1000;

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// Returns whether the text without quotes parses to the same text.
bool plain_is_safe(std::string_view text, bool in_flow) {
  if (text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL" || text == "<<") return false;
  if (text.front() == ' ' || text.back() == ' ' || text.back() == ':') return false;
  if (text.starts_with("---") || text.starts_with("...")) return false;
  if (std::string_view(",[]{}#&*!|>'\"%@`").find(text.front()) != std::string_view::npos) return false;
  if (std::string_view("-?:").find(text.front()) != std::string_view::npos && (text.size() == 1 || text[1] == ' '))
    return false;
  if (text.find(": ") != std::string_view::npos || text.find(" #") != std::string_view::npos) return false;
  if (text.starts_with("\xef\xbb\xbf")) return false;  // a byte order mark would be lost
  if (in_flow && text.find_first_of(",[]{}?:") != std::string_view::npos) return false;
  return std::none_of(text.begin(), text.end(), is_control);
}

// Escapes what a double-quoted scalar of YAML 1.2 (section 5.7) cannot hold as it is; UTF-8 passes unchanged.
std::string in_double_quotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (c == '\t') {
      quoted += "\\t";
    } else if (is_control(c)) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", static_cast<unsigned char>(c));
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string scalar_text(const ConfigNode& node, bool in_flow) {
  if (node.kind == Kind::null) return "~";
  return node.quoted || !plain_is_safe(node.scalar, in_flow) ? in_double_quotes(node.scalar) : node.scalar;
}

std::string key_text(const std::string& key, bool in_flow) {
  return plain_is_safe(key, in_flow) ? key : in_double_quotes(key);
}

// Ends soon after `limit` bytes: an error quotes the beginning of a node, which may be as large as its file.
void append_flow(const ConfigNode& node, std::size_t limit, std::string& out) {
  if (out.size() > limit) return;
  if (node.kind == Kind::list) {
    out += '[';
    for (std::size_t i = 0; i < node.items.size() && out.size() <= limit; ++i) {
      if (i > 0) out += ", ";
      append_flow(node.items[i], limit, out);
    }
    out += ']';
  } else if (node.kind == Kind::map) {
    out += '{';
    for (std::size_t i = 0; i < node.entries.size() && out.size() <= limit; ++i) {
      out += (i > 0 ? ", " : "") + key_text(node.entries[i].key, true) + ": ";
      append_flow(node.entries[i].value, limit, out);
    }
    out += '}';
  } else {
    out += scalar_text(node, true);
  }
}

/// Returns whether a node is a list of values, or of lists of values, that can be written on one line with the same
/// quoting.
bool fits_on_a_line(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::null:
      return true;
    case Kind::scalar:
      return node.quoted || plain_is_safe(node.scalar, true) || !plain_is_safe(node.scalar, false);
    case Kind::list:
      return node.items.size() <= max_flow_width && std::all_of(node.items.begin(), node.items.end(), fits_on_a_line);
    case Kind::map:
      return node.entries.empty();
  }
  return false;
}

bool append_on_a_line(const ConfigNode& node, std::string& out) {
  if (node.kind == Kind::null || node.kind == Kind::scalar) {
    out += scalar_text(node, false);
    return true;
  }
  if (!fits_on_a_line(node)) return false;
  const std::string line = to_flow_yaml(node, max_flow_width);
  if (line.size() > max_flow_width) return false;
  out += line;
  return true;
}

void append_block(const ConfigNode& node, std::size_t indent, bool first_line_is_indented, std::string& out);

void append_entry(const ConfigNode::Entry& entry, std::size_t indent, std::string& out) {
  const std::string key = key_text(entry.key, false);
  // YAML 1.2 limits keys without '?' to 1024 characters.
  if (key.size() > max_simple_key)
    out += "? " + key + "\n" + std::string(indent, ' ') + ":";
  else
    out += key + ":";
  out += ' ';
  if (append_on_a_line(entry.value, out)) {
    out += '\n';
    return;
  }
  out.back() = '\n';
  append_block(entry.value, indent + 2, false, out);
}

void append_item(const ConfigNode& item, std::size_t indent, std::string& out) {
  out += "- ";
  if (append_on_a_line(item, out))
    out += '\n';
  else
    append_block(item, indent + 2, true, out);
}

void append_block(const ConfigNode& node, std::size_t indent, bool first_line_is_indented, std::string& out) {
  auto start_line = [&, first = first_line_is_indented]() mutable {
    if (!first) out.append(indent, ' ');
    first = false;
  };
  for (const ConfigNode::Entry& entry : node.entries) {
    start_line();
    append_entry(entry, indent, out);
  }
  for (const ConfigNode& item : node.items) {
    start_line();
    append_item(item, indent, out);
  }
}

}  // namespace

std::string to_flow_yaml(const ConfigNode& node, std::size_t limit) {
  std::string out;
  append_flow(node, limit, out);
  return out;
}

std::string to_yaml(const ConfigNode& node) {
  std::string out;
  if (append_on_a_line(node, out))
    out += '\n';
  else
    append_block(node, 0, false, out);
  return out;
}

}  // namespace sim
