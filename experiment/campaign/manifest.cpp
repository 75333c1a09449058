// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/manifest.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "bridges/base/json_text.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/files/json_reader.hpp"
#include "experiment/files/no_links.hpp"
#include "experiment/run/version.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t max_manifest_bytes = std::uintmax_t{512} << 20;
constexpr std::int64_t format = 1;
constexpr double max_seed = 9007199254740992.0;  // 2^53

std::string read_manifest_file(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw std::runtime_error(path + ": there is no manifest; `shoal study plan STUDY --output DIR` writes one");
  if (const auto size = fs::file_size(path, error); error || size > max_manifest_bytes)
    throw std::runtime_error(path + ": is larger than 512 MB");
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Json parse_line(std::string_view line, const std::string& where) {
  try {
    Json json = Json::parse(line);
    if (!json.is_object()) throw std::runtime_error(where + ": must be a JSON object, got " + shown_json(json));
    return json;
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error(where + ": is not JSON: '" + sim::shortened(sim::printable(line)) + "'");
  }
}

std::size_t size_in(const JsonReader& in, const char* key, std::int64_t low, std::size_t high) {
  const std::int64_t value = in.whole(key);
  if (value < low || static_cast<std::uint64_t>(value) > high)
    throw std::runtime_error(fmt::format("{}: '{}' must be from {} to {}, got {}", in.where(), key, low, high, value));
  return static_cast<std::size_t>(value);
}

void check_seed(std::int64_t seed, const std::string& where) {
  if (seed < 0 || static_cast<double>(seed) > max_seed)
    throw std::runtime_error(fmt::format("{}: a seed must be from 0 to 2^53, got {}", where, seed));
}

}  // namespace

std::string manifest_path(const std::string& directory) {
  return directory + "/manifest.jsonl";
}

Manifest::Manifest(const std::string& directory)
    : directory_(directory), path_(manifest_path(directory)), text_(read_manifest_file(path_)) {
  // Split into lines.
  std::vector<std::string_view> lines;
  const std::string_view text = text_;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos)
      throw std::runtime_error(fmt::format("{}:{}: the last line is incomplete", path_, lines.size() + 1));
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (lines.empty()) throw std::runtime_error(path_ + ": is empty");
  read_head(lines.front());
  lines_.assign(lines.begin() + 1, lines.end());
  if (lines_.size() != runs_)
    throw std::runtime_error(
        fmt::format("{}: must have a line for each of its {} runs, got {}", path_, runs_, lines_.size()));
}

void Manifest::read_head(std::string_view line) {
  const std::string where = path_ + ":1";
  const Json json = parse_line(line, where);
  const JsonReader in(json, where);
  if (const std::int64_t version = in.whole("shoal_manifest"); version != format)
    throw std::runtime_error(fmt::format("{}: 'shoal_manifest' must be {}, got {}", where, format, version));
  study_ = in.text("study");
  // The runs may be executed from other folders, by jobs of a cluster.
  if (!fs::path(study_).is_absolute())
    throw std::runtime_error(where + ": 'study' must be an absolute path, got '" +
                             sim::shortened(sim::printable(study_)) + "'");
  runs_ = size_in(in, "runs", 1, max_study_runs);
  if (!in.at("duration_s").is_null()) {
    duration_s_ = in.number("duration_s");
    if (!(*duration_s_ > 0 && *duration_s_ <= 1e9))
      throw std::runtime_error(where + ": 'duration_s' must be > 0 and <= 1e9, got " + shown_json(in.at("duration_s")));
  }
  std::set<std::int64_t> distinct;
  for (const Json& seed : in.list("seeds")) {
    if (!seed.is_number_integer())
      throw std::runtime_error(where + ": 'seeds' must be whole numbers, got " + shown_json(seed));
    seeds_.push_back(seed.get<std::int64_t>());
    check_seed(seeds_.back(), where);
    if (!distinct.insert(seeds_.back()).second)
      throw std::runtime_error(where + ": 'seeds' must differ from each other, got " + shown_json(seed) + " twice");
  }
  if (seeds_.empty() || seeds_.size() > runs_)
    throw std::runtime_error(where + ": 'seeds' must be at least one, and not more than the runs, got " +
                             shown_json(in.at("seeds")));
  if (!in.has("algorithms")) return;
  for (const Json& algorithm : in.list("algorithms")) {
    if (!algorithm.is_string())
      throw std::runtime_error(where + ": 'algorithms' must be names, got " + shown_json(algorithm));
    algorithms_.push_back(algorithm.get<std::string>());
  }
}

ManifestRun Manifest::run(std::size_t index) const {
  const std::string where = fmt::format("{}:{}", path_, index + 1);
  const Json json = parse_line(lines_.at(index - 1), where);
  const JsonReader in(json, where);
  ManifestRun run;
  run.index = size_in(in, "index", 1, runs_);
  if (run.index != index)
    throw std::runtime_error(fmt::format("{}: 'index' must be {}, got {}", where, index, run.index));
  run.in_case = in.text("case");
  run.point = size_in(in, "point", 0, max_points);
  run.seed = in.whole("seed");
  check_seed(run.seed, where);
  run.inputs = in.text("inputs");
  return run;
}

