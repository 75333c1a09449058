// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"

#include <algorithm>
#include <cassert>
#include <memory>
#include <tuple>
#include <utility>

namespace bridges::ros2 {
namespace {

auto key_of(const Converter& converter) {
  return std::tie(converter.lcm_type, converter.topic);
}

}  // namespace

std::string Converter::topic_for(std::string_view channel) const {
  return topic.starts_with('/') ? topic : topic_of(channel) + "/" + topic;
}

ConverterTable& ConverterTable::instance() {
  static ConverterTable table;
  return table;
}

void ConverterTable::add(Converter converter) {
  const auto at = std::lower_bound(converters_.begin(), converters_.end(), converter,
                                   [](const auto& a, const Converter& b) { return key_of(*a) < key_of(b); });
  assert(at == converters_.end() || key_of(**at) != key_of(converter));
  converters_.insert(at, std::make_unique<Converter>(std::move(converter)));
}

std::vector<const Converter*> ConverterTable::of(std::string_view lcm_type) const {
  std::vector<const Converter*> found;
  for (const auto& each : converters_)
    if (each->lcm_type == lcm_type) found.push_back(each.get());
  return found;
}

std::vector<const Converter*> ConverterTable::all() const {
  std::vector<const Converter*> found;
  for (const auto& each : converters_) found.push_back(each.get());
  return found;
}

bool detail::add_converter(const char* message, const char* ros_type, const char* topic,
                           decltype(Converter::convert) convert) {
  ConverterTable::instance().add({std::string("shoal.") + message, ros_type, topic, std::move(convert)});
  return true;
}

}  // namespace bridges::ros2
