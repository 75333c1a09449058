// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/report_page.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "experiment/files/html.hpp"
#include "experiment/files/png_check.hpp"
#include "experiment/run/runner.hpp"
#include "experiment/run/version.hpp"
#include "sim/world_file/metric_registry.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

using test_support::ScratchFolder;
using testing::HasSubstr;
using testing::Not;

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A run of a small world, whose results are left in a folder.
experiment::Summary run_into(const std::string& directory, const std::string& more, const std::string& name = "small") {
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

std::string error_of_report(const std::vector<std::string>& directories) {
  try {
    experiment::report_page(directories);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// Python's parser reads the page: every element that opens closes, and nothing refers to another place.  Empty, or
/// what is wrong.
std::string problems_of_page(const std::string& page) {
  const ScratchFolder folder;
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

TEST(Html, TextStaysText) {
  EXPECT_EQ(experiment::html_text("a < b & c > \"d\" 'e'"), "a &lt; b &amp; c &gt; &quot;d&quot; &#39;e&#39;");
  EXPECT_EQ(experiment::html_text("na\xc3\xafve \xe2\x82\xac \xf0\x9f\x90\x9f"),
            "na\xc3\xafve \xe2\x82\xac \xf0\x9f\x90\x9f");
  // Not UTF-8: a lone byte, an overlong slash, a surrogate, a cut character, a control character.
  EXPECT_EQ(experiment::html_text("\xff"), "\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text("\xc0\xaf"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text("\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd");
  EXPECT_EQ(experiment::html_text(std::string("\x1b[31m\0", 6)), "\xef\xbf\xbd[31m\xef\xbf\xbd");
}

TEST(Html, Base64IsThatOfRfc4648) {
  // The test vectors of section 10.
  EXPECT_EQ(experiment::base64(""), "");
  EXPECT_EQ(experiment::base64("f"), "Zg==");
  EXPECT_EQ(experiment::base64("fo"), "Zm8=");
  EXPECT_EQ(experiment::base64("foo"), "Zm9v");
  EXPECT_EQ(experiment::base64("foob"), "Zm9vYg==");
  EXPECT_EQ(experiment::base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(experiment::base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(experiment::base64("\xff\xff\xfe"), "///+");
}

TEST(Report, OfARunIsOnePageWithVerdictsFirst) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  const experiment::Summary summary = run_into(directory,
                                               "metrics: [{name: distance, type: distance, vehicle: r1}]\n"
                                               "pass: [distance.travelled_m < 1, "
                                               "distance.travelled_m > 1]\n");
  ASSERT_EQ(summary.exit_code, 1);
  const std::string page = experiment::report_page({directory});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("<title>small</title>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">Seed</th><td>7</td>"));
  EXPECT_THAT(page, HasSubstr(experiment::short_version()));
  EXPECT_THAT(page, HasSubstr("<span class=\"bad\">FAILED</span> distance.travelled_m"));
  EXPECT_THAT(page, HasSubstr("<span class=\"good\">passed</span> distance.travelled_m"));
  EXPECT_THAT(page, HasSubstr("1 of 2 rules holds, 1 failed."));
  EXPECT_LT(page.find("FAILED"), page.find("r1 traveled"));
  EXPECT_LT(page.find("r1 traveled"), page.find("<img"));
  EXPECT_LT(page.find("<img"), page.find("<h2>Figures"));
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64,iVBORw0KGgo"));
  EXPECT_EQ(problems_of_page(experiment::report_page({directory + "/"})), "");
}

TEST(Report, NamesInAWorldAreNoHtml) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "", "</title><script>alert(1)</script> \" onload=x");
  write(directory + "/pilot.log", "<img src=x onerror=y>\n\x1b[31m\xff");
  const std::string page = experiment::report_page({directory});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;img src=x onerror=y&gt;"));
}

TEST(Report, NamesImagesThatAreMissingOrNone) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "");
  fs::remove(directory + "/tracks.png");
  write(directory + "/errors.png", "GIF89a");
  const std::string page = experiment::report_page({directory});
  EXPECT_THAT(page, HasSubstr("tracks.png is missing."));
  EXPECT_THAT(page, HasSubstr("errors.png is not a complete PNG file."));
  EXPECT_EQ(problems_of_page(page), "");
}

TEST(Report, TakesNoImageThatIsCutOffOrDamaged) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "");
  const std::string good = text_of_file(directory + "/tracks.png");
  ASSERT_TRUE(experiment::is_whole_png(good));
  std::string damaged = good;
  damaged[good.size() / 2] ^= 1;
  for (const std::string& bad : {good.substr(0, 8), good.substr(0, good.size() / 2), good + "x", damaged}) {
    EXPECT_FALSE(experiment::is_whole_png(bad));
    write(directory + "/tracks.png", bad);
    const std::string page = experiment::report_page({directory});
    EXPECT_THAT(page, HasSubstr("tracks.png is not a complete PNG file."));
    EXPECT_THAT(page, Not(HasSubstr("<img")));
  }
}

TEST(Report, SaysWhatTheWorldIsAndThatNothingWasJudged) {
  const ScratchFolder folder;
  run_into(folder.file("a"), "description: A rover & its <lidar>.\n");
  const std::string page = experiment::report_page({folder.file("a")});
  EXPECT_THAT(page, HasSubstr("<p>A rover &amp; its &lt;lidar&gt;.</p>"));
  EXPECT_THAT(page, HasSubstr("not judged</span>: the world has no rules"));
  EXPECT_THAT(page, Not(HasSubstr("passed</span>")));
  run_into(folder.file("b"),
           "metrics: [{name: distance, type: distance, vehicle: r1}]\n"
           "pass: [distance.travelled_m < 1]\n");
  EXPECT_THAT(experiment::report_page({folder.file("a"), folder.file("b")}),
              HasSubstr("<tr><td>verdict</td><td>not judged</td><td>passed</td></tr>"));
}

TEST(Report, ARunThatWasEndedByHandIsNotJudged) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  experiment::Summary summary = run_into(directory, "");
  summary.ended = "quit";
  experiment::write_summary(directory, summary);
  const std::string page = experiment::report_page({directory});
  EXPECT_THAT(page, HasSubstr("not judged</span>: ended by quit"));
  EXPECT_THAT(page, Not(HasSubstr("passed</span>")));
  EXPECT_THAT(page, Not(HasSubstr("FAILED</span>")));
}

