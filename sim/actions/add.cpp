// SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include "sim/actions/random_choice.hpp"
#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/director/stage.hpp"
#include "sim/model/object_config.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/vehicle/entities.hpp"

namespace sim {

namespace {

class AddAction final : public Action {
 public:
  static constexpr const char* meaning = "adds an object";
  static constexpr const char* main_key = "object";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    if (in.describing())
      describe_object(in, main);
    else
      read_object(in, main);
    where_.read(in);
  }

  void add_objects(std::vector<const ObjectConfig*>& objects) const override {
    if (object_) objects.push_back(object_.get());
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
  static void describe_object(ParamReader& in, const char* key) {
    ParamInfo info;
    info.key = key;
    info.type = "text or map";
    info.meaning = "name of an object of the world that does not exist, or a map with the keys of a new object";
    info.required = true;
    in.describe(std::move(info));
  }

  void read_object(ParamReader& in, const char* key) {
    in.require(key);
    if (const ConfigNode* node = in.child(key); node == nullptr || node->kind != ConfigNode::Kind::map)
      return in.read_reference(key, name_, "object", "");
    auto added = std::make_shared<ObjectConfig>();
    in.read(key, *added, "");
    if (added->count != 1) in.error(key, "'count' does not apply to an object that an action adds");
    name_ = added->name;
    object_ = std::move(added);
  }

  PlaceChoice where_;
  std::string name_;
  std::shared_ptr<const ObjectConfig> object_;  ///< null: the object is in the world file
};

SHOAL_ACTION("add", AddAction);

}  // namespace

}  // namespace sim
