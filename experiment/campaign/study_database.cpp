// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/study_database.hpp"

#include <spdlog/fmt/fmt.h>
#include <sqlite3.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>

#include "experiment/files/part_file.hpp"
#include "experiment/run/version.hpp"
#include "experiment/study/study_rules.hpp"
#include "experiment/study/study_tables.hpp"

namespace experiment {

namespace {

constexpr const char* schema = R"(
CREATE TABLE study (name TEXT, description TEXT, world TEXT, shoal TEXT);
CREATE TABLE runs (run INTEGER PRIMARY KEY, case_name TEXT, point INTEGER, seed INTEGER, inputs TEXT, directory TEXT,
  failure TEXT, exit_code INTEGER, passed INTEGER, ended TEXT, sim_time_s REAL, wall_s REAL, run_hash TEXT, shoal TEXT,
  processor TEXT, c_library TEXT);
CREATE TABLE figures (run INTEGER REFERENCES runs(run), name TEXT, value REAL, PRIMARY KEY (run, name)) WITHOUT ROWID;
CREATE TABLE factors (point INTEGER, name TEXT, value NUMERIC, PRIMARY KEY (point, name)) WITHOUT ROWID;
CREATE TABLE statistics (case_name TEXT, point INTEGER, figure TEXT, count INTEGER, mean REAL, mean_low_95 REAL,
  mean_high_95 REAL, std REAL, min REAL, median REAL, median_low_95 REAL, median_high_95 REAL, max REAL);
CREATE TABLE comparisons (compared TEXT, base TEXT, figure TEXT, pairs INTEGER, mean REAL, mean_low_95 REAL,
  mean_high_95 REAL, median REAL, higher INTEGER, lower INTEGER, equal INTEGER, sign_p REAL, wilcoxon_p REAL);
)";

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct FinalizeStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

/// Database that appears under its name when it is complete.
class NewDatabase {
 public:
  explicit NewDatabase(const std::string& path) : file_(path) {
    sqlite3* opened = nullptr;
    const int code = sqlite3_open_v2(file_.part_name().c_str(), &opened, SQLITE_OPEN_READWRITE, nullptr);
    database_.reset(opened);
    check(code);
    // A file that is not complete is never used: no journal is needed.
    execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN;");
    execute(schema);
  }

  void execute(const char* sql) { check(sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr)); }

  void finish() {
    execute("COMMIT; PRAGMA synchronous = FULL;");
    check(sqlite3_close(database_.release()));
    file_.finish();
  }

  sqlite3* handle() const { return database_.get(); }
  void check(int code) const {
    if (code == SQLITE_OK || code == SQLITE_DONE) return;
    const int error = database_ ? sqlite3_system_errno(database_.get()) : 0;
    throw std::runtime_error(
        file_.path() + ": cannot be written: " + (database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(code)) +
        (error != 0 ? std::string(": ") + std::strerror(error) : ""));
  }

 private:
  PartFile<> file_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
};

/// Statement that inserts rows.
class Insert {
 public:
  Insert(NewDatabase& database, const std::string& table, int columns) : database_(database) {
    std::string sql = "INSERT INTO " + table + " VALUES (?";
    for (int i = 1; i < columns; ++i) sql += ",?";
    sqlite3_stmt* statement = nullptr;
    database_.check(sqlite3_prepare_v2(database_.handle(), (sql + ")").c_str(), -1, &statement, nullptr));
    statement_.reset(statement);
  }

  template <class... Values>
  void row(const Values&... values) {
    int column = 0;
    (bind(++column, values), ...);
    database_.check(sqlite3_step(statement_.get()));
    database_.check(sqlite3_reset(statement_.get()));
  }

