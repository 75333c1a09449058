// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/upgrade_text.hpp"

#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "tools/experiment/upgrade/old_actions.hpp"

namespace tools {

namespace {

using Kind = SourceNode::Kind;

/// Returns null where both trees are equal; else the place where `b` differs, or of the node in `a` that `b` lacks.
const sim::ConfigNode* first_difference(const sim::ConfigNode& a, const sim::ConfigNode& b) {
  const bool same = a.kind == b.kind && a.quoted == b.quoted && a.scalar == b.scalar &&
                    a.items.size() == b.items.size() && a.entries.size() == b.entries.size();
  if (!same) return &a;
  for (std::size_t i = 0; i < a.items.size(); ++i)
    if (const auto* found = first_difference(a.items[i], b.items[i])) return found;
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    if (a.entries[i].key != b.entries[i].key) return &a.entries[i].value;
    if (const auto* found = first_difference(a.entries[i].value, b.entries[i].value)) return found;
  }
  return nullptr;
}

/// Passes every node to every rewriting, the inner ones first.
class Walk {
 public:
  Walk(const SourceText& text, std::span<const Rewriting> rewritings, TextEdits& edits)
      : text_(text), rewritings_(rewritings), edits_(edits) {}

  /// `written` is the node in the text, `meaning` the same with aliases expanded.
  void visit(const KeyPath& path, const SourceNode& written, sim::ConfigNode& meaning) {
    const SourceNode& source = *written.target;
    if (source.items.size() != meaning.items.size() || source.entries.size() != meaning.entries.size())
      throw Doubt(written.start, "this form of YAML is not followed by 'shoal upgrade'");
    for (std::size_t i = 0; i < source.items.size(); ++i) visit(path.item(), source.items[i], meaning.items[i]);
    const SourceNode::Entry* word = path.is_action() && source.entries.size() > 1 ? word_of_action(source) : nullptr;
    for (std::size_t i = 0; i < source.entries.size(); ++i) {
      const std::string& key = source.entries[i].key.scalar;
      const KeyPath below = word != nullptr ? path.value_of_action(key, word->key.scalar) : path.value_of(key);
      visit(below, source.entries[i].value, meaning.entries[i].value);
    }
    // The target of aliases is written once; the final comparison shows whether it is correct in all places.
    const bool is_first = text_.doubt() == std::nullopt && seen_.insert(&source).second;
    Site site{text_, path, source, meaning, is_first ? &edits_ : nullptr};
    for (const Rewriting& rewriting : rewritings_) rewriting.apply(site);
  }

 private:
  const SourceText& text_;
  std::span<const Rewriting> rewritings_;
  TextEdits& edits_;
  std::set<const SourceNode*> seen_;
};

/// Throws Doubt when the new text does not have the intended meaning, has other comments, or would be changed again.
void check(const SourceText& before, const std::string& after, const sim::ConfigNode& meaning, FileKind kind,
           std::span<const Rewriting> rewritings) {
  sim::Diagnostics problems;
  sim::ConfigNode again = sim::parse_config_text(after, "the rewritten file", problems);
  if (!problems.ok()) throw Doubt(0, "rewriting does not give valid YAML: " + problems.lines().front());
  if (const sim::ConfigNode* different = first_difference(meaning, again)) {
    std::size_t line = 0;
    for (int i = 1; i < different->place.line; ++i) line = before.line_end(line);
    throw Doubt(line + static_cast<std::size_t>(std::max(different->place.column - 1, 0)),
                "the rewritten file would not mean the same here");
  }
  const SourceText result(after);
  if (result.doubt()) throw Doubt(0, "rewriting gives YAML that is not followed");
  if (before.comment_texts() != result.comment_texts()) throw Doubt(0, "rewriting would change a comment");
  TextEdits edits;
  Walk walk(result, rewritings, edits);
  walk.visit(KeyPath(kind), result.root(), again);
  if (!edits.empty()) throw Doubt(0, "rewriting would not be finished");
}

}  // namespace

std::optional<FileKind> kind_of(const sim::ConfigNode& root) {
  const auto has_one = [&](std::initializer_list<const char*> keys) {
    return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return root.find(key) != nullptr; });
  };
  if (has_one({"groups"})) return std::nullopt;  // file of `shoal fidelity`
  if (has_one({"study", "seeds", "cases", "figures", "plots"})) return FileKind::study;
  if (has_one({"vehicles"})) return FileKind::world;
  if (has_one({"vehicle", "bodies", "joints", "devices"})) return FileKind::vehicle;
  if (has_one({"shoal", "include", "run", "physics", "medium", "acoustics", "objects", "zones", "actors", "events",
               "processes", "lockstep", "limits", "metrics", "pass", "light", "channels", "buses", "origin"}))
    return FileKind::world;
  return std::nullopt;
}

std::optional<UpgradedText> upgrade_text(const std::string& text, FileKind kind, const std::string& file_name,
                                         sim::Diagnostics& diagnostics, std::span<const Rewriting> rewritings) {
  sim::Diagnostics own;
  sim::ConfigNode meaning = sim::parse_config_text(text, file_name, own);
  for (const std::string& line : own.lines()) diagnostics.error({}, "", line);
  if (!own.ok()) return std::nullopt;
  const SourceText source(text);
  try {
    const sim::ConfigNode old = meaning;
    TextEdits edits;
    Walk walk(source, rewritings, edits);
    walk.visit(KeyPath(kind), source.root(), meaning);
    const bool is_same = first_difference(old, meaning) == nullptr;
    if (is_same && edits.empty()) return UpgradedText{text, {}};
    if (source.doubt()) throw *source.doubt();
    UpgradedText upgraded{edits.applied_to(text), edits.changed_lines(source)};
    check(source, upgraded.text, meaning, kind, rewritings);
    return upgraded;
  } catch (const Doubt& doubt) {
    diagnostics.error(source.place(doubt.at, sim::intern_file_name(file_name)), "",
                      std::string(doubt.what()) + "; the file is left as it is");
    return std::nullopt;
  }
}

}  // namespace tools
