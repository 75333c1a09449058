#include "sim/script/touch_watch.hpp"

#include "sim/world/world.hpp"

namespace sim {

std::unique_ptr<ConditionWatch> make_touch_watch(const Condition&, World&) {
  return nullptr;
}

}  // namespace sim