 private:
  void bind(int column, const std::string& text) {
    database_.check(
        sqlite3_bind_text(statement_.get(), column, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT));
  }
  void bind(int column, std::int64_t value) { database_.check(sqlite3_bind_int64(statement_.get(), column, value)); }
  void bind(int column, std::size_t value) { bind(column, static_cast<std::int64_t>(value)); }
  void bind(int column, int value) { bind(column, static_cast<std::int64_t>(value)); }
  void bind(int column, double value) {
    database_.check(std::isfinite(value) ? sqlite3_bind_double(statement_.get(), column, value)
                                         : sqlite3_bind_null(statement_.get(), column));
  }
  template <class Value>
  void bind(int column, const std::optional<Value>& value) {
    if (value)
      bind(column, *value);
    else
      database_.check(sqlite3_bind_null(statement_.get(), column));
  }

  NewDatabase& database_;
  std::unique_ptr<sqlite3_stmt, FinalizeStatement> statement_;
};

void insert_runs(NewDatabase& database, const StudyResults& results) {
  const StudyConfig& config = results.study().config;
  Insert runs(database, "runs", 16), figures(database, "figures", 3);
  for (const StudyRun& run : results.runs()) {
    const std::size_t point = config.factors.empty() ? 0 : run.point + 1;
    const std::string inputs = inputs_of(results.study(), run);
    // Runs without a result get a row, too, so that a query can find what is missing.
    if (!run.record) {
      const std::optional<std::string> no_text;
      const std::optional<std::int64_t> no_number;
      const std::optional<double> no_figure_value;
      runs.row(run.index, config.cases[run.in_case].name, point, run.seed, inputs, run.directory, run.failure,
               no_number, no_number, no_text, no_figure_value, no_figure_value, no_text, no_text, no_text, no_text);
      continue;
    }
    const RunRecord& record = *run.record;
    const RunKind kind = kind_of(record);
    runs.row(run.index, config.cases[run.in_case].name, point, run.seed, inputs, run.directory,
             std::optional<std::string>(), record.exit_code, figure_of(run, passed_figure), record.ended,
             record.sim_time_s, record.wall_s, record.run_hash, kind.version, kind.processor, kind.c_library);
    for (const auto& [name, value] : record.metrics) figures.row(run.index, name, value);
  }
}

void insert_statistics(NewDatabase& database, const StudyResults& results) {
  const LoadedStudy& study = results.study();
  Insert factors(database, "factors", 3), statistics(database, "statistics", 13);
  for (std::size_t point = 0; point < study.points.size(); ++point) {
    for (std::size_t k = 0; k < study.config.factors.size(); ++k)
      factors.row(point + 1, study.config.factors[k].name, study.points[point].values[k]);
    for (std::size_t in_case = 0; in_case < study.config.cases.size(); ++in_case)
      for (const std::string& figure : results.table_figures()) {
        const Statistics s = results.at_point(in_case, point, figure);
        statistics.row(study.config.cases[in_case].name, study.config.factors.empty() ? 0 : point + 1, figure, s.count,
                       s.mean, s.mean_95.low, s.mean_95.high, s.std, s.min, s.median, s.median_95.low, s.median_95.high,
                       s.max);
      }
  }
}

void insert_comparisons(NewDatabase& database, const StudyResults& results) {
  Insert comparisons(database, "comparisons", 13);
  for (const StudyComparison& each : results.comparisons()) {
    const PairedComparison& d = each.difference;
    comparisons.row(each.compared, each.base, each.figure, d.pairs, d.mean, d.mean_95.low, d.mean_95.high, d.median,
                    d.higher, d.lower, d.equal, d.sign_p, d.wilcoxon_p);
  }
}

}  // namespace

void write_database(const std::string& path, const StudyResults& results) {
  NewDatabase database(path);
  const StudyConfig& config = results.study().config;
  Insert(database, "study", 4).row(config.name, config.description, config.world_text(), short_version());
  insert_runs(database, results);
  insert_statistics(database, results);
  insert_comparisons(database, results);
  database.finish();
}

}  // namespace experiment
