// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <sstream>
#include <unordered_map>

#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

namespace sim {

namespace {

using Kind = ConfigNode::Kind;

constexpr int max_depth = 100;
constexpr std::size_t max_nodes = 2'000'000;
constexpr std::size_t max_text_bytes = 256'000'000;

/// Exception that ends the parsing.
struct Stop {
  SourcePlace place;
  std::string text;
  bool bad_key = false;
};

/// Size of a tree, counted when an alias copies it.
struct TreeSize {
  std::size_t nodes = 0;
  std::size_t text_bytes = 0;
  int depth = 0;
};

TreeSize size_of(const ConfigNode& node) {
  TreeSize size{1, node.scalar.size(), 0};
  const auto add = [&size](const ConfigNode& child, std::size_t key_bytes) {
    const TreeSize below = size_of(child);
    size.nodes += below.nodes;
    size.text_bytes += below.text_bytes + key_bytes;
    size.depth = std::max(size.depth, below.depth + 1);
  };
  for (const ConfigNode& item : node.items) add(item, 0);
  for (const ConfigNode::Entry& entry : node.entries) add(entry.value, entry.key.size());
  return size;
}

/// Builder of the tree from the events of the parser.  An intermediate YAML::Node tree would lose duplicate keys and
/// quotes.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(std::string_view text, const std::string* file, Diagnostics& diagnostics)
      : text_(text), file_(file), diagnostics_(diagnostics) {
    line_starts_.push_back(text.starts_with("\xef\xbb\xbf") ? 3 : 0);  // yaml-cpp skips a byte order mark
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n', end + 1))
      line_starts_.push_back(end + 1);
  }

  ConfigNode take_root() { return std::move(root_); }
  bool failed() const { return failed_; }

  void error(const SourcePlace& place, const std::string& text) {
    failed_ = true;
    diagnostics_.error(place, "", text);
  }

