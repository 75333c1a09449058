#include "tools/experiment/report_page.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "tools/experiment/html.hpp"
#include "tools/experiment/png_check.hpp"
#include "tools/experiment/run_pictures.hpp"
#include "tools/experiment/runner.hpp"
#include "tools/experiment/study_report.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

/// Lines at the end of a program's log that the page shows.
constexpr std::size_t log_lines = 30;
constexpr std::size_t most_log_bytes = 20000;
/// Without an estimate for longer a score says less than it seems to.
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

std::string facts_of(const RunRecord& run) {
  const double speed = run.wall_s > 0 ? run.sim_time_s / run.wall_s : 0;
  return fmt::format(
      "Seed {}. {:.2f} s simulated in {:.2f} s, {:.1f} times real time. Shoal {}. Run hash {}, state hash {}.",
      run.seed, run.sim_time_s, run.wall_s, speed, run.version.empty() ? "of an unknown version" : run.version,
      run.run_hash.empty() ? "not told" : run.run_hash, run.state_hash);
}

std::string why_not_passed(const RunRecord& run) {
  if (!run.error.empty()) return run.error;
  if (run.ended == "signal") return "It was stopped by a signal.";
  return fmt::format("Exit code {}.", run.exit_code);
}

/// Nothing was wrong, and nothing was looked at.
bool is_unjudged(const RunRecord& run) {
  return run.passed && !run.judged;
}

std::string verdicts_html(const RunRecord& run) {
  if (is_unjudged(run)) return paragraph("Not judged: the world has no rules, or its programs took no part.");
  std::string html = paragraph(verdict_html(run.passed) + (run.passed ? "" : ": " + html_text(why_not_passed(run))));
  if (run.event)
    html += paragraph(verdict_html(run.event->passed) + ": ended by an event: " + html_text(run.event->rule));
  if (run.rules.empty()) return html + paragraph("No rules were judged.", "soft");
  return html + rules_html(run.rules);
}

std::string figures_html(const RunRecord& run) {
  if (run.metrics.empty()) return {};
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, value] : run.metrics) rows.push_back({name, figure_text(value)});
  return heading("Figures") + html_table({"figure", "value"}, rows);
}

std::string tail_of(const std::string& text) {
  std::size_t from = text.size() > most_log_bytes ? text.size() - most_log_bytes : 0;
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
    if (entry.path().extension() == ".log" && entry.path().filename() != "plot.log") logs.insert(entry.path());
  for (const fs::path& log : logs) {
    std::string text;
    try {
      text = read_whole_file(log.string());
    } catch (const std::runtime_error& problem) {
      text = problem.what();
    }
    if (text.empty()) continue;
    html += "<details><summary>" + html_text("End of " + log.filename().string()) + "</summary>\n<pre>" +
            html_text(tail_of(text)) + "</pre></details>\n";
  }
  return html.empty() ? "" : heading("Programs") + html;
}

std::string warnings_html(const RunRecord& run) {
  std::vector<std::string> warnings;
  const auto warn = [&](std::int64_t count, const char* what) {
    if (count > 0) warnings.push_back(fmt::format("{} {}", count, what));
  };
  warn(run.dropped_messages, "messages were lost in full queues or refused by LCM.");
  warn(run.modem_dropped_messages, "messages were dropped from full queues of modems.");
  warn(run.bad_messages, "messages were received and not usable.");
  warn(run.quick_steps, "steps used QuickStep, for an island of bodies was too large.");
  const auto failed = [](const RunRecord::Process& process) { return process.failed; };
  if (is_unjudged(run) && std::any_of(run.processes.begin(), run.processes.end(), failed))
    warnings.emplace_back("Programs of the world failed.");
  for (const auto& [name, value] : run.metrics)
    if (name.ends_with(".longest_gap_s") && value.value_or(0) > long_gap_s)
      warnings.push_back(fmt::format("For {:.1f} s there was no estimate: {}.", *value, name));
  for (const auto& [name, value] : run.metrics)
    if (!value && (name.ends_with(".rms_m") || name.ends_with(".nees_mean")))
      warnings.push_back("There was no estimate to make " + name + " of.");
  if (run.ended != "duration" && run.ended != "event") warnings.push_back("The run ended early: " + run.ended + ".");
  if (warnings.empty()) return {};
  std::string html = heading("Warnings") + "<ul>\n";
  for (const std::string& warning : warnings) html += "<li>" + html_text(warning) + "</li>\n";
  return html + "</ul>\n";
}

std::vector<std::string> pictures_of(const RunRecord& run) {
  std::vector<std::string> files{"tracks.png"};
  const bool compared = std::any_of(run.metrics.begin(), run.metrics.end(), [](const auto& figure) {
    return figure.first.ends_with(".samples") && figure.second.value_or(0) > 0;
  });
  if (compared) files.emplace_back("errors.png");
  std::error_code error;
  for (const char* file : run_pictures)
    if (fs::exists(run.directory + "/" + file, error) && std::find(files.begin(), files.end(), file) == files.end())
      files.emplace_back(file);
  return files;
}

