// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/report_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "experiment/files/html.hpp"
#include "experiment/report/report_figures.hpp"
#include "experiment/run/version.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

/// Number of lines from the end of a program's log that the page shows.
constexpr std::size_t log_lines = 30;
constexpr std::size_t max_log_bytes = 20000;
/// Interval without estimates beyond which a score is misleading.
constexpr double long_gap_s = 30;

std::string paragraph(const std::string& html, const char* look = "") {
  return "<p" + (*look != '\0' ? " class=\"" + std::string(look) + "\"" : "") + ">" + html + "</p>\n";
}

std::string heading(const std::string& text) {
  return "<h2>" + html_text(text) + "</h2>\n";
}

std::string title_of(const RunRecord& run) {
  return run.world.empty() ? "A run" : run.world;
}

/// Returns the reasons of a failed run besides the rules; empty: none.
std::string why_not_passed(const RunRecord& run) {
  if (!run.error.empty()) return run.error;
  if (run.ended == "signal") return fmt::format("It was stopped by a signal after {:.2f} s.", run.sim_time_s);
  const bool by_rule = run.exit_code <= 1 && (!run.rules.empty() || run.event);
  return by_rule ? "" : fmt::format("Exit code {}.", run.exit_code);
}

std::string verdicts_html(const RunRecord& run) {
  const Judgement judgement = run.judgement;
  std::string line = judgement_html(judgement, run.not_judged) + " ";
  if (judgement == Judgement::failed) line += html_text(why_not_passed(run)) + " ";
  std::string html = paragraph(line + html_text(rules_in_words(run.rules)));
  if (run.event)
    html += paragraph(verdict_html(run.event->passed) + ": ended by an event: " + html_text(run.event->rule));
  return html + rules_html(run.rules);
}

std::string facts_html(const RunRecord& run) {
  const double speed = run.wall_s > 0 ? run.sim_time_s / run.wall_s : 0;
  std::vector<std::pair<std::string, std::string>> facts{
      {"Seed", fmt::format("{}", run.seed)},
      {"Simulated", fmt::format("{:.2f} s, {} steps", run.sim_time_s, run.steps)},
      {"Computed in", fmt::format("{:.2f} s, {:.1f} times real time", run.wall_s, speed)},
      {"Ended by", run.ended},
      {"Exit code", fmt::format("{}", run.exit_code)},
      {"Messages", fmt::format("{}", run.messages)}};
  if (!run.run_hash.empty()) facts.emplace_back("Run hash", run.run_hash);
  facts.emplace_back("State hash", run.state_hash);
  facts.emplace_back("Shoal", run.version.empty() ? "of an unknown version" : run.version);
  return heading("This run") + facts_table(facts);
}

std::string tail_of(const std::string& text) {
  std::size_t from = text.size() > max_log_bytes ? text.size() - max_log_bytes : 0;
  std::size_t lines = 0;
  for (std::size_t at = text.size(); at > from; --at)
    if (text[at - 1] == '\n' && at != text.size() && ++lines == log_lines) from = at;
  return text.substr(from);
}

std::string processes_html(const RunRecord& run) {
  std::string html;
  for (const RunRecord::Process& process : run.processes)
    html +=
        "<li>" + html_text(fmt::format("{} {} at {:.2f} s", process.name, process.how, process.sim_time_s)) + "</li>\n";
  if (!html.empty()) html = "<p>Ended before the run did:</p>\n<ul>\n" + html + "</ul>\n";
  std::set<fs::path> logs;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(run.directory, error))
    // plot.log is that of gnuplot, not of a program.
    if (entry.path().extension() == ".log" && entry.path().filename() != "plot.log") logs.insert(entry.path());
  for (const fs::path& log : logs) {
    std::string text;
    try {
      text = read_whole_file(log.string());
    } catch (const std::runtime_error& problem) {
      text = problem.what();
    }
    if (text.empty()) continue;
    html += html_details("End of " + log.filename().string(), "<pre>" + html_text(tail_of(text)) + "</pre>");
  }
  return html.empty() ? "" : heading("Programs") + html;
}

/// Messages that shadows took.
std::string shadows_html(const RunRecord& run) {
  if (run.shadowed.empty()) return "";
  std::vector<std::pair<std::string, std::string>> rows;
  for (const RunRecord::Shadowed& loss : run.shadowed)
    rows.emplace_back(fmt::format("{:.3f} s", loss.sent_s),
                      fmt::format("{} to {}, {:.0f} m", loss.from, loss.to, loss.range_m));
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(run.shadowed_count, std::ssize(rows)));
  const std::string title =
      count > rows.size() ? fmt::format("The first {} of {}", rows.size(), count) : fmt::format("All {}", count);
  return heading("Packets in shadows") +
         paragraph("No ray without a bounce reached these addressees, and echoes were too weak.") +
         html_details(title, facts_table(rows));
}

