// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/results/notice_text.hpp"

#include <spdlog/fmt/fmt.h>

namespace tools {

nlohmann::ordered_json notices_json(const std::vector<bridges::RunNotice>& notices) {
  auto json = nlohmann::ordered_json::array();
  for (const bridges::RunNotice& notice : notices)
    json.push_back({{"sim_time_s", notice.sim_time_s},
                    {"kind", notice.kind},
                    {"client", notice.client},
                    {"signed_by", notice.signer},
                    {"text", notice.text}});
  return json;
}

std::string notice_text(const bridges::RunNotice& notice) {
  if (notice.kind == "contradiction") return fmt::format("{} (at {:.2f} s)", notice.text, notice.sim_time_s);
  return fmt::format("{}{}{} at {:.2f} s by {}", notice.kind, notice.text.empty() ? "" : " ", notice.text,
                     notice.sim_time_s, bridges::who_asked(notice.client, notice.signer));
}

}  // namespace tools
