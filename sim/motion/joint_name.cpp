// SPDX-License-Identifier: BSD-3-Clause
#include "sim/motion/joint_name.hpp"

#include "sim/config/message_text.hpp"
#include "sim/config/utf8.hpp"

namespace sim {

std::string joint_name_error(std::string_view name) {
  bool is_good = !name.empty() && name.size() <= max_joint_name;
  for (std::size_t i = 0; is_good && i < name.size();) {
    const auto c = static_cast<unsigned char>(name[i]);
    const std::size_t length = utf8_length(name, i);
    is_good = length > 0 && c >= 0x20 && c != 0x7f;
    i += length;
  }
  if (is_good) return "";
  return "the name of a joint must be UTF-8 text of 1 to " + std::to_string(max_joint_name) +
         " bytes without control characters, got '" + shortened(printable(in_utf8(name.substr(0, 1000)))) + "'";
}

}  // namespace sim
