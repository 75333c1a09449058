// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>

#include "sim/config/message_text.hpp"
#include "tools/experiment/upgrade/entry_edits.hpp"
#include "tools/experiment/upgrade/old_options.hpp"
#include "tools/experiment/upgrade/rewriting.hpp"

// Since version 0.2 a program that came with Shoal has its arguments as keys: `program: shoal-balance`,
// `args: {name: segway1}`.  Before, it had a list of options: `command: [shoal-balance, --name, segway1]`.

namespace tools {

namespace {

using Kind = SourceNode::Kind;

/// Option with its value, and the items of the list in which it is written.
struct Group {
  TextSpan span;
  std::vector<Argument> arguments;
};

std::vector<Group> groups_of(const SourceNode& list) {
  const std::string& program = list.items.front().target->scalar;
  std::vector<Group> groups;
  std::set<std::string> seen;
  for (std::size_t i = 1; i < list.items.size(); ++i) {
    const SourceNode& item = *list.items[i].target;
    const std::size_t at = list.items[i].start;
    // Find the option.
    const std::size_t equals = item.scalar.find('=');
    const std::string name = item.scalar.substr(0, equals);
    const std::string who = program + ": ";
    const OldOption* option = item.kind == Kind::scalar ? find_old_option(program, name) : nullptr;
    if (option == nullptr) throw Doubt(at, who + "'" + sim::shortened(item.scalar) + "' was no option of this program");
    if (!seen.insert(name).second) throw Doubt(at, who + "'" + name + "' is given twice");
    // Read its value.
    Group group{list.items[i].span, {}};
    const bool is_flag = option->form == OptionForm::flag;
    if (is_flag && equals != std::string::npos) throw Doubt(at, who + "'" + name + "' has no value");
    std::string value = equals == std::string::npos ? "" : item.scalar.substr(equals + 1);
    if (!is_flag && equals == std::string::npos) {
      if (++i == list.items.size() || list.items[i].target->kind != Kind::scalar)
        throw Doubt(at, who + "'" + name + "' needs a value");
      value = list.items[i].target->scalar;
      group.span.end = list.items[i].span.end;
    }
    // Convert it to arguments.
    const auto arguments = arguments_of(*option, value);
    if (!arguments) throw Doubt(at, who + "'" + sim::shortened(value) + "' is not a value of '" + name + "'");
    group.arguments = *arguments;
    groups.push_back(std::move(group));
  }
  return groups;
}

/// Writer of the keys of `args:` and the comments between the options.
class ArgumentsText {
 public:
  /// `after_program`: the first byte after the name of the program.
  ArgumentsText(const Site& site, std::vector<Group> groups, TextSpan list, std::size_t after_program)
      : site_(site), groups_(std::move(groups)) {
    for (const TextSpan& comment : site.text.comments_in(list)) {
      const bool is_of_program = comment.begin < site.text.line_end(after_program);
      (is_of_program ? of_program_ : comments_).push_back(comment);
    }
  }

  /// Returns the comments on the line of the program, or before it.
  std::string of_program(const std::string& line) const {
    std::string text;
    for (const TextSpan& comment : of_program_) text += (text.empty() ? "  " : line) + site_.source_of(comment);
    return text;
  }

  /// Returns `{key: value, key: value}`, in lines that start at `column` and are filled up.
  std::string in_braces(std::size_t column) const {
    const std::string pad = site_.text.line_break() + std::string(column + 1, ' ');
    std::string text = "{";
    std::size_t width = column + 1;
    std::size_t comment = 0;
    bool first = true;
    bool after_comment = false;
    // Comments up to a byte of the source.
    const auto add_comments = [&](std::size_t before) {
      for (; comment < comments_.size() && comments_[comment].begin < before; ++comment) {
        const bool stays = !after_comment && !first && is_trailing(comments_[comment]);
        text += (stays ? "  " : pad) + site_.source_of(comments_[comment]);
        after_comment = true;
      }
    };
    // Entries, filled into lines.
    for (const Group& group : groups_)
      for (const Argument& argument : group.arguments) {
        const std::string entry = argument.key + ": " + argument.value;
        if (!first) text += ",";
        add_comments(group.span.end);
        const bool fits =
            first || width + entry.size() + 3 <= max_line_length;  // with `, ` before and `,` or `}` after it
        if (after_comment || !fits)
          text += pad;
        else if (!first)
          text += " ";
        width = after_comment || !fits ? column + 1 : width + (first ? 0 : 2);
        text += entry;
        width += entry.size();
        first = after_comment = false;
      }
    add_comments(std::string::npos);
    return text + (after_comment ? pad : "") + "}";
  }

