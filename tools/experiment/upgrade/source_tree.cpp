// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/source_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "tools/experiment/upgrade/source_spans.hpp"

namespace tools {

namespace {

using Kind = SourceNode::Kind;

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

/// Builds the tree from the events of yaml-cpp, which give the starts of nodes, but not their ends.
class SourceTreeBuilder final : public YAML::EventHandler {
 public:
  /// `skipped`: bytes before the first one that yaml-cpp counts.
  explicit SourceTreeBuilder(std::size_t skipped) : skipped_(skipped) {}

  SourceNode take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(node(Kind::null, mark, anchor)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(node(Kind::alias, mark, anchor)); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    SourceNode scalar = node(Kind::scalar, mark, anchor);
    scalar.scalar = value;
    scalar.quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    add(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    start(Kind::list, mark, anchor, style);
  }
  void OnSequenceEnd() override { finish(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    start(Kind::map, mark, anchor, style);
  }
  void OnMapEnd() override { finish(); }

 private:
  struct Open {
    SourceNode node;
    bool has_key = false;
    SourceNode key;
  };

  SourceNode node(Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor) const {
    SourceNode made;
    made.kind = kind;
    made.anchor = anchor;
    made.start = mark.is_null() ? 0 : static_cast<std::size_t>(mark.pos) + skipped_;
    return made;
  }

  void start(Kind kind, const YAML::Mark& mark, YAML::anchor_t anchor, YAML::EmitterStyle::value style) {
    open_.push_back({node(kind, mark, anchor), false, {}});
    open_.back().node.brackets = style == YAML::EmitterStyle::Flow;
  }

  void finish() {
    SourceNode done = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(done));
  }

  void add(SourceNode done) {
    if (open_.empty()) {
      root_ = std::move(done);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == Kind::list) {
      parent.node.items.push_back(std::move(done));
    } else if (!parent.has_key) {
      parent.key = std::move(done);
      parent.has_key = true;
    } else {
      parent.node.entries.push_back({std::move(parent.key), 0, std::move(done)});
      parent.has_key = false;
    }
  }

  std::size_t skipped_;
  SourceNode root_;
  std::vector<Open> open_;
};

/// Connects aliases with their targets, once the addresses of the nodes are final.
class AliasTargets {
 public:
  void connect(SourceNode& node) {
    node.target = &node;
    if (node.kind == Kind::alias) {
      node.target = anchored_.at(node.anchor);
      return;
    }
    for (SourceNode& item : node.items) connect(item);
    for (SourceNode::Entry& entry : node.entries) {
      connect(entry.key);
      connect(entry.value);
    }
    if (node.anchor != 0) anchored_[node.anchor] = &node;
  }

 private:
  std::map<std::size_t, const SourceNode*> anchored_;
};

}  // namespace

const SourceNode::Entry* SourceNode::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key.scalar == key; });
  return found == entries.end() ? nullptr : &*found;
}

SourceText::SourceText(std::string text) : text_(std::move(text)) {
  SourceTreeBuilder builder(text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  std::istringstream stream(text_);
  YAML::Parser parser(stream);
  parser.HandleNextDocument(builder);
  root_ = builder.take_root();
  AliasTargets().connect(root_);
  try {
    comments_ = find_spans(text_, root_);
  } catch (const Doubt& doubt) {
    doubt_ = doubt;
  }
}

std::span<const TextSpan> SourceText::comments_in(TextSpan span) const {
  const auto from = [&](std::size_t at) {
    return std::lower_bound(comments_.begin(), comments_.end(), at,
                            [](const TextSpan& comment, std::size_t begin) { return comment.begin < begin; });
  };
  return {from(span.begin), from(span.end)};
}

std::vector<std::string> SourceText::comment_texts() const {
  std::vector<std::string> texts;
  for (const TextSpan& comment : comments_) texts.push_back(text_.substr(comment.begin, comment.end - comment.begin));
  return texts;
}

std::size_t SourceText::line_begin(std::size_t at) const {
  if (at == 0) return 0;
  const std::size_t before = text_.rfind('\n', at - 1);
  return before == std::string::npos ? 0 : before + 1;
}

std::size_t SourceText::line_end(std::size_t at) const {
  const std::size_t found = text_.find('\n', at);
  return found == std::string::npos ? text_.size() : found + 1;
}

const char* SourceText::line_break() const {
  const std::size_t first = text_.find('\n');
  return first != std::string::npos && first > 0 && text_[first - 1] == '\r' ? "\r\n" : "\n";
}

sim::SourcePlace SourceText::place(std::size_t at, const std::string* file) const {
  const std::size_t end = std::min(at, text_.size());
  const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(end), '\n');
  std::size_t before = column(end);
  if (lines == 0 && text_.starts_with(byte_order_mark)) before -= std::min(before, byte_order_mark.size());
  return {file, static_cast<int>(lines) + 1, static_cast<int>(before) + 1};
}

}  // namespace tools