TEST(Report, ReportsProgramsThatFailedAndOfAnOutage) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  const experiment::Summary run = run_into(directory, "");
  experiment::Summary summary = run;
  summary.processes = {{"pilot", "was killed by signal 9 (Killed)", 2, true}};
  summary.metrics["place.max_gap_s"] = 60;
  experiment::write_summary(directory, summary);
  const std::string page = experiment::report_page({directory});
  EXPECT_THAT(page, HasSubstr("Programs of the world failed."));
  EXPECT_THAT(page, HasSubstr("For 60.0 s there was no estimate: place.max_gap_s."));
}

TEST(Report, OfSeveralRunsComparesThem) {
  const ScratchFolder folder;
  const std::string metrics = "metrics: [{name: distance, type: distance, vehicle: r1}]\n";
  run_into(folder.file("a"), metrics);
  run_into(folder.file("b"), "metrics: [{name: other, type: collisions}]\n", "large");
  const std::string page = experiment::report_page({folder.file("a"), folder.file("b")});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("<tr><td>world</td><td>small</td><td>large</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<td></td><td>0</td></tr>"));
  EXPECT_THAT(page, HasSubstr("<summary>Figures that are 0</summary>"));  // no one moved, nothing touched
}

/// A results folder of the figures alone, with the world that they are of.
std::string folder_of(const ScratchFolder& scratch, const std::map<std::string, double>& metrics,
                      const std::string& world) {
  const std::string directory = scratch.file("figures");
  experiment::Summary summary;
  summary.world = "sea";
  summary.metrics = metrics;
  experiment::write_summary(directory, summary);
  write(directory + "/world.yaml", world);
  return directory;
}

constexpr const char* sea_metrics =
    "metrics:\n"
    "  - {name: cooperative, type: position_error, vehicle: auv, channel: auv.estimate}\n"
    "  - {name: alone, type: position_error, vehicle: auv, channel: auv.dead_reckoning}\n"
    "  - {name: link, type: delivery, vehicle: auv}\n";

std::map<std::string, double> sea_figures() {
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

TEST(Report, SaysInWordsWhatCameOut) {
  const ScratchFolder folder;
  const std::string page = experiment::report_page({folder_of(folder, sea_figures(), sea_metrics)});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("auv localizes itself to 0.91 m rms (cooperative); alone: 61.2 m rms, 138 m at the end, "
                              "after 2.80 km."));
  EXPECT_THAT(page, HasSubstr("link: 130 packets sent by auv; 75 % of 100 addressed to auv arrived."));
  // Without the world no one knows whose they are; a world that is not YAML is not known.
  const std::string unknown = experiment::report_page({folder_of(folder, sea_figures(), "}{")});
  EXPECT_THAT(unknown, HasSubstr("cooperative: 0.91 m rms; alone: 61.2 m rms, 138 m at the end, after 2.80 km."));
}

TEST(Report, GroupsFiguresByMetricWithUnitsAndFoldsZeros) {
  const ScratchFolder folder;
  const std::string page = experiment::report_page({folder_of(folder, sea_figures(), sea_metrics)});
  const auto of_link = page.find("<h3>link ");
  // The order is that of the world, not of the alphabet.
  EXPECT_LT(page.find("<h3>cooperative "), page.find("<h3>alone "));
  EXPECT_LT(page.find("<h3>alone "), of_link);
  EXPECT_THAT(page, HasSubstr("delivery of auv"));
  EXPECT_THAT(page, HasSubstr("<td>0.912 m</td>"));
  EXPECT_THAT(page, HasSubstr("<td>1951 estimates</td>"));
  EXPECT_THAT(page, HasSubstr("<td>0.025 %</td>"));
  EXPECT_THAT(page, HasSubstr("<td>0.75</td>"));
  // 13 causes but noise, bytes_sent, unsent and dropped.
  const auto folded = page.find("<summary>15 figures that are 0</summary>", of_link);
  ASSERT_NE(folded, page.npos);
  EXPECT_GT(page.find("lost_doppler", of_link), folded);
  EXPECT_LT(page.find("lost_noise", of_link), folded);
}

