// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/rule_expression.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "sim/config/message_text.hpp"

namespace sim {

namespace {

constexpr const char* made_of = "a rule is made of numbers, figures, + - * / ( ) and one of < <= > >= == !=";

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
/// Returns whether a character may be in a name.  Names of metrics and cases may contain '-', which is also the minus
/// sign.
bool is_of_name(char c) {
  return is_letter(c) || is_digit(c) || c == '-' || c == '.';
}

std::string quoted(std::string_view text) {
  return "'" + shortened(printable(text)) + "'";
}

/// Returns the bytes of the first UTF-8 character of `text`.
std::string_view first_character(std::string_view text) {
  std::size_t size = 1;
  while (size < text.size() && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) ++size;
  return text.substr(0, size);
}

/// Returns whether a word that starts with a digit is a name such as `3d.rms_m`, with a letter after a dot.
bool has_figure(std::string_view word) {
  const std::size_t dot = word.rfind('.');
  return dot != std::string_view::npos && dot + 1 < word.size() && is_letter(word[dot + 1]);
}

}  // namespace

std::string RuleExpression::Figure::text() const {
  return function.empty() ? name : function + "(" + name + ")";
}

/// Recursive-descent parser; throws a RuleProblem at the first error.
class RuleParser {
 public:
  RuleParser(std::string_view text, const RuleNames& names) : text_(text), names_(names) { rule_.text_ = text; }

  RuleExpression parse() {
    if (text_.size() > RuleExpression::max_length)
      fail(RuleExpression::max_length,
           "a rule has at most " + std::to_string(RuleExpression::max_length) + " characters");
    skip_blanks();
    if (at_end()) fail(0, "the rule is empty; write a comparison such as 'METRIC.FIGURE < 5'");
    steps_ = &rule_.left_;
    read_sum();
    if (!read_comparison()) fail_after_operand();
    steps_ = &rule_.right_;
    read_sum();
    if (!at_end()) fail_after_operand();
    if (rule_.figures_.empty()) fail(0, "the rule names no figure, so that no run can change its outcome");
    return std::move(rule_);
  }

 private:
  using Step = RuleExpression::Step;
  using Comparison = RuleExpression::Comparison;

  [[noreturn]] static void fail(std::size_t at, std::string text) { throw RuleProblem{at, std::move(text)}; }

  bool at_end() const { return at_ >= text_.size(); }
  std::string_view rest() const { return text_.substr(at_); }
  bool is_next(std::string_view what) const { return rest().starts_with(what); }
  void skip_blanks() {
    while (!at_end() && is_blank(text_[at_])) ++at_;
  }
  bool take(std::string_view what) {
    if (!is_next(what)) return false;
    at_ += what.size();
    skip_blanks();
    return true;
  }

