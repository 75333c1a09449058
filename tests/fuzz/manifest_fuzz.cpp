// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <stdexcept>

#include "experiment/campaign/manifest.hpp"
#include "experiment/campaign/verified_runs.hpp"
#include "experiment/study/run_files.hpp"
#include "experiment/study/study_until.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/scratch_file.hpp"

// What someone may have left in the folder of a study: its manifest and the marks of its runs; the table of its
// results; numbers of runs and the condition that ends a study.

SHOAL_FUZZ_TARGET(manifest) {
  fuzz::Reader reader(input);
  const std::string folder = fuzz::scratch_folder().string();
  switch (reader.below(5)) {
    case 0:
      fuzz::write_scratch("manifest.jsonl", reader.rest());
      fuzz::allow<std::runtime_error>([&] {
        const experiment::Manifest manifest(folder);
        for (std::size_t i = 1; i <= manifest.size(); ++i)
          fuzz::require(manifest.run(i).index == i, "a run has the number of its line");
      });
      break;
    case 1: {
      const std::string text(fuzz::text_of(reader.rest()));
      fuzz::allow<std::invalid_argument>([&] {
        const auto indices = experiment::parse_indices(text, 1000);
        fuzz::require(std::is_sorted(indices.begin(), indices.end()), "numbers of runs are sorted");
        fuzz::require(experiment::parse_indices(experiment::indices_text(indices), 1000) == indices,
                      "and are written again");
      });
      break;
    }
    case 2: {
      const std::string text(fuzz::text_of(reader.rest()));
      fuzz::allow<std::invalid_argument>([&] {
        fuzz::require(experiment::parse_until(text, {"passed", "e.rms_m"}).bound > 0, "a bound is positive");
      });
      break;
    }
    case 3:
      fuzz::write_scratch("study_stamp.txt", reader.rest());
      if (const auto stamp = experiment::read_stamp(folder))
        fuzz::require(stamp->inputs.size() == 16, "a stamp has a whole hash");
      break;
    default: {
      const std::string text(fuzz::text_of(reader.rest()));
      fuzz::allow<std::runtime_error>([&] {
        for (const experiment::StudyRow& row : experiment::parse_study_rows(text, "study.csv"))
          fuzz::require(row.seed >= 0, "a seed is not negative");
      });
    }
  }
}
