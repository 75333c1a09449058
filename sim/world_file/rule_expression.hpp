// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sim {

/// What is wrong with a rule, and at which character of its text, counted from 0.
struct RuleProblem {
  std::size_t at = 0;
  std::string text;
};

/// Says which figures the rules of a file may name.
class RuleNames {
 public:
  virtual ~RuleNames() = default;
  /// What is wrong with a function, the `max` of `max(NAME)`.  Empty: nothing.
  virtual std::string function_problem(const std::string& function) const = 0;
  /// What is wrong with a name, and at which of its characters.  `function` is empty where the name stands alone.
  virtual std::optional<RuleProblem> name_problem(const std::string& function, const std::string& name) const = 0;
};

/// A rule such as `cooperative.rms_m < 0.4 * alone.rms_m`: figures and numbers with + - * / and parentheses on both
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

  /// What the two sides of a rule came to.
  struct Outcome {
    double left = 0;
    double right = 0;
    double margin = 0;  ///< distance to the limit, below 0 when the rule fails; NaN for == and !=
    bool holds = false;
  };

  /// Holds nothing.
  RuleExpression() = default;
  /// Reads `text`.  Nothing when it is not a rule; `problem` then says why.
  static std::optional<RuleExpression> parse(std::string_view text, const RuleNames& names, RuleProblem& problem);

  const std::string& text() const { return text_; }
  Comparison comparison() const { return comparison_; }
  /// The figures that the rule names, each once, in the order of the text.
  const std::vector<Figure>& figures() const { return figures_; }
  /// `values` are those of figures(), in the same order.  A rule does not hold when one of them is NaN, or when a side
  /// is not finite though its figures are: a division by 0.
  Outcome evaluate(std::span<const double> values) const;

 private:
  friend class RuleParser;

  /// One step of a calculation on a stack.
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
