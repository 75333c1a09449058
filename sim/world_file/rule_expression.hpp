// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// Error in a rule, and the index of its character in the text, counted from 0.
struct RuleProblem {
  std::size_t at = 0;
  std::string text;
};

/// Interface that checks the figures named by the rules of a file.
class RuleNames {
 public:
  virtual ~RuleNames() = default;
  /// Returns what is wrong with a function, the `max` of `max(NAME)`; empty when it is valid.
  virtual std::string function_problem(const std::string& function) const = 0;
  /// Returns what is wrong with a name, and at which of its characters; none when it is valid.  `function` is empty for
  /// a name without one.
  virtual std::optional<RuleProblem> name_problem(const std::string& function, const std::string& name) const = 0;
};

/// Pass rule such as `cooperative.rms_m < 0.4 * alone.rms_m`: figures and numbers with + - * / and parentheses on both
/// sides of one comparison.
class RuleExpression {
 public:
  enum class Comparison { less, less_or_equal, greater, greater_or_equal, equal, not_equal };

  static constexpr std::size_t max_length = 500;
  static constexpr int max_depth = 32;

  struct Figure {
    std::string function;  ///< empty: none
    std::string name;
    bool operator==(const Figure&) const = default;
    /// `NAME` or `max(NAME)`.
    std::string text() const;
  };

  /// Result of the evaluation of a rule.
  struct Outcome {
    double left = 0;
    double right = 0;
    double margin = 0;  ///< distance to the limit, negative when the rule fails; NaN for == and !=
    bool holds = false;
  };

  /// Makes an empty rule.
  RuleExpression() = default;
  /// Parses `text`.  Returns std::nullopt if it is not a rule; `problem` then has the reason.
  static std::optional<RuleExpression> parse(std::string_view text, const RuleNames& names, RuleProblem& problem);

  const std::string& text() const { return text_; }
  Comparison comparison() const { return comparison_; }
  /// Returns the figures that the rule names, each once, in the order of the text.
  const std::vector<Figure>& figures() const { return figures_; }
  /// Evaluates the rule.  `values`: the values of figures(), in the same order.  A rule fails when one of them is NaN,
  /// or when a side is not finite although its figures are, after a division by 0.
  Outcome evaluate(std::span<const double> values) const;

 private:
  friend class RuleParser;

  /// Operation of a stack machine.
  struct Step {
    enum class Kind { number, figure, negate, add, subtract, multiply, divide };
    Kind kind = Kind::number;
    double number = 0;
    std::size_t figure = 0;  ///< index into figures_
  };

  static double calculate(const std::vector<Step>& steps, std::span<const double> values);

  std::string text_;
  Comparison comparison_ = Comparison::less;
  std::vector<Figure> figures_;
  std::vector<Step> left_, right_;
};

}  // namespace sim
