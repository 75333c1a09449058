#include "tools/experiment/study_report.hpp"

#include <spdlog/fmt/fmt.h>

#include "tools/experiment/html.hpp"
#include "tools/experiment/json_reader.hpp"
#include "tools/experiment/report_page.hpp"

namespace tools {

namespace {

std::vector<std::string> texts_of(const JsonReader& in, const char* key) {
  std::vector<std::string> texts;
  for (const auto& item : in.list(key)) {
    if (!item.is_string())
      throw std::runtime_error(in.where() + ": '" + key + "' must be a list of texts, got " + item.type_name());
    texts.push_back(item.get<std::string>());
  }
  return texts;
}

std::string number_at(const JsonReader& in, const char* key) {
  if (in.at(key).is_null()) return "-";
  return figure_text(in.number(key));
}

std::string table_html(const JsonReader& in) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& figure : texts_of(in, "figures"))
    for (const auto& item : in.list("cases")) {
      const JsonReader of_case(item, in.where() + ": cases");
      const auto& figures = of_case.object("figures");
      std::vector<std::string>& row = rows.emplace_back(std::vector<std::string>{figure, of_case.text("name")});
      if (!figures.contains(figure)) continue;
      const JsonReader cells(figures.at(figure), in.where() + ": cases: figures");
      for (const char* key : {"count", "mean", "std", "min", "max", "median"}) row.push_back(number_at(cells, key));
      if (cells.has("mean_low_95") && !cells.at("mean_low_95").is_null())  // not in files of older versions
        row.push_back(number_at(cells, "mean_low_95") + " to " + number_at(cells, "mean_high_95"));
      else
        row.emplace_back("-");
    }
  return "<h2>Figures</h2>\n" +
         html_table({"figure", "case", "runs", "mean", "std", "min", "max", "median", "mean, 95 % interval"}, rows);
}

std::string cases_html(const JsonReader& in) {
  std::string html = "<h2>Cases</h2>\n<ul>\n";
  for (const auto& item : in.list("cases")) {
    const JsonReader of_case(item, in.where() + ": cases");
    std::string text = of_case.text("name") + ":";
    for (const std::string& set : texts_of(of_case, "set")) text += " " + set;
    html += "<li>" + html_text(text + (text.back() == ':' ? " the world as it is" : "")) + "</li>\n";
  }
  return html + "</ul>\n";
}

/// Older versions wrote that a study without rules had passed.
Judgement judgement_in(const JsonReader& in, bool no_rules) {
  if (in.at("passed").is_null() || (no_rules && in.boolean("passed"))) return Judgement::not_judged;
  return judgement_of(in.boolean("passed"));
}

std::string verdicts_html(const JsonReader& in) {
  std::vector<RunRecord::Rule> rules;
  for (const auto& item : in.list("rules")) {
    const JsonReader rule(item, in.where() + ": rules");
    rules.push_back({rule.text("rule"), rule.boolean("passed")});
  }
  const Judgement judgement = judgement_in(in, rules.empty());
  const bool judged = judgement != Judgement::not_judged;
  std::string html = "<p>" + verdict_html(judgement) + (judged ? "" : ": the study has no rules") + "</p>\n";
  if (!rules.empty()) html += rules_html(rules);
  if (in.list("failed_runs").empty()) return html;
  html += "<h2>Runs without a result</h2>\n<ul>\n";
  for (const auto& item : in.list("failed_runs")) {
    const JsonReader run(item, in.where() + ": failed_runs");
    html += "<li>" + html_text(fmt::format("{}, seed {}: {}", run.text("case"), run.whole("seed"), run.text("why"))) +
            "</li>\n";
  }
  return html + "</ul>\n";
}

std::string seeds_text(const JsonReader& in) {
  const auto& seeds = in.list("seeds");
  for (const auto& seed : seeds)
    if (!seed.is_number_integer())
      throw std::runtime_error(in.where() + ": 'seeds' must be whole numbers, got " + seed.type_name());
  if (seeds.size() <= 8) return "Seeds " + seeds.dump();
  return fmt::format("{} seeds, from {} to {}", seeds.size(), seeds.front().dump(), seeds.back().dump());
}

}  // namespace

std::string study_report(const std::string& directory) {
  const std::string path = directory + "/study.json";
  const auto json = read_json_file(path);
  const JsonReader in(json, path);
  std::string body = "<h1>" + html_text(in.text("study")) + "</h1>\n" + verdicts_html(in);
  if (const std::string text = in.text("description"); !text.empty()) body += "<p>" + html_text(text) + "</p>\n";
  body += "<p class=\"soft\">" +
          html_text(fmt::format("{} runs of the world {}. {}. Shoal {}.", in.whole("runs"), in.text("world"),
                                seeds_text(in), in.text("shoal"))) +
          "</p>\n";
  return html_page(in.text("study"),
                   body + table_html(in) + pictures_html(directory, texts_of(in, "pictures")) + cases_html(in));
}

}  // namespace tools