  SourcePlace place_of(const YAML::Mark& mark) const {
    return mark.is_null() ? SourcePlace{file_, 0, 0} : SourcePlace{file_, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) throw Stop{place_of(mark), "a second YAML document; a file holds one"};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) stop_at_bad_key(mark, "nothing");
    ConfigNode node = new_node(Kind::null, mark);
    // The mark of an empty value is that of the next token; report the key without a value instead.
    const bool is_value = !open_.empty() && open_.back().node.kind == Kind::map;
    if (is_value && node.place.line != open_.back().key_place.line) node.place = open_.back().key_place;
    add(std::move(node), anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool quoted = check_tag(mark, tag) == Tag::text;
    count({1, value.size(), 0}, place_of(mark));
    if (expects_key()) {
      if (anchor != YAML::NullAnchor) remember(anchor, scalar_node(mark, value, quoted));
      set_key(mark, value, quoted);
      return;
    }
    add(scalar_node(mark, value, quoted), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (expects_key()) stop_at_bad_key(mark, "an alias");
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw Stop{place_of(mark), "an alias inside the node it stands for"};
    check_depth(static_cast<int>(open_.size()) + found->second.size.depth, place_of(mark));
    count(found->second.size, place_of(mark));
    add(found->second.node, YAML::NullAnchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    if (expects_key()) stop_at_bad_key(mark, "a list");
    check_tag(mark, tag);
    start(Kind::list, mark, anchor);
  }
  void OnSequenceEnd() override { finish(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    if (expects_key()) stop_at_bad_key(mark, "a map");
    check_tag(mark, tag);
    start(Kind::map, mark, anchor);
  }
  void OnMapEnd() override { finish(); }

 private:
  enum class Tag { none, text };

  /// Open list or map.
  struct Open {
    ConfigNode node;
    YAML::anchor_t anchor = YAML::NullAnchor;
    bool has_key = false;
    std::string key;
    SourcePlace key_place;
    std::unordered_map<std::string, int> line_of_key;
  };
  struct Anchored {
    ConfigNode node;
    TreeSize size;
  };

  bool expects_key() const { return !open_.empty() && open_.back().node.kind == Kind::map && !open_.back().has_key; }

  [[noreturn]] void stop_at_bad_key(const YAML::Mark& mark, const char* what) const {
    throw Stop{place_of(mark), std::string("a key must be text, got ") + what, true};
  }

  ConfigNode new_node(Kind kind, const YAML::Mark& mark) {
    count({1, 0, 0}, place_of(mark));
    ConfigNode node;
    node.kind = kind;
    node.place = place_of(mark);
    return node;
  }

  ConfigNode scalar_node(const YAML::Mark& mark, const std::string& value, bool quoted) const {
    ConfigNode node;
    node.kind = Kind::scalar;
    node.quoted = quoted;
    node.scalar = value;
    node.place = place_of(mark);
    node.verbatim = is_verbatim(mark, value, quoted);
    return node;
  }

  /// Returns whether a scalar is literal in the file: block scalars, escapes, and texts of several lines differ from
  /// their values.
  bool is_verbatim(const YAML::Mark& mark, const std::string& value, bool quoted) const {
    if (mark.is_null() || static_cast<std::size_t>(mark.line) >= line_starts_.size()) return false;
    const std::size_t at = line_starts_[static_cast<std::size_t>(mark.line)] + static_cast<std::size_t>(mark.column);
    return at < text_.size() && text_.substr(at).substr(quoted ? 1 : 0).starts_with(value);
  }

  /// Returns the kind of a tag.  yaml-cpp gives the tag `!` to a scalar in quotes, and `?` to anything else without a
  /// tag.
  Tag check_tag(const YAML::Mark& mark, const std::string& tag) const {
    static const std::string standard = "tag:yaml.org,2002:";
    if (tag == "!" || tag == standard + "str") return Tag::text;
    if (tag.empty() || tag == "?" || tag == standard + "map" || tag == standard + "seq") return Tag::none;
    const std::string written = tag.starts_with(standard) ? "!!" + tag.substr(standard.size()) : tag;
    throw Stop{place_of(mark), "the tag '" + shortened(written) + "' is not supported"};
  }

  void check_depth(int depth, const SourcePlace& place) const {
    if (depth > max_depth) throw Stop{place, "nested more than " + std::to_string(max_depth) + " deep"};
  }

  void count(const TreeSize& size, const SourcePlace& place) {
    nodes_ += size.nodes;
    text_bytes_ += size.text_bytes;
    if (nodes_ > max_nodes || text_bytes_ > max_text_bytes)
      throw Stop{place, "more than " + std::to_string(max_nodes) + " values or " +
                            std::to_string(max_text_bytes / 1'000'000) + " MB of text, aliases expanded"};
  }

  void set_key(const YAML::Mark& mark, const std::string& key, bool quoted) {
    Open& map = open_.back();
    map.has_key = true;
    map.key = key;
    map.key_place = place_of(mark);
    if (key == "<<" && !quoted)
      error(map.key_place, "merge keys ('<<') are not supported; use include, overrides or parameters");
    const auto [first, is_new] = map.line_of_key.emplace(key, map.key_place.line);
    if (!is_new)
      error(map.key_place, "duplicate key '" + shortened(key) + "', first at line " + std::to_string(first->second));
  }

  void start(Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) {
    check_depth(static_cast<int>(open_.size()) + 1, place_of(mark));
    Open open;
    open.node = new_node(kind, mark);
    open.anchor = anchor;
    open_.push_back(std::move(open));
  }

  void finish() {
    Open done = std::move(open_.back());
    open_.pop_back();
    add(std::move(done.node), done.anchor);
  }

  void remember(YAML::anchor_t anchor, const ConfigNode& node) {
    const TreeSize size = size_of(node);
    count(size, node.place);  // nested anchors copy their contents once for each level
    anchors_[anchor] = {node, size};
  }

  void add(ConfigNode node, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) remember(anchor, node);
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == Kind::list) {
      parent.node.items.push_back(std::move(node));
      return;
    }
    parent.node.entries.push_back({std::move(parent.key), parent.key_place, std::move(node)});
    parent.has_key = false;
  }

  std::string_view text_;
  std::vector<std::size_t> line_starts_;
  const std::string* file_;
  Diagnostics& diagnostics_;
  ConfigNode root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  bool failed_ = false;
  int documents_ = 0;
  std::size_t nodes_ = 0;
  std::size_t text_bytes_ = 0;
};

struct BadByte {
  std::size_t at;
  std::string text;
};

/// Checks the encoding, because yaml-cpp accepts invalid UTF-8, and takes the byte 4 as the end of the file.
std::optional<BadByte> first_bad_byte(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && c != '\n' && c != '\r' && c != '\t') || c == 0x7f) {
      char name[40];
      std::snprintf(name, sizeof name, "control character 0x%02x", c);
      return BadByte{i, std::string(name) + "; is this a text file?"};
    }
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return BadByte{i, "not valid UTF-8; is this a text file?"};
    i += length;
  }
  return std::nullopt;
}