std::string manifest_text(const LoadedStudy& study, const std::vector<StudyRun>& runs) {
  const StudyConfig& config = study.config;
  Json head{{"shoal_manifest", format}, {"study", fs::absolute(config.file).lexically_normal().string()},
            {"name", config.name},      {"runs", runs.size()},
            {"duration_s", nullptr},    {"seeds", config.seeds},
            {"shoal", short_version()}};
  if (config.duration_s) head["duration_s"] = *config.duration_s;
  if (!config.added_algorithms.empty()) head["algorithms"] = config.added_algorithms;
  std::string text = head.dump() + "\n";
  for (const StudyRun& run : runs) {
    Json line{{"index", run.index},
              {"case", config.cases[run.in_case].name},
              {"point", config.factors.empty() ? 0 : run.point + 1},
              {"seed", run.seed}};
    if (!config.factors.empty()) {
      Json& factors = line["factors"];
      for (std::size_t k = 0; k < config.factors.size(); ++k)
        factors[config.factors[k].name] = study.points[run.point].values[k];
    }
    line["set"] = sets_of(study, run);
    line["inputs"] = inputs_of(study, run);
    text += bridges::json_text(line) + "\n";
  }
  return text;
}

void write_manifest(const std::string& directory, const LoadedStudy& study, const std::vector<StudyRun>& runs) {
  make_folders(directory, directory);
  refuse_links(directory, manifest_path(directory));
  write_whole_file(manifest_path(directory), manifest_text(study, runs));
}

PlannedStudy load_planned(const Manifest& manifest, const sim::LoadOptions& load,
                          const std::vector<std::string>& algorithms) {
  StudyChanges changes;
  changes.seeds = manifest.seeds();
  changes.duration_s = manifest.duration_s();
  changes.load = load;
  changes.algorithms = manifest.algorithms();
  for (const std::string& algorithm : algorithms)
    if (std::find(changes.algorithms.begin(), changes.algorithms.end(), algorithm) == changes.algorithms.end())
      changes.algorithms.push_back(algorithm);
  changes.planned = true;
  PlannedStudy planned;
  try {
    planned.study = load_study(manifest.study(), changes);
  } catch (const std::invalid_argument& error) {
    // Only algorithms of the manifest can be wrong here, so its line is named.
    if (!algorithms.empty()) throw;
    throw std::runtime_error(manifest_path(manifest.directory()) + ":1: 'algorithms': " + error.what());
  }
  planned.runs = plan_study(planned.study, manifest.directory());
  if (planned.runs.size() != manifest.size())
    throw std::runtime_error(fmt::format("{}: {} has {} runs now, but {} are planned; plan it again",
                                         manifest_path(manifest.directory()), manifest.study(), planned.runs.size(),
                                         manifest.size()));
  return planned;
}

void check_planned(const Manifest& manifest, const PlannedStudy& planned, const std::vector<std::size_t>& which) {
  const StudyConfig& config = planned.study.config;
  for (const std::size_t i : which) {
    const StudyRun& run = planned.runs[i];
    const ManifestRun line = manifest.run(run.index);
    // The inputs are hashes of the world and its settings: a result under the number of a changed run would be wrong
    // without a sign of it.
    const bool same = line.in_case == config.cases[run.in_case].name && line.seed == run.seed &&
                      line.point == (config.factors.empty() ? 0 : run.point + 1) &&
                      line.inputs == inputs_of(planned.study, run);
    if (!same)
      throw std::runtime_error(
          fmt::format("{}:{}: run {} is not as planned: {} or its world has changed since; plan it again",
                      manifest_path(manifest.directory()), run.index + 1, run.index, manifest.study()));
  }
}

std::vector<std::size_t> parse_indices(const std::string& text, std::size_t size) {
  std::set<std::size_t> indices;
  const auto wrong = [&](const std::string& item) {
    return std::invalid_argument(fmt::format("must be numbers of runs from 1 to {}, or ranges such as 1-10, got '{}'",
                                             size, sim::shortened(sim::printable(item))));
  };
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string item = text.substr(begin, end - begin);
    const std::size_t dash = item.find('-');
    const auto first = sim::exact_number<std::size_t>(std::string_view(item).substr(0, dash));
    const auto last =
        dash == std::string::npos ? first : sim::exact_number<std::size_t>(std::string_view(item).substr(dash + 1));
    if (!first || !last || *first < 1 || *last > size || *last < *first) throw wrong(item);
    for (std::size_t index = *first; index <= *last; ++index) indices.insert(index - 1);
    begin = end + 1;
  }
  return {indices.begin(), indices.end()};
}

std::string indices_text(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t end = i + 1;
    while (end < indices.size() && indices[end] == indices[end - 1] + 1) ++end;
    text += (text.empty() ? "" : ",") + std::to_string(indices[i] + 1);
    if (end - i > 1) text += "-" + std::to_string(indices[end - 1] + 1);
    i = end;
  }
  return text;
}

}  // namespace experiment
