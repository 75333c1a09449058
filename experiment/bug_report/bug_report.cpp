// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/bug_report/bug_report.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>

#include "experiment/bug_report/tar_file.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "experiment/results/run_record.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/record_tail.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "sim/config/config_node.hpp"

namespace experiment {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t max_text_bytes = 8 << 20;    // limit of summary, metrics and world, each
constexpr std::uintmax_t max_log_bytes = 1 << 20;     // limit of the end of each log
constexpr std::uintmax_t max_file_bytes = 1 << 20;    // limit of each file that the world names
constexpr std::uintmax_t max_files_bytes = 16 << 20;  // limit of all of them

std::string size_text(std::uintmax_t bytes) {
  if (bytes < 10000) return fmt::format("{} bytes", bytes);
  return bytes < 10'000'000 ? fmt::format("{} kB", bytes / 1000) : fmt::format("{} MB", bytes / 1'000'000);
}

/// Returns a name that is valid in any file system.
std::string plain_name(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-' && c != '.') c = '_';
  return text.substr(0, 80);
}

class BugPacker {
 public:
  explicit BugPacker(const BugOptions& options) : options_(options), directory_(checked(options.directory)) {
    report_.path = options.out.empty() ? directory_ + "/bug.tar.gz" : options.out;
  }

  BugReport pack() {
    read_summary();
    const ScratchDirectory scratch;
    const std::string tail_file = (scratch.path / "tail.lcm").string();
    cut_record(tail_file);
    TarFile tar(report_.path);
    tar_ = &tar;
    add_texts();
    add_logs();
    add_world_files();
    if (tail_) add_path("record_tail.lcm", tail_file, tail_text());
    add("versions.txt", versions(), "versions, processor class and C library");
    tar.add(folder() + "README.txt", readme());
    tar.finish();
    return report_;
  }

 private:
  static std::string checked(std::string directory) {
    while (directory.size() > 1 && directory.back() == '/') directory.pop_back();
    std::error_code error;
    if (!fs::exists(directory, error)) throw std::runtime_error(directory + ": no such folder");
    if (!fs::is_directory(directory, error)) throw std::runtime_error(directory + ": is not a folder");
    const auto has = [&](const char* file) { return fs::exists(directory + "/" + file, error); };
    if (has("study.json"))
      throw std::runtime_error(directory + ": is a study; name the folder of one of its runs, such as " + directory +
                               "/runs/CASE/seed_1");
    // A run that was killed has no summary.
    if (!has("summary.json") && !(has("tracks.csv") && has("outlines.dat")))
      throw std::runtime_error(directory + ": is not a run's results folder: it has no summary.json");
    return directory;
  }

  void read_summary() {
    std::error_code error;
    if (!is_plain(directory_ + "/summary.json")) return;
    try {
      run_ = read_run(directory_);
    } catch (const std::runtime_error& problem) {
      left_out("summary.json was not understood: " + std::string(problem.what()));
    }
  }

  std::string folder() const {
    if (!run_) return "bug-" + plain_name(fs::path(directory_).filename().string()) + "/";
    return fmt::format("bug-{}-seed{}/", plain_name(run_->world), run_->seed);
  }

  /// Returns whether the path is a regular file and not a link, so that files outside of the folder are not included.
  static bool is_plain(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(fs::symlink_status(path, error));
  }

  static std::uintmax_t size_of(const fs::path& path) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    return error ? 0 : size;
  }

  void left_out(const std::string& what) { report_.left_out.push_back(what); }

  void note(const std::string& name, std::uintmax_t bytes, const std::string& what) {
    report_.inside.push_back(fmt::format("{} ({}): {}", name, size_text(bytes), what));
  }

  void add(const std::string& name, const std::string& bytes, const std::string& what) {
    tar_->add(folder() + name, bytes);
    note(name, bytes.size(), what);
  }

  void add_path(const std::string& name, const std::string& path, const std::string& what) {
    note(name, size_of(path), what);
    tar_->add_file(folder() + name, path);
  }

  void add_texts() {
    const std::pair<const char*, const char*> texts[] = {
        {"summary.json", "outcome of the run"}, {"metrics.csv", "its figures"}, {"world.yaml", "the world as it ran"}};
    for (const auto& [name, what] : texts) {
      const std::string path = directory_ + "/" + name;
      std::error_code error;
      // A link or a pipe could lead anywhere, and the archive is sent to others.
      if (!fs::exists(fs::symlink_status(path, error)))
        left_out(std::string(name) + ": the run did not write it");
      else if (!is_plain(path))
        left_out(std::string(name) + ": is not a plain file");
      else if (size_of(path) > max_text_bytes)
        left_out(fmt::format("{}: is larger than {}", name, size_text(max_text_bytes)));
      else
        add(name, read_whole_file(path), what);
    }
  }

