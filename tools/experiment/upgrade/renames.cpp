// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/renames.hpp"

namespace tools {

// A line such as
//   {Rename::What::key, FileKind::vehicle, "devices.*", "old_key", "new_key"},
//   {Rename::What::word, FileKind::vehicle, "devices.*.type", "old_word", "new_word"},
//   {Rename::What::word, FileKind::world, "events.*.do.*.publish.type", "shoal.old_t", "shoal.new_t"},
//   {Rename::What::part, FileKind::world, "events.*.when", "sim.old", "sim.new"},
std::span<const Rename> renames() {
  return {};
}

}  // namespace tools
