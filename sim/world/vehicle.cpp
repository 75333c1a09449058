#include "sim/world/vehicle.hpp"

#include <stdexcept>

namespace sim {

namespace {

template <typename Part>
Part& find_named(const std::vector<std::pair<std::string, Part*>>& all, const std::string& name) {
  for (const auto& [each, part] : all)
    if (each == name) return *part;
  throw std::out_of_range(name);
}

}  // namespace

Body& Vehicle::body(const std::string& name) const {
  return find_named(bodies_, name);
}

Joint& Vehicle::joint(const std::string& name) const {
  return find_named(joints_, name);
}

}  // namespace sim
