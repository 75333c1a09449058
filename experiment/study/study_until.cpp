// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_until.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiment/study/study_results.hpp"
#include "experiment/study/study_rules.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

}  // namespace

StudyUntil parse_until(const std::string& text, const std::vector<std::string>& figures) {
  const auto wrong = [&](const std::string& rule) {
    return std::invalid_argument("'until' " + rule + ", got '" + sim::shortened(sim::printable(text)) + "'");
  };
  const auto form = [&] { return wrong("must have the form 'ci(METRIC.FIGURE) < 5 %'"); };
  StudyUntil until;
  until.text = sim::printable(text);
  // Left side: ci or ci(FIGURE).
  const std::size_t less = text.find('<');
  if (less == std::string::npos) throw form();
  std::string_view left = trimmed(std::string_view(text).substr(0, less));
  if (!left.starts_with("ci")) throw form();
  left = trimmed(left.substr(2));
  if (!left.empty()) {
    if (left.size() < 3 || left.front() != '(' || left.back() != ')') throw form();
    until.figure = trimmed(left.substr(1, left.size() - 2));
    if (until.figure.empty()) throw form();
  } else {
    const auto first =
        std::find_if(figures.begin(), figures.end(), [](const auto& each) { return each != passed_figure; });
    if (first == figures.end()) throw wrong("needs a figure, such as 'ci(METRIC.FIGURE) < 5 %', or one in 'figures'");
    until.figure = *first;
  }
  // Right side: a number, perhaps a percentage.
  std::string_view right = trimmed(std::string_view(text).substr(less + 1));
  until.relative = right.ends_with('%');
  if (until.relative) right = trimmed(right.substr(0, right.size() - 1));
  const std::optional<double> bound = sim::exact_number<double>(right);
  if (!bound) throw form();
  until.bound = *bound;
  if (!(until.bound > 0) || !std::isfinite(until.bound)) throw wrong("must have a bound > 0");
  if (until.relative && until.figure == passed_figure)
    throw wrong("of the share that passed must have a bound without %, such as 'ci(passed) < 0.1'");
  if (until.relative) until.bound /= 100;
  return until;
}

std::optional<StudyUntil> read_until(sim::ParamReader& in, const std::vector<std::string>& figures) {
  std::string text;
  std::int64_t batch = 10;
  in.read("until", text,
          "ends the study when half the 95 % interval of a mean is small in every case and at every point: "
          "ci(METRIC.FIGURE) < 5 %, or < 0.1 in its unit");
  in.read("batch", batch, sim::between(2, 10000), "seeds after which `until` is evaluated");
  if (in.describing() || !in.has("until")) {
    if (in.has("batch")) in.error("batch", "'batch' needs 'until'");
    return std::nullopt;
  }
  try {
    StudyUntil until = parse_until(text, figures);
    until.batch = static_cast<std::size_t>(batch);
    until.place = in.child("until")->place;
    return until;
  } catch (const std::invalid_argument& error) {
    in.error("until", error.what());
    return std::nullopt;
  }
}

bool is_certain(const StudyUntil& until, const std::vector<double>& values) {
  if (values.size() < 2) return false;
  if (std::any_of(values.begin(), values.end(), [](double value) { return !std::isfinite(value); })) return false;
  const Statistics statistics = statistics_of_figure(until.figure, values);
  const double half = (statistics.mean_95.high - statistics.mean_95.low) / 2;
  return half < until.bound * (until.relative ? std::fabs(statistics.mean) : 1);
}

}  // namespace experiment
