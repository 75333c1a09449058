// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace motion {

/// State of a search after a generation.
struct EvolveGeneration {
  int tried = 0;                 ///< candidates so far
  double best_mps = 0;           ///< in the worst of the worlds
  double of_generation_mps = 0;  ///< of the best of this generation
};

/// Contents of the page of a search.
struct EvolveReport {
  std::string title;
  std::vector<std::vector<std::string>> facts;  ///< name and value
  std::vector<EvolveGeneration> generations;
  std::vector<std::string> world_head;
  std::vector<std::vector<std::string>> worlds;
  std::vector<std::vector<std::string>> numbers;  ///< name, best, start
};

/// Returns the curve of a search as an SVG image: the best so far, and the best of each generation.
std::string evolve_curve(const std::vector<EvolveGeneration>& generations);

/// Returns a self-contained HTML page.
std::string evolve_page(const EvolveReport& report);

}  // namespace motion