  /// Returns the next sequence of characters of names and numbers.
  std::string_view word() const {
    std::size_t end = at_;
    while (end < text_.size() && is_of_name(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }

  /// Returns the next word, operator or character, for messages.
  std::string shown_next() const {
    for (const std::string_view of : {"<=", ">=", "==", "!="})
      if (is_next(of)) return quoted(of);
    if (is_letter(text_[at_]) || is_digit(text_[at_])) return quoted(word());
    return quoted(first_character(rest()));
  }

  bool comparison_is_next() const { return is_next("<") || is_next(">") || is_next("==") || is_next("!="); }

  bool read_comparison() {
    // Operators with a common prefix: the longer one first.
    static constexpr std::pair<std::string_view, Comparison> comparisons[] = {
        {"<=", Comparison::less_or_equal}, {">=", Comparison::greater_or_equal},
        {"==", Comparison::equal},         {"!=", Comparison::not_equal},
        {"<", Comparison::less},           {">", Comparison::greater}};
    for (const auto& [sign, comparison] : comparisons)
      if (take(sign)) {
        rule_.comparison_ = comparison;
        return true;
      }
    return false;
  }

  /// Reports text in place of an operator, a comparison or the end.  `open`: position of an open parenthesis.
  [[noreturn]] void fail_after_operand(const std::optional<std::size_t>& open = std::nullopt) const {
    if (at_end() && open) fail(*open, "'(' is not closed");
    if (at_end()) fail(at_, "the rule has no comparison; write one of < <= > >= == !=");
    if (is_next("=<") || is_next("=>"))
      fail(at_, std::string("write '") + text_[at_ + 1] + "=' instead of '=" + text_[at_ + 1] + "'");
    if (is_next("=") && !is_next("==")) fail(at_, "write '==' instead of '='");
    if (is_next("&") || is_next("|") || word() == "and" || word() == "or")
      fail(at_, "a rule has one comparison; write two rules instead of " + shown_next());
    if (comparison_is_next())
      fail(at_, open ? "a comparison cannot stand in parentheses, got " + shown_next()
                     : "a rule has one comparison; write a second rule for " + shown_next());
    if (is_next(")")) fail(at_, "')' closes nothing");
    if (is_next("(") || is_of_name(text_[at_])) fail(at_, "an operator is missing before " + shown_next());
    fail(at_, shown_next() + " has no meaning here: " + made_of);
  }

  void read_sum() {
    read_product();
    for (;;) {
      const Step::Kind kind = is_next("+") ? Step::Kind::add : Step::Kind::subtract;
      if (!take("+") && !take("-")) return;
      read_product();
      steps_->push_back({.kind = kind});
    }
  }

  void read_product() {
    read_operand();
    for (;;) {
      const Step::Kind kind = is_next("*") ? Step::Kind::multiply : Step::Kind::divide;
      if (!take("*") && !take("/")) return;
      const std::size_t divisor = at_;
      read_operand();
      const Step& last = steps_->back();
      // A figure may be 0 as well, but that is known only after the run.
      if (kind == Step::Kind::divide && last.kind == Step::Kind::number && last.number == 0)
        fail(divisor, "a division by 0 has no result");
      steps_->push_back({.kind = kind});
    }
  }

  /// Reads a number, a figure, an expression in parentheses, or an operand after a minus.
  void read_operand() {
    if (++depth_ > RuleExpression::max_depth)
      fail(at_, "the rule is nested more than " + std::to_string(RuleExpression::max_depth) + " deep");
    const std::size_t begin = at_;
    if (take("-")) {
      read_operand();
      steps_->push_back({.kind = Step::Kind::negate});
    } else if (take("(")) {
      read_sum();
      if (!take(")")) fail_after_operand(begin);
    } else if (!at_end() && (is_digit(text_[at_]) || text_[at_] == '.')) {
      read_number_or_name();
    } else if (!at_end() && is_letter(text_[at_])) {
      read_name();
    } else {
      fail_without_operand();
    }
    --depth_;
  }

  [[noreturn]] void fail_without_operand() const {
    if (at_end()) fail(at_, "a number or a figure is missing at the end of the rule");
    if (comparison_is_next() || is_next(")") || is_next("+") || is_next("*") || is_next("/") || is_next("="))
      fail(at_, "a number or a figure is missing before " + shown_next());
    fail(at_, shown_next() + " has no meaning here: " + made_of);
  }

  void read_number_or_name() {
    double number = 0;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), number);
    const auto length = static_cast<std::size_t>(end - begin);
    const bool ends_there =
        at_ + length >= text_.size() || !is_of_name(text_[at_ + length]) || text_[at_ + length] == '-';
    if (error == std::errc::invalid_argument || !ends_there) {
      // A figure may begin with a digit, since names of vehicles may.
      if (is_digit(text_[at_]) && has_figure(word())) return read_name();
      fail(at_, quoted(word()) + " is not a number");
    }
    if (error == std::errc::result_out_of_range)
      fail(at_, quoted(text_.substr(at_, length)) + " is outside the range of numbers");
    at_ += length;
    skip_blanks();
    steps_->push_back({.kind = Step::Kind::number, .number = number});
  }

  void read_name() {
    const std::size_t begin = at_;
    const std::string_view whole = word();
    if (const std::size_t after = text_.find_first_not_of(" \t\r\n", begin + whole.size());
        after != std::string_view::npos && text_[after] == '(' && whole.find_first_of(".-") == std::string_view::npos)
      return read_function(std::string(whole));
    const std::string name(text_.substr(begin, name_length(whole, "")));
    if (const auto problem = names_.name_problem("", name)) fail(begin + problem->at, problem->text);
    at_ = begin + name.size();
    skip_blanks();
    add_figure({"", name});
  }

