#pragma once

#include <string>
#include <vector>

namespace sim {

class Vehicle;
class World;

/// A line when vehicles that are in water, or float on it, have no ground below them: what looks down from there sees
/// nothing.
std::vector<std::string> bottom_warnings(const World& world);
/// The same for one of them.
std::vector<std::string> bottom_warnings(const World& world, const Vehicle& vehicle);

}  // namespace sim