/// Finds brackets nested beyond a limit: yaml-cpp scans all of `[[[[...` before it reports the first event, with 2 GB
/// of memory for 10 MB.  The limit is far above max_depth, because brackets in comments and quotes are counted too.
std::optional<BadByte> hopeless_nesting(std::string_view text) {
  constexpr int limit = 10'000;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '[' || text[i] == '{') ++depth;
    if ((text[i] == ']' || text[i] == '}') && depth > 0) --depth;
    if (depth > limit) return BadByte{i, "more than " + std::to_string(limit) + " brackets are never closed"};
  }
  return std::nullopt;
}

/// Returns whether a bracket may be open; a hint only, because brackets in comments and quotes are counted too.
bool may_have_open_bracket(std::string_view text) {
  std::ptrdiff_t open = 0;
  for (const char c : text) open += (c == '[' || c == '{') - (c == ']' || c == '}');
  return open > 0;
}

/// Detects a tab in the indentation, which yaml-cpp reports as `illegal map value`, among others.
bool is_indented_with_tab(std::string_view text, int line) {
  for (int before = 0; before < line; ++before) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
  const std::size_t first = text.find_first_not_of(' ');
  return first != std::string_view::npos && text[first] == '\t';
}

/// Number, from 1, of the line before `line` (from 0) if it is text without a colon; 0: it is not.  yaml-cpp joins such
/// a line to the key below it, and reports the value of that one, behind the first colon, as `illegal map value`.
int line_without_colon(const std::string& text, int line, int column) {
  std::istringstream lines(text);
  std::string before, each;
  for (int number = 0; number < line && std::getline(lines, each); ++number) before = each;
  if (!std::getline(lines, each) || each.find(':') < static_cast<std::size_t>(column)) return 0;
  const std::size_t first = before.find_first_not_of(" \r");
  const bool is_text = first != std::string::npos && before[first] != '#' && before[first] != '-';
  return is_text && before.find(':') == std::string::npos ? line : 0;
}

SourcePlace place_at(std::string_view text, std::size_t at, const std::string* file) {
  SourcePlace place{file, 1, 1};
  for (std::size_t i = 0; i < at; ++i) {
    ++place.column;
    if (text[i] == '\n') place = {file, place.line + 1, 1};
  }
  return place;
}

}  // namespace

ConfigNode parse_config_text(const std::string& text, const std::string& file_name, Diagnostics& diagnostics) {
  const std::string* file = intern_file_name(file_name);
  // Check encoding and nesting before yaml-cpp reads the text.
  auto bad = first_bad_byte(text);
  if (!bad) bad = hopeless_nesting(text);
  if (bad) {
    diagnostics.error(place_at(text, bad->at, file), "", bad->text);
    return {};
  }
  // Parse, and convert exceptions to errors.
  TreeBuilder builder(text, file, diagnostics);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Stop& stop) {
    // yaml-cpp takes the text in an open bracket for a key.
    const bool open = stop.bad_key && may_have_open_bracket(text);
    builder.error(stop.place, stop.text + (open ? "; is a bracket not closed?" : ""));
  } catch (const YAML::DeepRecursion& error) {
    builder.error(builder.place_of(error.mark), "nested more than " + std::to_string(max_depth) + " deep");
  } catch (const YAML::Exception& error) {
    const bool tab = !error.mark.is_null() && is_indented_with_tab(text, error.mark.line);
    const bool value = !error.mark.is_null() && error.msg == YAML::ErrorMsg::MAP_VALUE;
    const int joined = value ? line_without_colon(text, error.mark.line, error.mark.column) : 0;
    builder.error(builder.place_of(error.mark),
                  "not valid YAML: " + (tab ? "the line is indented with a tab; use spaces" : error.msg) +
                      (joined > 0 ? "; line " + std::to_string(joined) + " has no colon" : ""));
  }
  if (builder.failed()) return {};
  return builder.take_root();
}

}  // namespace sim
