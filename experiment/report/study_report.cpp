// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "experiment/files/html.hpp"
#include "experiment/files/json_reader.hpp"
#include "experiment/report/report_figures.hpp"
#include "experiment/report/report_page.hpp"

namespace experiment {

namespace {

/// Figure that is 1 when the rules of the world hold.
constexpr const char* passed_figure = "passed";
constexpr std::size_t max_figures_in_words = 6;

Judgement judgement_in(const JsonReader& in, const std::vector<RunRecord::Rule>& rules) {
  if (in.at("passed").is_null()) return Judgement::not_judged;
  // Older versions recorded a study without rules as passed.
  if (in.boolean("passed") && rules.empty()) return Judgement::not_judged;
  return judgement_of(in.boolean("passed"));
}

std::vector<std::string> texts_of(const JsonReader& in, const char* key) {
  std::vector<std::string> texts;
  for (const auto& item : in.list(key)) {
    if (!item.is_string())
      throw std::runtime_error(in.where() + ": '" + key + "' must be a list of texts, got " + shown_json(item));
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

/// Statistics of one figure of one case; each may be null.
struct CaseFigure {
  std::optional<double> count, mean, std, min, max, median, low_95, high_95;
};

std::optional<double> number_at(const JsonReader& in, const char* key) {
  if (!in.has(key) || in.at(key).is_null()) return std::nullopt;
  return in.number(key);
}

struct StudyCaseRecord {
  std::string name;
  std::vector<std::string> sets;
  std::map<std::string, CaseFigure> figures;
};

std::vector<StudyCaseRecord> cases_of(const JsonReader& in) {
  std::vector<StudyCaseRecord> cases;
  for (const auto& item : in.list("cases")) {
    const JsonReader of_case(item, in.where() + ": cases");
    StudyCaseRecord& record = cases.emplace_back();
    record.name = of_case.text("name");
    record.sets = texts_of(of_case, "set");
    for (const auto& [name, value] : of_case.object("figures").items()) {
      const JsonReader cells(value, in.where() + ": cases: figures");
      record.figures[name] = {number_at(cells, "count"),       number_at(cells, "mean"),
                              number_at(cells, "std"),         number_at(cells, "min"),
                              number_at(cells, "max"),         number_at(cells, "median"),
                              number_at(cells, "mean_low_95"), number_at(cells, "mean_high_95")};
    }
  }
  return cases;
}

/// Returns the figures of all cases, except the verdict of the runs.
std::vector<std::string> all_figures(const std::vector<StudyCaseRecord>& cases) {
  std::set<std::string> names;
  for (const StudyCaseRecord& each : cases)
    for (const auto& [name, figure] : each.figures)
      if (name != passed_figure) names.insert(name);
  return {names.begin(), names.end()};
}

std::string figures_html(const JsonReader& in, const std::vector<StudyCaseRecord>& cases) {
  FigureColumns columns({"runs", "mean", "mean, 95 % interval", "std", "min", "max", "median"}, all_figures(cases));
  auto seeds = static_cast<double>(in.list("seeds").size());
  // A study with factors has runs at each of its points.
  if (in.has("points") && !cases.empty())
    seeds *= static_cast<double>(std::max<std::size_t>(1, in.list("points").size() / cases.size()));
  for (const std::string& name : texts_of(in, "figures"))
    for (const StudyCaseRecord& each : cases) {
      const auto found = each.figures.find(name);
      if (name == passed_figure || found == each.figures.end()) continue;
      const CaseFigure& f = found->second;
      FigureColumns::Row row{name, each.name, {}, f.min == 0.0 && f.max == 0.0 && f.count == seeds};
      // A mean over the runs with the figure is not representative when others lack it.
      row.values.push_back(figure_text(f.count) + (f.count == seeds ? "" : " of " + figure_text(seeds)));
      row.values.push_back(figure_text(f.mean));
      row.values.push_back(f.low_95 && f.high_95 ? figure_text(f.low_95) + " to " + figure_text(f.high_95) : "none");
      for (const auto& value : {f.std, f.min, f.max, f.median}) row.values.push_back(figure_text(value));
      columns.add(std::move(row));
    }
  return columns.html();
}

/// Number of runs of a case in which the rules of their own world hold.
std::string passed_text(const StudyCaseRecord& record) {
  const auto found = record.figures.find(passed_figure);
  if (found == record.figures.end() || !found->second.mean || !found->second.count) return "not judged";
  return fmt::format("{:.0f} of {:.0f}", *found->second.mean * *found->second.count, *found->second.count);
}

std::string cases_html(const std::vector<StudyCaseRecord>& cases) {
  std::string html =
      "<h2>Cases</h2>\n<div class=\"wide\"><table class=\"facts\">\n<thead><tr><th>case</th><th>runs passed</th>"
      "<th>settings</th></tr></thead>\n<tbody>\n";
  for (const StudyCaseRecord& each : cases) {
    std::string settings;
    for (const std::string& set : each.sets) settings += (settings.empty() ? "" : "<br>") + html_text(set);
    html += "<tr><th scope=\"row\">" + html_text(each.name) + "</th><td>" + html_text(passed_text(each)) + "</td><td>" +
            (settings.empty() ? "the world as it is" : settings) + "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::vector<RunRecord::Rule> rules_of(const JsonReader& in) {
  std::vector<RunRecord::Rule> rules;
  for (const auto& item : in.list("rules")) {
    const JsonReader rule(item, in.where() + ": rules");
    rules.push_back({rule.text("rule"), rule.boolean("passed"), rule.has("result") ? rule.text("result") : ""});
  }
  return rules;
}

/// Returns the figures to describe in words: those of the rules, else the first ones.
std::vector<std::string> main_figures(const JsonReader& in, const std::vector<RunRecord::Rule>& rules) {
  std::vector<std::string> ruled, first;
  for (const std::string& name : texts_of(in, "figures")) {
    if (name == passed_figure) continue;
    const bool in_a_rule = std::any_of(rules.begin(), rules.end(), [&](const RunRecord::Rule& rule) {
      return rule.rule.find(name) != std::string::npos;
    });
    if (in_a_rule) ruled.push_back(name);
    first.push_back(name);
  }
  std::vector<std::string>& chosen = ruled.empty() ? first : ruled;
  chosen.resize(std::min(chosen.size(), max_figures_in_words));
  return chosen;
}

/// `cooperative.rms_m: 0.91 m (two_craft), 61.2 m (alone); means of 20 runs, standard deviation 0.11 and 8.2`.
std::vector<std::string> findings(const std::vector<std::string>& names, const std::vector<StudyCaseRecord>& cases) {
  const std::map<std::string, std::string> units = units_of(all_figures(cases));
  std::vector<std::string> sentences;
  for (const std::string& name : names) {
    const auto known = units.find(name);
    const std::string unit = known == units.end() ? "" : " " + known->second;
    // Mean and deviation by case.
    std::string text;
    for (const StudyCaseRecord& each : cases) {
      const auto found = each.figures.find(name);
      if (found == each.figures.end()) continue;
      const CaseFigure& f = found->second;
      text += text.empty() ? "" : "; ";
      if (cases.size() > 1) text += each.name + " ";
      text += f.mean ? figure_text(f.mean) + (f.std ? " ± " + figure_text(f.std) : "") + unit : "none";
    }
    sentences.push_back(name + ": " + text);
  }
  return sentences;
}

std::string failed_runs_html(const JsonReader& in) {
  if (in.list("failed_runs").empty()) return {};
  std::vector<std::string> runs;
  for (const auto& item : in.list("failed_runs")) {
    const JsonReader run(item, in.where() + ": failed_runs");
    runs.push_back(fmt::format("{}, seed {}: {}", run.text("case"), run.whole("seed"), run.text("why")));
    if (run.has("repeat")) runs.back() += "; to repeat it: " + run.text("repeat");
  }
  return "<h2>Runs without a result</h2>\n" + list_html(runs);
}

std::string outcome_html(const JsonReader& in, const std::vector<StudyCaseRecord>& cases) {
  const std::vector<RunRecord::Rule> rules = rules_of(in);
  const auto failed_runs = in.list("failed_runs").size();
  const Judgement judgement = judgement_in(in, rules);
  std::string text = judgement_html(judgement, judgement == Judgement::not_judged ? "the study has no rules" : "") +
                     " " + html_text(rules_in_words(rules));
  if (failed_runs > 0) text += html_text(fmt::format(" {} runs have no result.", failed_runs));
  std::vector<std::string> words;
  for (const StudyCaseRecord& each : cases)
    if (const std::string passed = passed_text(each); passed != "not judged")
      words.push_back((cases.size() > 1 ? each.name + ": " : "") + passed + " runs hold the rules of their world.");
  const std::vector<std::string> found = findings(main_figures(in, rules), cases);
  std::string html = verdict_box(judgement, "<p>" + text + "</p>\n" + rules_html(rules)) + list_html(words);
  if (in.has("until") && !in.at("until").is_null())
    html += "<p>" + html_text(JsonReader(in.at("until"), in.where() + ": until").text("text")) + ".</p>\n";
  // Missing in files of older versions.
  if (in.has("notes"))
    for (const std::string& note : texts_of(in, "notes")) html += "<p>Note: " + html_text(note) + ".</p>\n";
  if (!found.empty()) html += "<p>Mean and standard deviation over the runs:</p>\n" + list_html(found);
  return html;
}

std::string seeds_text(const JsonReader& in) {
  const auto& seeds = in.list("seeds");
  for (const auto& seed : seeds)
    if (!seed.is_number_integer())
      throw std::runtime_error(in.where() + ": 'seeds' must be whole numbers, got " + seed.type_name());
  if (seeds.size() <= 8) {
    std::string text;
    for (const auto& seed : seeds) text += (text.empty() ? "" : ", ") + seed.dump();
    return text;
  }
  return fmt::format("{} seeds from {} to {}", seeds.size(), seeds.front().dump(), seeds.back().dump());
}

}  // namespace

std::string study_report(const std::string& directory) {
  const std::string path = directory + "/study.json";
  const auto json = read_json_file(path);
  const JsonReader in(json, path);
  const std::vector<StudyCaseRecord> cases = cases_of(in);
  const std::string title = in.text("study"), description = in.text("description");
  std::string body = "<h1>" + html_text(title) + "</h1>\n";
  if (!description.empty()) body += "<p>" + html_text(description) + "</p>\n";
  body += outcome_html(in, cases) + study_algorithms_html(in) + plots_html(directory, texts_of(in, "plots"), {}) +
          failed_runs_html(in) + study_charts_html(in, units_of(all_figures(cases))) + figures_html(in, cases) +
          study_comparisons_html(in) + study_extremes_html(in, directory) + cases_html(cases) +
          "<h2>This study</h2>\n" +
          facts_table({{"World", in.text("world")},
                       {"Runs", fmt::format("{}", in.whole("runs"))},
                       {"Seeds", seeds_text(in)},
                       {"Shoal", in.text("shoal")}});
  return html_page(title, body + made_by_html());
}

}  // namespace experiment