  void read_function(const std::string& function) {
    const std::size_t begin = at_;
    at_ += function.size();
    // Errors point at the character of the rule that is wrong, so positions are kept before anything is skipped.
    skip_blanks();
    const std::size_t open = at_;
    if (const std::string problem = names_.function_problem(function); !problem.empty()) fail(begin, problem);
    take("(");
    const std::size_t name_at = at_;
    const std::string name(word());
    if (name.empty()) {
      if (at_end()) fail(open, "'(' is not closed");
      fail(at_, "the name of a figure must stand in '" + function + "(...)', got " + shown_next());
    }
    if (const auto problem = names_.name_problem(function, name)) fail(name_at + problem->at, problem->text);
    at_ += name.size();
    skip_blanks();
    if (at_end()) fail(open, "'(' is not closed");
    if (!take(")")) fail(at_, "'" + function + "(...)' holds the name of one figure, got " + shown_next());
    add_figure({function, name});
  }

  /// Returns the length of a name that may be followed by a minus: up to the last '-' before which it is known.
  std::size_t name_length(std::string_view whole, const std::string& function) const {
    for (std::size_t end = whole.size();; end = whole.rfind('-', end - 1)) {
      if (end == std::string_view::npos || end == 0) break;
      if (!names_.name_problem(function, std::string(whole.substr(0, end)))) return end;
    }
    // No prefix is known; figures have no '-' in their names.
    const std::size_t dot = whole.find('.');
    return std::min(whole.find('-', dot == std::string_view::npos ? whole.size() : dot), whole.size());
  }

  void add_figure(const RuleExpression::Figure& figure) {
    auto& figures = rule_.figures_;
    const auto found = std::find(figures.begin(), figures.end(), figure);
    const auto index = static_cast<std::size_t>(found - figures.begin());
    if (found == figures.end()) figures.push_back(figure);
    steps_->push_back({.kind = Step::Kind::figure, .figure = index});
  }

  std::string_view text_;
  const RuleNames& names_;
  RuleExpression rule_;
  std::vector<Step>* steps_ = nullptr;  ///< of the side being read
  std::size_t at_ = 0;
  int depth_ = 0;
};

std::optional<RuleExpression> RuleExpression::parse(std::string_view text, const RuleNames& names,
                                                    RuleProblem& problem) {
  try {
    return RuleParser(text, names).parse();
  } catch (RuleProblem& found) {
    problem = std::move(found);
    return std::nullopt;
  }
}

double RuleExpression::calculate(const std::vector<Step>& steps, std::span<const double> values) {
  std::vector<double> stack;
  const auto pop = [&stack] {
    const double top = stack.back();
    stack.pop_back();
    return top;
  };
  // Execute the operations on the stack.
  for (const Step& step : steps) {
    switch (step.kind) {
      case Step::Kind::number:
        stack.push_back(step.number);
        break;
      case Step::Kind::figure:
        stack.push_back(values[step.figure]);
        break;
      case Step::Kind::negate:
        stack.back() = -stack.back();
        break;
      case Step::Kind::add: {
        const double right = pop();
        stack.back() += right;
        break;
      }
      case Step::Kind::subtract: {
        const double right = pop();
        stack.back() -= right;
        break;
      }
      case Step::Kind::multiply: {
        const double right = pop();
        stack.back() *= right;
        break;
      }
      case Step::Kind::divide: {
        const double right = pop();
        stack.back() /= right;
        break;
      }
    }
  }
  return stack.back();
}

RuleExpression::Outcome RuleExpression::evaluate(std::span<const double> values) const {
  Outcome outcome;
  outcome.left = calculate(left_, values);
  outcome.right = calculate(right_, values);
  const double left = outcome.left, right = outcome.right;
  // Compare the sides, and compute the margin.
  switch (comparison_) {
    case Comparison::less:
      outcome.holds = left < right;
      outcome.margin = right - left;
      break;
    case Comparison::less_or_equal:
      outcome.holds = left <= right;
      outcome.margin = right - left;
      break;
    case Comparison::greater:
      outcome.holds = left > right;
      outcome.margin = left - right;
      break;
    case Comparison::greater_or_equal:
      outcome.holds = left >= right;
      outcome.margin = left - right;
      break;
    case Comparison::equal:
      outcome.holds = left == right;
      outcome.margin = std::numeric_limits<double>::quiet_NaN();
      break;
    case Comparison::not_equal:
      outcome.holds = left != right;
      outcome.margin = std::numeric_limits<double>::quiet_NaN();
      break;
  }
  // A rule fails for NaN, and for infinite sides of finite figures.
  const bool any_nan = std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
  const bool all_finite = std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  if (any_nan || std::isnan(left) || std::isnan(right)) outcome.holds = false;
  if (all_finite && (!std::isfinite(left) || !std::isfinite(right))) outcome.holds = false;
  return outcome;
}

}  // namespace sim
