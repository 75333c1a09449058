// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <list>
#include <sstream>

#include "shoal/message_schema.hpp"

namespace shoal {

namespace {

struct KnownTypes {
  std::vector<LcmSource> sources;
  std::list<MessageTypes> generations;  ///< the last one is complete; pointers into the others remain valid
};

KnownTypes& known_types() {
  static KnownTypes known = [] {
    KnownTypes first;
    const auto embedded = embedded_lcm_sources();
    first.sources.assign(embedded.begin(), embedded.end());
    first.generations.emplace_back(first.sources);
    return first;
  }();
  return known;
}

}  // namespace

const MessageTypes& embedded_types() {
  return known_types().generations.back();
}

bool add_lcm_sources(const std::vector<LcmSource>& sources) {
  KnownTypes& known = known_types();
  std::vector<LcmSource> all = known.sources;
  all.insert(all.end(), sources.begin(), sources.end());
  known.generations.emplace_back(all);
  known.sources = std::move(all);
  return true;
}

MessageTypes types_with(const std::vector<std::string>& lcm_files) {
  std::vector<LcmSource> sources = known_types().sources;
  for (const std::string& path : lcm_files) {
    std::ifstream file(path);
    std::stringstream text;
    if (!file || !(text << file.rdbuf())) throw MessageError(path + ": cannot be read");
    sources.push_back({path, text.str()});
  }
  return MessageTypes(sources);
}

}  // namespace shoal
