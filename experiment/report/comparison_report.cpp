// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <set>

#include "experiment/files/html.hpp"
#include "experiment/report/report_figures.hpp"
#include "experiment/report/report_page.hpp"

namespace experiment {

namespace {

/// Facts that every run has.
std::string overview(const std::vector<RunRecord>& runs) {
  std::vector<std::string> head{"run"};
  std::vector<std::vector<std::string>> rows{{"verdict"},      {"world"},    {"seed"},
                                             {"simulated, s"}, {"run hash"}, {"state hash"}};
  for (const RunRecord& run : runs) {
    head.push_back(run.directory);
    const std::string cells[] = {judgement_word(run.judgement),         run.world,    fmt::format("{}", run.seed),
                                 fmt::format("{:.2f}", run.sim_time_s), run.run_hash, run.state_hash};
    for (std::size_t i = 0; i < std::size(cells); ++i) rows[i].push_back(cells[i]);
  }
  // Older runs have no run hash.
  std::erase_if(rows, [](const auto& row) {
    return std::all_of(row.begin() + 1, row.end(), [](const std::string& cell) { return cell.empty(); });
  });
  return html_table(head, rows);
}

std::string figures_of(const std::vector<RunRecord>& runs) {
  std::set<std::string> names;
  std::vector<std::string> head;
  for (const RunRecord& run : runs) {
    head.push_back(run.directory);
    for (const auto& [name, value] : run.metrics) names.insert(name);
  }
  FigureColumns columns(head, {names.begin(), names.end()});
  for (const std::string& name : names) {
    FigureColumns::Row row{name, "", {}, true};
    for (const RunRecord& run : runs) {
      const auto found = run.metrics.find(name);
      const bool has = found != run.metrics.end();
      row.values.push_back(has ? figure_text(found->second) : "");
      row.idle = row.idle && (!has || found->second == 0.0);
    }
    columns.add(std::move(row));
  }
  return columns.html();
}

}  // namespace

std::string comparison_report(const std::vector<RunRecord>& runs) {
  const std::string title = fmt::format("{} runs", runs.size());
  std::string body = "<h1>" + html_text(title) + "</h1>\n" + overview(runs);
  for (const RunRecord& run : runs)
    body += "<h2>" + html_text(run.directory) + "</h2>\n" + outcome_html(run, metrics_of(run)) + run_plots_html(run);
  return html_page(title, body + figures_of(runs) + made_by_html());
}

}  // namespace experiment