std::string warnings_html(const RunRecord& run) {
  std::vector<std::string> warnings;
  const auto warn = [&](std::int64_t count, const char* what) {
    if (count > 0) warnings.push_back(fmt::format("{} {}", count, what));
  };
  warn(run.dropped_messages, "messages were lost in full queues or refused by LCM.");
  warn(run.modem_dropped_messages, "messages were dropped from full queues of modems.");
  warn(run.bad_messages, "messages were received and not usable.");
  warn(run.quick_steps,
       "steps used QuickStep, for islands of bodies that are too large or that ODE's exact solver gave up.");
  const auto failed = [](const RunRecord::Process& process) { return process.failed; };
  // A run that was judged lists them among its failed rules.
  if (run.judgement == Judgement::not_judged && std::any_of(run.processes.begin(), run.processes.end(), failed))
    warnings.emplace_back("Programs of the world failed.");
  for (const auto& [name, value] : run.metrics)
    if (name.ends_with(".max_gap_s") && value.value_or(0) > long_gap_s)
      warnings.push_back(fmt::format("For {:.1f} s there was no estimate: {}.", *value, name));
  for (const auto& [name, value] : run.metrics)
    if (!value && (name.ends_with(".rms_m") || name.ends_with(".nees_mean")))
      warnings.push_back("No estimate was compared with the truth: there is no " + name + ".");
  if (run.ended != "duration" && run.ended != "event") warnings.push_back("The run ended early: " + run.ended + ".");
  return warnings.empty() ? "" : heading("Warnings") + list_html(warnings);
}

}  // namespace

std::string verdict_html(bool passed) {
  return judgement_html(judgement_of(passed));
}

std::string judgement_html(Judgement judgement, const std::string& why) {
  const char* look = judgement == Judgement::passed ? "good" : judgement == Judgement::failed ? "bad" : "open";
  return "<span class=\"" + std::string(look) + "\">" + judgement_word(judgement) + "</span>" +
         (why.empty() ? "" : ": " + html_text(why) + ".");
}

std::string rules_html(const std::vector<RunRecord::Rule>& rules) {
  std::string failed, held;
  std::size_t count = 0;
  for (const RunRecord::Rule& rule : rules) {
    (rule.passed ? held : failed) += "<li>" + verdict_html(rule.passed) + " " + html_text(rule.rule) +
                                     (rule.result.empty() ? "" : html_text(" (" + rule.result + ")")) + "</li>\n";
    count += rule.passed ? 1 : 0;
  }
  std::string html;
  if (!failed.empty()) html += "<ul class=\"rules\">\n" + failed + "</ul>\n";
  // Rules that hold are folded: failed ones are what a reader looks for.
  if (!held.empty())
    html += html_details(count == 1 ? "The rule that holds" : fmt::format("The {} rules that hold", count),
                         "<ul class=\"rules\">\n" + held + "</ul>\n");
  return html;
}

std::string list_html(const std::vector<std::string>& texts) {
  std::string html;
  for (const std::string& text : texts) html += "<li>" + html_text(text) + "</li>\n";
  return html.empty() ? "" : "<ul>\n" + html + "</ul>\n";
}

std::string facts_table(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string html = "<table class=\"facts\">\n<tbody>\n";
  for (const auto& [name, value] : facts)
    html += "<tr><th scope=\"row\">" + html_text(name) + "</th><td>" + html_text(value) + "</td></tr>\n";
  return html + "</tbody></table>\n";
}

std::string verdict_box(Judgement judgement, const std::string& html) {
  const char* look = judgement == Judgement::passed ? " is-good" : judgement == Judgement::failed ? " is-bad" : "";
  return "<div class=\"verdict" + std::string(look) + "\">\n" + html + "</div>\n";
}

std::string outcome_html(const RunRecord& run, const std::vector<RunMetric>& metrics) {
  std::vector<std::string> words = findings_in_words(metrics);
  for (std::string& contact : contacts_in_words(run)) words.push_back(std::move(contact));
  if (metrics.empty() && words.empty()) words.emplace_back("The world has no metrics: nothing was measured.");
  return verdict_box(run.judgement, verdicts_html(run)) + list_html(words);
}

std::string made_by_html() {
  return paragraph(html_text("Made by shoal " + short_version() + "."), "soft small");
}

std::string run_report(const RunRecord& run, const std::string& page_in_3d) {
  const std::vector<RunMetric> metrics = metrics_of(run);
  const std::string link =
      page_in_3d.empty() ? ""
                         : paragraph("<a href=\"" + html_text(page_in_3d) + "\">Watch the run in three dimensions</a>");
  return html_page(title_of(run), "<h1>" + html_text(title_of(run)) + "</h1>\n" +
                                      (run.description.empty() ? "" : paragraph(html_text(run.description))) +
                                      outcome_html(run, metrics) + link + run_plots_html(run) + warnings_html(run) +
                                      figures_html(metrics, run.rules) + shadows_html(run) + processes_html(run) +
                                      facts_html(run) + made_by_html());
}

std::string report_page(const std::vector<std::string>& directories, const std::string& page_in_3d) {
  std::vector<RunRecord> runs;
  for (const std::string& given : directories) {
    std::string directory = given;
    while (directory.size() > 1 && directory.back() == '/') directory.pop_back();
    std::error_code error;
    if (!fs::is_directory(directory, error)) throw std::runtime_error(given + ": is not a folder");
    const bool study = fs::exists(directory + "/study.json", error);
    if (study && directories.size() > 1)
      throw std::runtime_error(given + ": is a study, which cannot be compared with other folders");
    if (study) return study_report(directory);
    if (!fs::exists(directory + "/summary.json", error))
      throw std::runtime_error(given + ": is not a results folder: it has neither summary.json nor study.json");
    runs.push_back(read_run(directory));
  }
  return runs.size() == 1 ? run_report(runs.front(), page_in_3d) : comparison_report(runs);
}

}  // namespace experiment
