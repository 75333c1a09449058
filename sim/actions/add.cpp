// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "sim/actions/place_choice.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/director/stage.hpp"
#include "sim/model/object_config.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/vehicle/world_error.hpp"

namespace sim {

namespace {

/// Adds an object of the world file that is not there, or one that is written in the action.
class AddAction final : public Action {
 public:
  static constexpr const char* meaning =
      "an object of the world that is not there, or a new one with the keys of an object";

  void read(ParamReader& in) override {
    where_.read(in);
    if (in.describing()) return;
    if (in.child("add")->kind != ConfigNode::Kind::map) {
      in.read_reference("add", name_, "object", "");
      return;
    }
    auto added = std::make_shared<ObjectConfig>();
    in.read("add", *added, "");
    if (added->count != 1) in.error("add", "'count' does not belong to an object that an action adds");
    name_ = added->name;
    object_ = std::move(added);
  }

  void carry_out(const ActionRun& run) const override {
    if (object_) {
      const Pose X_WE = make_pose(object_->position_m, object_->rpy_rad);
      run.stage.add_object(*object_, name_, where_.choose(X_WE, run.random));
      return;
    }
    const Script::ListedObject* listed = run.script.find_listed(name_);
    if (listed == nullptr) throw WorldError("the world file has no object '" + name_ + "' to add");
    run.stage.add_object(*listed->config, name_, where_.choose(listed->X_WE, run.random));
  }

 private:
  PlaceChoice where_;
  std::string name_;
  std::shared_ptr<const ObjectConfig> object_;  ///< null: it is in the world file
};

SHOAL_ACTION("add", AddAction);

}  // namespace

}  // namespace sim
