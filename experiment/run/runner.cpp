// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/runner.hpp"

#include <optional>

#include "experiment/process/process_check.hpp"
#include "experiment/results/results_folder.hpp"
#include "experiment/results/run_error.hpp"
#include "experiment/run/run.hpp"
#include "experiment/run/version.hpp"
#include "experiment/snapshot/run_identity.hpp"
#include "sim/config/diagnostics.hpp"

namespace experiment {

Summary run_world(const sim::LoadedWorld& loaded, const RunOptions& options) {
  Summary summary;
  summary.world = loaded.config.name;
  summary.seed = loaded.config.run.seed;
  summary.version = short_version();
  summary.build = build_text();
  const auto fail = [&](int exit_code, const std::string& ended, const char* error) {
    summary.fail(exit_code, ended, error);
    if (!options.results.empty()) try_to_write_summary(options.results, summary);
  };
  // Lock the results folder.
  std::optional<ResultsLock> lock;
  try {
    if (!options.results.empty()) lock.emplace(options.results);
  } catch (const RunError& error) {  // the folder belongs to another run and is not changed
    summary.fail(error.exit_code, error.ended, error.what());
    return summary;
  }
  try {
    // Remove the files of an earlier run, which would be mistaken for those of this one, also if it fails or is killed.
    if (!options.results.empty()) {
      remove_earlier_run(options.results);
      write_results_world(options.results, loaded.resolved);
    }
    // Check the options and run.
    if (options.launch && options.bus == "none")
      throw RunError(2, "configuration", "--launch needs the LCM bus: processes cannot attach to --bus none");
    if (options.launch || !options.await.empty()) {
      sim::Warnings warnings;
      warn_of_processes(loaded, warnings);
    }
    return Run(loaded, options).go();
  } catch (const sim::ConfigError& error) {
    fail(2, "configuration", error.what());
    throw;
  } catch (const RunError& error) {
    fail(error.exit_code, error.ended, error.what());
  } catch (const std::exception& error) {  // bus, record, serial port or results could not be opened
    fail(4, "bus", error.what());
  }
  return summary;
}

std::string bug_hint(const std::string& results, const std::string& record) {
  const std::string with_record = " --record " + (record.empty() ? "FILE" : record);
  if (results.empty())
    return "to report this: run it again with --results DIR" + with_record + ", then shoal bug DIR" + with_record;
  return "to report this: shoal bug " + results + (record.empty() ? "" : with_record);
}

}  // namespace experiment
