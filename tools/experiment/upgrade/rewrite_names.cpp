// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "tools/experiment/upgrade/entry_edits.hpp"
#include "tools/experiment/upgrade/renames.hpp"

namespace tools {

namespace {

using Kind = SourceNode::Kind;

/// Returns the present name of a key.  Each part of a dotted key is renamed with the path of the parts before it.
std::string renamed_key(const Site& site, const std::string& key, std::span<const Rename> table) {
  const auto name_at = [&](const KeyPath& map, std::string_view name) {
    for (const Rename& rename : table)
      if (rename.what == Rename::What::key && rename.before == name && map.is(rename.kind, rename.path))
        return std::string(rename.after);
    return std::string(name);
  };
  if (!site.path.has_dotted_keys()) return name_at(site.path, key);
  const std::size_t slash = key.find('/');  // one vehicle of a count
  std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  std::string renamed = key.substr(0, begin);
  for (const std::size_t first = begin; begin <= key.size();) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    const std::string_view part = std::string_view(key).substr(begin, end - begin);
    renamed += begin == first ? "" : ".";
    renamed += begin == first ? name_at(site.path.top_of_dotted(), part)
                              : name_at(site.path.value_of(key.substr(0, begin - 1)), part);
    begin = end + 1;
  }
  return renamed;
}

/// Returns the text with the present words.
std::string renamed_text(const Site& site, std::span<const Rename> table) {
  std::string text = site.source.scalar;
  for (const Rename& rename : table) {
    if (rename.what == Rename::What::key || !site.path.is(rename.kind, rename.path)) continue;
    if (rename.what == Rename::What::word && text == rename.before) return std::string(rename.after);
    if (rename.what == Rename::What::figure) text = renamed_figure(std::move(text), rename.before, rename.after);
    if (rename.what != Rename::What::part) continue;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      const bool is_it = std::string_view(text).substr(begin, end - begin) == rename.before;
      if (is_it) text.replace(begin, end - begin, rename.after);
      begin += (is_it ? rename.after.size() : end - begin) + 1;
    }
  }
  return text;
}

/// Replaces a word or a key, inside its quotes if it has any.
void replace_name(Site& site, const SourceNode& name, std::string_view after) {
  if (site.edits == nullptr) return;
  const std::string written = site.source_of(name.span);
  const bool in_quotes =
      written.size() > 1 && (written[0] == '"' || written[0] == '\'') && written[0] == written.back();
  const TextSpan span = in_quotes ? TextSpan{name.span.begin + 1, name.span.end - 1} : name.span;
  if (site.source_of(span) != name.scalar) throw Doubt(name.start, "a name that is written like this is not rewritten");
  site.edits->replace(span, std::string(after));
}

void rename_key(Site& site, const SourceNode::Entry& entry, const std::string& name) {
  if (site.meaning.find(name) != nullptr)
    throw Doubt(entry.key.start, "'" + entry.key.scalar + "' is '" + name + "' now, which is there too");
  entry_of(site.meaning, entry.key.scalar).key = name;
  replace_name(site, entry.key, name);
}

}  // namespace

std::string renamed_figure(std::string text, std::string_view before, std::string_view after) {
  const auto is_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  for (std::size_t at = text.find(before); at != std::string::npos; at = text.find(before, at)) {
    const std::size_t end = at + before.size();
    const bool whole = at > 0 && text[at - 1] == '.' && (end == text.size() || !is_name(text[end]));
    if (whole) text.replace(at, before.size(), after);
    at += whole ? after.size() : before.size();
  }
  return text;
}

void apply_renames(Site& site, std::span<const Rename> table) {
  if (table.empty()) return;
  if (site.source.kind == Kind::map)
    for (const SourceNode::Entry& entry : site.source.entries) {
      const std::string& key = entry.key.scalar;
      const std::string name = renamed_key(site, key, table);
      // Another rewriting may have removed the key.
      if (name != key && site.meaning.find(key) != nullptr) rename_key(site, entry, name);
    }
  if (site.source.kind != Kind::scalar || site.meaning.scalar != site.source.scalar) return;
  const std::string text = renamed_text(site, table);
  if (text == site.source.scalar) return;
  site.meaning.scalar = text;
  replace_name(site, site.source, text);
}

void rewrite_names(Site& site) {
  apply_renames(site, renames());
}

}  // namespace tools