TEST(Report, SaysWhatTouchedWhat) {
  const ScratchFolder folder;
  const std::string directory = folder_of(folder, {}, "");
  EXPECT_THAT(experiment::report_page({directory}), HasSubstr("The world has no metrics: nothing was measured."));
  std::string summary = text_of_file(directory + "/summary.json");
  const std::string none = "\"contacts\": []";
  ASSERT_NE(summary.find(none), std::string::npos) << summary;
  summary.replace(summary.find(none), none.size(),
                  R"("contacts": [{"vehicle": "auv4", "with": "rock", "first_s": 105.7, "count": 3}])");
  write(directory + "/summary.json", summary);
  EXPECT_THAT(experiment::report_page({directory}), HasSubstr("<li>auv4 hits rock at 105.7 s, 3 times in all.</li>"));
}

TEST(Report, TakesFiguresOfAnyName) {
  const ScratchFolder folder;
  const std::string page = experiment::report_page(
      {folder_of(folder, {{"a", 1}, {"a.", 2}, {".b", 3}, {"c.d.e", 4}, {"", 5}, {"<x>.rms_m", experiment::no_figure}},
                 "metrics: [1, {name: [a]}, {name: a}]")});
  EXPECT_EQ(problems_of_page(page), "");
  EXPECT_THAT(page, HasSubstr("&lt;x&gt;"));
  EXPECT_THAT(page, HasSubstr("<td>none</td>"));
}

TEST(Report, ReportsWhatIsNoResultsFolder) {
  const ScratchFolder folder;
  EXPECT_THAT(error_of_report({folder.file("nowhere")}), HasSubstr("nowhere: is not a folder"));
  fs::create_directory(folder.file("empty"));
  EXPECT_THAT(error_of_report({folder.file("empty")}), HasSubstr("it has neither summary.json nor study.json"));
  write(folder.file("file"), "x");
  EXPECT_THAT(error_of_report({folder.file("file")}), HasSubstr("is not a folder"));
}

TEST(Report, ReportsWhatIsWrongWithASummary) {
  const ScratchFolder folder;
  const std::string directory = folder.file("run");
  run_into(directory, "metrics: [{name: distance, type: distance, vehicle: r1}]\n");
  const std::string good = text_of_file(directory + "/summary.json");
  const auto error_with = [&](const std::string& text) {
    write(directory + "/summary.json", text);
    return error_of_report({directory});
  };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
  };
  EXPECT_THAT(error_with(good.substr(0, good.size() / 2)), HasSubstr(": must be JSON, got "));
  EXPECT_THAT(error_with(""), HasSubstr("summary.json:1:1: must be JSON, got the end of the file"));
  EXPECT_THAT(error_with("{\n  \"seed\": 7;\n}\n"), HasSubstr("summary.json:2:12: must be JSON, got ';'"));
  EXPECT_THAT(error_with("{\"seed\": 1e999}"), HasSubstr("summary.json: must be JSON with numbers of at most"));
  EXPECT_THAT(error_with("[1, 2]"), HasSubstr("must be an object, got [1,2]"));
  EXPECT_THAT(error_with("{}"), HasSubstr("has no 'world'"));
  EXPECT_THAT(error_with(changed("\"seed\": 7", "\"seed\": \"x\"")),
              HasSubstr("'seed' must be a whole number, got \"x\""));
  EXPECT_THAT(error_with(changed("\"rules\": []", "\"rules\": 3")), HasSubstr("'rules' must be a list, got 3"));
  EXPECT_THAT(error_with(changed("\"rules\": []", "\"rules\": [{\"rule\": 1}]")),
              HasSubstr("rules: 'rule' must be text"));
  EXPECT_THAT(error_with(changed("\"distance.travelled_m\": ", "\"distance.travelled_m\": \"far\", \"x\": ")),
              HasSubstr("'distance.travelled_m' must be a number or null, got \"far\""));
  write(directory + "/summary.json", good);
  EXPECT_EQ(error_of_report({directory}), "");
}

TEST(ReportPage, ListsMessagesThatShadowsTook) {
  const ScratchFolder folder;
  experiment::Summary summary = run_into(folder.file("run"), "");
  summary.acoustics.emplace();
  summary.acoustics->lost["shadow"] = 1;
  summary.shadowed = {{12.5, "boat/modem", "auv/modem", 431}};
  write(folder.file("run/summary.json"), summary.to_json());
  const std::string page = experiment::report_page({folder.file("run")});
  EXPECT_THAT(page, HasSubstr("Packets in shadows"));
  EXPECT_THAT(page, HasSubstr("12.500 s"));
  EXPECT_THAT(page, HasSubstr("boat/modem to auv/modem, 431 m"));
}

}  // namespace
