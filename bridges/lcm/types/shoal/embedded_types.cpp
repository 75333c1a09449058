#include <fstream>
#include <sstream>

#include "shoal/message_schema.hpp"

namespace shoal {

const MessageTypes& embedded_types() {
  static const MessageTypes types(embedded_lcm_sources());
  return types;
}

MessageTypes types_with(const std::vector<std::string>& lcm_files) {
  const auto embedded = embedded_lcm_sources();
  std::vector<LcmSource> sources(embedded.begin(), embedded.end());
  for (const std::string& path : lcm_files) {
    std::ifstream file(path);
    std::stringstream text;
    if (!file || !(text << file.rdbuf())) throw MessageError(path + ": cannot be read");
    sources.push_back({path, text.str()});
  }
  return MessageTypes(sources);
}

}  // namespace shoal