  void add_logs() {
    std::set<fs::path> logs;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(directory_, error))
      if (entry.path().extension() == ".log") logs.insert(entry.path());
    for (const fs::path& log : logs) {
      const std::string name = log.filename().string();
      if (!is_plain(log)) {
        left_out(name + ": is not a plain file");
        continue;
      }
      const std::uintmax_t size = size_of(log);
      std::ifstream in(log, std::ios::binary);
      // The end of an output tells why a program failed.
      if (size > max_log_bytes) in.seekg(static_cast<std::streamoff>(size - max_log_bytes));
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      if (size > max_log_bytes) left_out(fmt::format("{}: truncated to its last {}", name, size_text(max_log_bytes)));
      if (!text.empty()) add("logs/" + name, text.substr(0, max_log_bytes), "output of a program");
    }
  }

  /// Adds meshes, terrain, textures and currents: hashes of all, copies of small ones.
  void add_world_files() {
    // Hash the files that the world names.
    const std::string path = directory_ + "/world.yaml";
    if (!is_plain(path) || size_of(path) > max_text_bytes) return;
    sim::Diagnostics problems;
    const std::string hashes = files_text(sim::parse_config_text(read_whole_file(path), path, problems));
    if (hashes.empty()) return;
    add("files.txt", hashes, "hashes of the files that the world names");
    // Copy small files.
    std::istringstream lines(hashes);
    std::uintmax_t copied = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::string hash = line.substr(0, 16), file = line.substr(17);
      std::error_code error;
      const bool readable = fs::is_regular_file(file, error) && hash.front() != '-';
      const std::uintmax_t size = readable ? size_of(file) : 0;
      if (!readable)
        left_out(file + ": cannot be read");
      else if (!options_.files)
        left_out(file + ": by --no-files");
      else if (size > max_file_bytes || copied + size > max_files_bytes)
        left_out(fmt::format("{}: {}; its hash is in files.txt", file, size_text(size)));
      else
        add_path("files/" + hash + "-" + plain_name(fs::path(file).filename().string()), file, "copy of " + file),
            copied += size;
    }
  }

  /// Returns the named record, else the only one in the folder.
  std::string find_record() {
    if (!options_.record.empty()) return options_.record;
    std::vector<std::string> records;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(directory_, error))
      if (entry.path().extension() == ".lcm" && is_plain(entry.path())) records.push_back(entry.path().string());
    if (records.size() == 1) return records.front();
    left_out(records.empty() ? "a record: the folder holds none; name it with --record"
                             : "the records: the folder holds several; name one with --record");
    return "";
  }

  void cut_record(const std::string& tail_file) {
    const std::string record = find_record();
    if (record.empty()) return;
    TailOptions tail;
    tail.last_s = options_.last_s;
    tail.max_bytes = static_cast<std::uint64_t>(options_.max_MB) << 20;
    tail.snapshots = directory_ + "/snapshots";
    tail_ = write_record_tail(record, tail_file, tail);
    // A record of another run would mislead whoever reads the report.
    if (run_ && (tail_->info.world != run_->world || tail_->info.seed != run_->seed))
      throw std::runtime_error(
          fmt::format("{}: is of world '{}' with seed {}, but the run in {} is of '{}' with seed {}", record,
                      tail_->info.world, tail_->info.seed, directory_, run_->world, run_->seed));
    if (!tail_->whole) left_out(fmt::format("{}: the part before {:.3f} s of simulated time", record, tail_->start_s));
    if (!tail_->short_of.empty()) left_out(tail_->short_of);
  }

  std::string tail_text() const {
    return fmt::format("{} from {:.3f} to {:.3f} s of simulated time; {}",
                       tail_->whole ? "all of the record," : "the record", tail_->start_s, tail_->end_s,
                       tail_->snapshot.empty() ? "no snapshot" : "begins with " + tail_->snapshot);
  }

  std::string versions() const {
    std::string text =
        "The run: shoal " + (run_ && !run_->version.empty() ? run_->version : "of an unknown version") + "\n";
    if (tail_) text += tail_->info.versions + tail_->info.build + "\n";
    return text + "\nPacked by:\n" + version_text() + build_text() + "\n";
  }

  std::string search_hint() const {
    std::string text = "\nHow to look at it:\n";
    if (run_)
      text += fmt::format(
          "  shoal run world.yaml --seed {} --duration {:g}    reruns it; add --launch if its programs took part\n",
          run_->seed, run_->sim_time_s);
    if (!tail_) return text;
    text += tail_->replayable()
                ? "  shoal replay record_tail.lcm    replays its end with the same build of shoal\n"
                : "  record_tail.lcm has no snapshot at its start: it can be inspected, but not replayed.\n";
    return text +
           "  shoal log info record_tail.lcm    its channels\n"
           "  shoal log csv record_tail.lcm CHANNEL    the messages of one\n";
  }

  std::string readme() const {
    std::string text = run_ ? fmt::format("A run of world {}, seed {}: ended by {} after {:.3f} s, exit code {}.\n",
                                          run_->world, run_->seed, run_->ended, run_->sim_time_s, run_->exit_code)
                            : "A run that left no summary: it was killed, or it crashed.\n";
    if (run_ && !run_->error.empty()) text += "Error: " + run_->error + "\n";
    text += "\nIn this archive:\n";
    for (const std::string& line : report_.inside) text += "  " + line + "\n";
    if (!report_.left_out.empty()) text += "\nLeft out:\n";
    for (const std::string& line : report_.left_out) text += "  " + line + "\n";
    return text + search_hint();
  }

  const BugOptions& options_;
  std::string directory_;
  BugReport report_;
  TarFile* tar_ = nullptr;
  std::optional<RunRecord> run_;
  std::optional<RecordTail> tail_;
};

}  // namespace

BugReport write_bug_report(const BugOptions& options) {
  return BugPacker(options).pack();
}

}  // namespace experiment
