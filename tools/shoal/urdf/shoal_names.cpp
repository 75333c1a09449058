// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/shoal_names.hpp"

#include <utility>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

constexpr std::size_t max_name = 40;  // a channel, VEHICLE.DEVICE.truth, has at most 63 characters

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

}  // namespace

std::string plain_name(const std::string& text) {
  std::string name = text.substr(0, max_name);
  for (char& c : name)
    if (!is_plain(c)) c = '_';
  return name.empty() ? "_" : name;
}

ShoalNames::ShoalNames(std::string kind, std::set<std::string> reserved)
    : kind_(std::move(kind)), taken_(std::move(reserved)) {}

std::string ShoalNames::add(const std::string& original, const sim::SourcePlace& place,
                            std::vector<ImportNote>& notes) {
  const std::string plain = plain_name(original);
  std::string name = plain;
  int& number = last_number_.try_emplace(plain, 1).first->second;
  while (!taken_.insert(name).second) name = plain + '_' + std::to_string(++number);
  if (name != original)
    notes.push_back({place, kind_ + " '" + sim::shortened(original) + "' is named '" + name + "' in Shoal"});
  names_[original] = name;
  return name;
}

}  // namespace tools