  /// Returns one line per key.
  std::string in_block(const std::string& line) const {
    std::string text;
    std::size_t comment = 0;
    bool after_comment = true;
    const auto add_comments = [&](std::size_t before) {
      for (; comment < comments_.size() && comments_[comment].begin < before; ++comment) {
        const bool stays = !after_comment && is_trailing(comments_[comment]);
        text += (stays ? "  " : line) + site_.source_of(comments_[comment]);
        after_comment = true;
      }
    };
    for (const Group& group : groups_) {
      // Comments between an option and its value precede the key.
      if (!after_comment) add_comments(group.span.begin);
      add_comments(group.span.end);
      for (const Argument& argument : group.arguments) {
        text += line + argument.key + ": " + argument.value;
        after_comment = false;
      }
    }
    add_comments(std::string::npos);
    return text;
  }

 private:
  /// Returns whether the comment follows other text on its line.
  bool is_trailing(TextSpan comment) const {
    const std::size_t begin = site_.text.line_begin(comment.begin);
    return site_.source_of({begin, comment.begin}).find_first_not_of(" \t-") != std::string::npos;
  }

  const Site& site_;
  std::vector<Group> groups_;
  std::vector<TextSpan> of_program_, comments_;
};

void write(Site& site, const SourceNode::Entry& entry, const std::string& prefix, const std::vector<Group>& groups) {
  const SourceNode& list = entry.value;
  // Check the form of the command.
  const bool is_plain = !site.source.pair && !list.properties && !entry.key.properties && list.kind != Kind::alias &&
                        entry.key.span.end - entry.key.span.begin == entry.key.scalar.size();
  if (!is_plain) throw Doubt(list.start, "a command that is written like this is not rewritten");
  // Texts of the program and its arguments.
  const TextSpan all{entry.key.span.begin, list.span.end};
  const ArgumentsText arguments(site, groups, {entry.after_colon, list.span.end}, list.items.front().span.end);
  const std::size_t column = site.text.column(all.begin);
  const std::string line = site.text.line_break() + std::string(column, ' ');
  const std::string program = prefix + "program: " + list.items.front().target->scalar;
  const std::string comments = arguments.of_program(line);
  const std::string args = prefix + "args: ";
  const std::string on_new_line = comments + line + args + arguments.in_braces(column + args.size());
  // Write them in the style of the file.
  if (groups.empty()) {
    site.edits->replace(all, program + comments);
  } else if (site.source.brackets) {
    const std::string on_same_line = " " + args + arguments.in_braces(column + program.size() + 2 + args.size());
    const bool fits = comments.empty() && on_same_line.find('\n') == std::string::npos;
    site.edits->replace(all, program + "," + (fits ? on_same_line : on_new_line));
  } else if (list.brackets) {
    site.edits->replace(all, program + on_new_line);
  } else {
    site.edits->replace(all, program + comments + line + prefix + "args:" + arguments.in_block(line + "  "));
  }
}

void rewrite(Site& site, const SourceNode::Entry& entry) {
  // Find a command of an old program.
  const SourceNode& list = *entry.value.target;
  const bool is_text = list.kind == Kind::scalar;
  const bool is_list =
      list.kind == Kind::list && !list.items.empty() && list.items.front().target->kind == Kind::scalar;
  if (!is_text && !is_list) return;
  const std::string program = is_text ? list.scalar : list.items.front().target->scalar;
  if (!is_old_program(program)) return;
  const std::string key = entry.key.scalar;
  const std::string prefix = key.substr(0, key.size() - std::string_view("command").size());
  const std::vector<Group> groups = is_list ? groups_of(list) : std::vector<Group>();

  // Change the meaning.
  sim::Diagnostics problems;
  auto& entries = site.meaning.entries;
  const auto at = std::find_if(entries.begin(), entries.end(), [&](const auto& each) { return each.key == key; });
  at->key = prefix + "program";
  at->value = sim::scalar_node(program, at->value.place);
  const sim::SourcePlace place = at->place;
  sim::ConfigNode args;
  args.kind = sim::ConfigNode::Kind::map;
  for (const Group& group : groups)
    for (const Argument& argument : group.arguments)
      args.entries.push_back({argument.key, place, sim::parse_config_text(argument.value, "args", problems)});
  if (!groups.empty()) entries.insert(std::next(at), {prefix + "args", place, std::move(args)});
  // Change the text.
  if (site.edits == nullptr) return;
  if (is_text)
    site.edits->replace(entry.key.span, prefix + "program");
  else
    write(site, entry, prefix, groups);
}

}  // namespace

void rewrite_command(Site& site) {
  if (site.source.kind != Kind::map) return;
  for (const SourceNode::Entry& entry : site.source.entries)
    if (entry.key.scalar.ends_with("command") &&
        site.path.value_of(entry.key.scalar).is(FileKind::world, "processes.*.command"))
      rewrite(site, entry);
}

}  // namespace tools