std::string made_by() {
  return paragraph(html_text("Made by shoal " + short_version() + "."), "soft");
}

}  // namespace

std::string figure_text(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.6g}", *value) : "-";
}

std::string verdict_html(bool passed) {
  return passed ? "<span class=\"good\">passed</span>" : "<span class=\"bad\">FAILED</span>";
}

std::string rules_html(std::vector<RunRecord::Rule> rules) {
  std::stable_partition(rules.begin(), rules.end(), [](const RunRecord::Rule& rule) { return !rule.passed; });
  std::string html = "<ul class=\"rules\">\n";
  for (const RunRecord::Rule& rule : rules)
    html += "<li>" + verdict_html(rule.passed) + " " + html_text(rule.rule) + "</li>\n";
  return html + "</ul>\n";
}

std::string pictures_html(const std::string& directory, const std::vector<std::string>& files) {
  std::string html;
  for (const std::string& file : files) {
    std::string bytes;
    try {
      bytes = read_whole_file(directory + "/" + file);
    } catch (const std::runtime_error&) {
      html += paragraph(html_text(file + " is missing."), "soft");
      continue;
    }
    if (!is_whole_png(bytes)) {
      spdlog::warn("{}/{}: is no whole PNG picture; the page goes without it", directory, file);
      html += paragraph(html_text(file + " is no whole PNG picture."), "soft");
      continue;
    }
    html +=
        "<figure><img alt=\"" + html_text(file) + "\" src=\"data:image/png;base64," + base64(bytes) + "\"></figure>\n";
  }
  return html.empty() ? "" : heading("Pictures") + html;
}

std::string run_report(const RunRecord& run) {
  return html_page(title_of(run), "<h1>" + html_text(title_of(run)) + "</h1>\n" +
                                      (run.description.empty() ? "" : paragraph(html_text(run.description))) +
                                      verdicts_html(run) + paragraph(html_text(facts_of(run)), "soft") +
                                      warnings_html(run) + figures_html(run) +
                                      pictures_html(run.directory, pictures_of(run)) + processes_html(run) + made_by());
}

std::string comparison_report(const std::vector<RunRecord>& runs) {
  std::set<std::string> names;
  for (const RunRecord& run : runs)
    for (const auto& [name, value] : run.metrics) names.insert(name);
  std::vector<std::string> head{"run"};
  std::vector<std::vector<std::string>> rows{{"world"},        {"seed"},     {"verdict"},
                                             {"simulated, s"}, {"run hash"}, {"state hash"}};
  for (const RunRecord& run : runs) {
    head.push_back(run.directory);
    const std::string cells[] = {run.world,
                                 fmt::format("{}", run.seed),
                                 is_unjudged(run) ? "not judged"
                                 : run.passed     ? "passed"
                                                  : "FAILED",
                                 fmt::format("{:.2f}", run.sim_time_s),
                                 run.run_hash,
                                 run.state_hash};
    for (std::size_t i = 0; i < std::size(cells); ++i) rows[i].push_back(cells[i]);
  }
  for (const std::string& name : names) {
    std::vector<std::string>& row = rows.emplace_back(std::vector<std::string>{name});
    for (const RunRecord& run : runs) {
      const auto found = run.metrics.find(name);
      row.push_back(found == run.metrics.end() ? "" : figure_text(found->second));
    }
  }
  std::string body = "<h1>" + html_text(fmt::format("{} runs", runs.size())) + "</h1>\n" + html_table(head, rows);
  for (const RunRecord& run : runs)
    body += "<h2>" + html_text(run.directory) + "</h2>\n" + verdicts_html(run) +
            "<details><summary>Pictures</summary>\n" + pictures_html(run.directory, pictures_of(run)) + "</details>\n";
  return html_page(fmt::format("{} runs", runs.size()), body + made_by());
}

std::string report_page(const std::vector<std::string>& directories) {
  std::vector<RunRecord> runs;
  for (const std::string& given : directories) {
    std::string directory = given;
    while (directory.size() > 1 && directory.back() == '/') directory.pop_back();
    std::error_code error;
    if (!fs::is_directory(directory, error)) throw std::runtime_error(given + ": is no folder");
    const bool study = fs::exists(directory + "/study.json", error);
    if (study && directories.size() > 1)
      throw std::runtime_error(given + ": is a study, which cannot be compared with other folders");
    if (study) return study_report(directory);
    if (!fs::exists(directory + "/summary.json", error))
      throw std::runtime_error(given + ": is no results folder: it has neither summary.json nor study.json");
    runs.push_back(read_run(directory));
  }
  return runs.size() == 1 ? run_report(runs.front()) : comparison_report(runs);
}

}  // namespace tools
