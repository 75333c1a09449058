// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include "experiment/files/html.hpp"
#include "experiment/report/report_page.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "sim/world_file/metric_registry.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace report_pages {

inline void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A run of a small world, whose results are left in a folder.
inline experiment::Summary run_into(const std::string& directory, const std::string& more,
                                    const std::string& name = "small") {
  auto loaded = sim::load_world_text(
      test::rover_world("        - {name: lidar, type: lidar}\n", "", "", "run: {duration_s: 0.2, seed: 7}\n" + more),
      "small.yaml");
  loaded.config.name = name;
  experiment::RunOptions options;
  options.bus = "none";
  options.quiet = true;
  options.results = directory;
  return experiment::run_world(loaded, options);
}

/// Python's parser reads the page: every element that opens closes, and nothing refers to another place.  Empty, or
/// what is wrong.
inline std::string problems_of_page(const std::string& page) {
  const test_support::ScratchFolder folder;
  write(folder.file("page.html"), page);
  write(folder.file("check.py"), R"(
import html.parser, sys
VOID = {"meta", "img", "br"}
class Checker(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.problems, self.images = [], [], 0
    def handle_starttag(self, tag, attributes):
        if tag not in VOID: self.open.append(tag)
        if tag in ("script", "link", "iframe", "object", "a"): self.problems.append("has a " + tag)
        for key, value in attributes:
            if key.startswith("on"): self.problems.append("has " + key)
            if key in ("src", "href") and not value.startswith("data:"): self.problems.append(key + " is " + value)
        self.images += tag == "img"
    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag: self.problems.append("stray end of " + tag)
text = open(sys.argv[1], encoding="utf-8").read()
checker = Checker()
checker.feed(text)
checker.close()
checker.problems += ["never closed: " + tag for tag in checker.open]
if "://" in text or "url(" in text: checker.problems.append("refers to another place")
print("; ".join(checker.problems), end="")
)");
  const std::string command =
      "/usr/bin/python3 -B " + folder.file("check.py") + " " + folder.file("page.html") + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string reported;
  char block[4096];
  for (std::size_t size = 0; (size = fread(block, 1, sizeof block, pipe)) > 0;) reported.append(block, size);
  if (pclose(pipe) != 0) reported += " (python failed)";
  return reported;
}

/// A results folder of the figures alone, with the world that they are of.
inline std::string folder_of(const test_support::ScratchFolder& scratch, const std::map<std::string, double>& metrics,
                             const std::string& world) {
  const std::string directory = scratch.file("figures");
  experiment::Summary summary;
  summary.world = "sea";
  summary.metrics = metrics;
  experiment::write_summary(directory, summary);
  write(directory + "/world.yaml", world);
  return directory;
}

inline constexpr const char* sea_metrics =
    "metrics:\n"
    "  - {name: cooperative, type: position_error, vehicle: auv, channel: auv.estimate}\n"
    "  - {name: alone, type: position_error, vehicle: auv, channel: auv.dead_reckoning}\n"
    "  - {name: link, type: delivery, vehicle: auv}\n";

inline std::map<std::string, double> sea_figures() {
  std::map<std::string, double> figures;
  const auto error = [&](const std::string& name, double rms_m, double final_m, double percent) {
    figures[name + ".rms_m"] = rms_m, figures[name + ".final_m"] = final_m, figures[name + ".max_m"] = 2 * final_m;
    figures[name + ".samples"] = 1951, figures[name + ".max_gap_s"] = 1;
    figures[name + ".per_distance_percent"] = percent;
  };
  error("cooperative", 0.912, 0.7, 0.025);
  error("alone", 61.25, 138, 138.0 / 28);  // per cent of 2800 m
  for (const sim::FigureKind& figure : sim::MetricRegistry::instance().find("delivery")->figures)
    figures["link." + figure.name] = 0;
  figures["link.sent"] = 130, figures["link.received"] = 75, figures["link.lost"] = figures["link.lost_noise"] = 25;
  figures["link.ratio"] = 0.75;
  return figures;
}

}  // namespace report_pages
