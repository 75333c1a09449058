// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/sdf/sdf_reader.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace tools {

namespace {

constexpr std::size_t max_models = 300;  // nested and included ones together
constexpr std::size_t max_nesting = 20;  // of includes

std::string named(const std::string& kind, const std::string& name) {
  return kind + " '" + sim::shortened(sim::printable(name)) + "'";
}

std::string resolved(const std::string& path) {
  std::error_code error;
  return std::filesystem::weakly_canonical(path, error).string();
}

/// Minor number of a version such as 1.12.  Refuses others.
int minor_version(const XmlElement& sdf, std::vector<ImportNote>& notes) {
  const std::string version = sdf.text("version");
  const std::optional<int> minor =
      version.starts_with("1.") ? sim::exact_number<int>(std::string_view(version).substr(2)) : std::nullopt;
  if (!minor || *minor < 4)
    sdf.refuse("'version' must be 1.4 to 1.12, got '" + sim::shortened(sim::printable(version)) + "'");
  if (*minor > 12) notes.push_back({sdf.place(), "SDF " + version + " is read as 1.12"});
  return *minor;
}

/// Pose and other changes that an `<include>` makes to its model.
struct Inclusion {
  std::optional<XmlElement> element;  ///< none: the model stands in its parent
  std::string name;                   ///< empty: as in its file
  bool merges = false;                ///< its contents become those of the parent
};

/// Collects the frames, links and joints of a model and of those in it.
class SdfModelReader {
 public:
  SdfModelReader(SdfFiles& files, SdfModel& model, const std::string& path)
      : files_(files), model_(model), open_{resolved(path)} {}

  /// Adds the model of the vehicle, whose frame becomes that of the vehicle.
  void add_root(const XmlElement& element, int version, const std::string& name) {
    const SdfScope scope{"", "__model__"};
    model_.robot.name = name;
    model_.is_static = element.child_flag("static", false);
    const SdfPose pose = read_sdf_pose(element);
    if (!pose.X.isApprox(sim::Pose::Identity(), 1e-12))
      model_.robot.notes.push_back({element.child("pose")->place(), named("model", name) +
                                                                        ": its <pose> is not imported: a world places "
                                                                        "its vehicles"});
    const std::string link = canonical_link_of(element, scope);
    model_.frames.add("__model__", {.X = sim::Pose::Identity(),
                                    .relative_to = "",
                                    .attached_to = link,
                                    .placed_by = "",
                                    .place = element.place()});
    add_content(element, scope, version);
    model_.canonical_link = link.empty() ? "" : model_.frames.link_of(link, element.place());
  }
  /// Adds the model of an `<include>` that stands alone, such as in a world.
  void add_included_root(const XmlElement& include) {
    const auto [element, version] = open_include(include);
    add_root(element, version, include.child_text("name", element.text("name", "")));
    if (include.child_flag("static", false)) model_.is_static = true;
    add_additions(include, {"", "__model__"});
    open_.pop_back();
  }
  /// Reads links and joints, now that all frames are known.
  void finish() {
    for (auto& [element, scope] : links_) model_.robot.links.push_back(read_sdf_link(element, scope, model_));
    for (const auto& [element, scope, version] : joints_)
      if (auto joint = read_sdf_joint(element, scope, version, model_)) model_.joints.push_back(std::move(*joint));
    for (const auto& [element, scope] : sensors_) {
      const std::string link = scope.full(element.text("element_id"));
      model_.frames.link_of(link, element.place());
      model_.sensors.push_back({element, link, "", pose_in_link(element, link, scope, model_)});
    }
  }

 private:
  struct PendingJoint {
    XmlElement element;
    SdfScope scope;
    int version;
  };

  /// Full name of the link of a model, of which it may have none.
  std::string canonical_link_of(const XmlElement& element, const SdfScope& scope) {
    const std::string given = element.text("canonical_link", "");
    if (!given.empty()) return scope.full(given);
    const std::vector<XmlElement> links = element.children("link");
    if (!links.empty()) return scope.full(links.front().text("name"));
    const std::vector<XmlElement> models = element.children("model");
    return models.empty() ? "" : scope.full(models.front().text("name"));
  }

  void add_content(const XmlElement& element, const SdfScope& scope, int version) {
    note_rest(element,
              {"pose", "link", "joint", "frame", "model", "include", "plugin", "static", "self_collide", "enable_wind",
               "allow_auto_disable"},
              model_.robot.notes);
    for (const XmlElement& frame : element.children("frame")) add_frame(frame, scope);
    for (const XmlElement& link : element.children("link")) add_link(link, scope);
    for (const XmlElement& joint : element.children("joint")) add_joint(joint, scope, version);
    for (const XmlElement& nested : element.children("model")) add_nested(nested, nested, {}, scope, version);
    for (const XmlElement& include : element.children("include")) add_include(include, scope);
    add_plugins(element, scope);
  }
  void add_plugins(const XmlElement& element, const SdfScope& scope) {
    for (const XmlElement& plugin : element.children("plugin")) model_.plugins.push_back({plugin, scope});
  }
  void add_frame(const XmlElement& frame, const SdfScope& scope) {
    const SdfPose pose = read_sdf_pose(frame);
    const std::string attached = frame.text("attached_to", "");
    const std::string attached_to = attached.empty() ? scope.model_frame : scope.full(attached);
    model_.frames.add(scope.full(frame.text("name")),
                      {.X = pose.X,
                       .relative_to = pose.relative_to.empty() ? attached_to : scope.full(pose.relative_to),
                       .attached_to = attached_to,
                       .placed_by = "",
                       .place = frame.place()});
  }
  void add_link(XmlElement link, const SdfScope& scope) {
    const std::string name = scope.full(link.text("name"));
    const SdfPose pose = read_sdf_pose(link);
    model_.frames.add(name, {.X = pose.X,
                             .relative_to = pose.relative_to.empty() ? scope.model_frame : scope.full(pose.relative_to),
                             .attached_to = "",
                             .placed_by = "",
                             .place = link.place()});
    link.set_who(named("link", name));
    if (links_.size() >= max_robot_links)
      link.refuse(fmt::format("a robot must have at most {} links", max_robot_links));
    links_.emplace_back(link, scope);
  }
  void add_joint(const XmlElement& joint, const SdfScope& scope, int version) {
    const SdfPose pose = read_sdf_pose(joint);
    const std::string child = scope.full(joint.required_child("child").content());
    model_.frames.add(scope.full(joint.text("name")),
                      {.X = pose.X,
                       .relative_to = pose.relative_to.empty() ? child : scope.full(pose.relative_to),
                       .attached_to = child,
                       .placed_by = "",
                       .place = joint.place()});
    joints_.push_back({joint, scope, version});
  }
  /// Adds a model in another one.  `posed`: the element with its pose, the model or its `<include>`.
  void add_nested(const XmlElement& element, const XmlElement& posed, const Inclusion& inclusion,
                  const SdfScope& parent, int version) {
    if (++models_ > max_models) element.refuse(fmt::format("a robot must have at most {} models in it", max_models));
    const std::string name = inclusion.name.empty() ? element.text("name") : inclusion.name;
    const SdfScope scope = inclusion.merges ? SdfScope{parent.prefix, parent.full("_merged__" + name + "__model__")}
                                            : SdfScope{parent.prefix + name + "::", parent.full(name)};
    const SdfPose pose = read_sdf_pose(posed);
    const std::string placed_by =
        inclusion.element ? inclusion.element->child_text("placement_frame", element.text("placement_frame", ""))
                          : element.text("placement_frame", "");
    model_.frames.add(scope.model_frame,
                      {.X = pose.X,
                       .relative_to = pose.relative_to.empty() ? parent.model_frame : parent.full(pose.relative_to),
                       .attached_to = canonical_link_of(element, scope),
                       .placed_by = placed_by.empty() ? "" : scope.full(placed_by),
                       .place = posed.place()});
    add_content(element, scope, version);
    if (inclusion.element) add_additions(*inclusion.element, scope);
  }
  void add_include(const XmlElement& include, const SdfScope& scope) {
    const auto [element, version] = open_include(include);
    const std::string merge = include.text("merge", "false");
    note_rest(include, {"uri", "name", "pose", "placement_frame", "plugin", "static", "experimental:params"},
              model_.robot.notes);
    // Without a pose of the include that of the model applies.
    const XmlElement& posed = include.child("pose") ? include : element;
    add_nested(element, posed, {include, include.child_text("name"), merge == "true" || merge == "1"}, scope, version);
    open_.pop_back();
  }
  /// Adds what an `<include>` adds to its model: plugins, and sensors as the models of LRAUVs have them.
  void add_additions(const XmlElement& include, const SdfScope& scope) {
    add_plugins(include, scope);
    const std::optional<XmlElement> parameters = include.child("experimental:params");
    if (!parameters) return;
    for (const XmlElement& added : parameters->children()) {
      const bool is_sensor = added.name() == "sensor" && added.text("action", "") == "add" && added.has("element_id");
      if (is_sensor)
        sensors_.emplace_back(added, scope);
      else
        model_.robot.notes.push_back(
            {added.place(), fmt::format("<{}> of <experimental:params> is not imported", added.name())});
    }
  }
  std::pair<XmlElement, int> open_include(const XmlElement& include) {
    const std::string path = files_.find_model(include.required_child("uri"));
    if (std::find(open_.begin(), open_.end(), path) != open_.end())
      include.refuse("this file includes itself: '" + sim::shortened(sim::printable(path), 200) + "'");
    if (open_.size() >= max_nesting) include.refuse("files include each other too deeply");
    open_.push_back(path);
    const XmlFile& file = files_.open(path);
    const std::optional<XmlElement> model = file.root().child("model");
    if (!model) include.refuse("the file that it includes has no <model>");
    return {*model, minor_version(file.root(), model_.robot.notes)};
  }
  SdfFiles& files_;
  SdfModel& model_;
  std::vector<std::pair<XmlElement, SdfScope>> links_;
  std::vector<std::pair<XmlElement, SdfScope>> sensors_;
  std::vector<PendingJoint> joints_;
  std::vector<std::string> open_;  ///< files in which the present element stands
  std::size_t models_ = 0;
};

/// Name of a model or include of a world.
std::string name_in_world(const XmlElement& element) {
  if (element.name() == "model") return element.text("name");
  return element.child_text("name", std::filesystem::path(element.child_text("uri")).filename().string());
}

/// The model of a file or of its world: by its name, or the only one.
XmlElement chosen_model(const XmlElement& sdf, const std::string& name, std::vector<ImportNote>& notes) {
  const std::optional<XmlElement> world = sdf.child("world");
  const XmlElement& parent = world ? *world : sdf;
  std::vector<XmlElement> models = parent.children("model");
  if (world)
    for (const XmlElement& include : parent.children("include")) models.push_back(include);
  if (models.empty()) parent.refuse(fmt::format("<{}> must have a <model>", parent.name()));
  std::vector<std::string> names;
  for (const XmlElement& model : models) names.push_back(name_in_world(model));
  auto found = models.begin();
  if (!name.empty())
    found = std::find_if(models.begin(), models.end(),
                         [&](const XmlElement& model) { return name_in_world(model) == name; });
  if (found == models.end() || (name.empty() && models.size() > 1))
    parent.refuse(fmt::format("choose a model by --model: {}", sim::list_text(names)));
  if (world)
    notes.push_back({world->place(), "only " + named("model", name_in_world(*found)) +
                                         " of the <world> is imported: write the rest as a world file"});
  return *found;
}

}  // namespace

void note_rest(const XmlElement& element, std::initializer_list<std::string_view> known,
               std::vector<ImportNote>& notes) {
  static const std::map<std::string_view, std::string_view> reasons = {
      {"surface", "friction is that of `contacts:` between materials"},
      {"light", "a vehicle has `led` devices"},
      {"battery", "write a `battery` device"},
      {"audio_source", "write a `speaker` device"},
      {"audio_sink", "write a `microphone` device"},
      {"particle_emitter", "there are no particles"},
      {"projector", "there are no projectors"},
      {"gripper", "write its joints"},
      {"plugin", "plugins of parts are those of Gazebo"}};
  const std::string of = element.who().empty() ? "" : element.who() + ": ";
  for (const XmlElement& child : element.children()) {
    if (std::find(known.begin(), known.end(), child.name()) != known.end()) continue;
    const auto reason = reasons.find(child.name());
    notes.push_back({child.place(),
                     fmt::format("{}<{}> is not imported: {}", of, sim::shortened(sim::printable(child.name())),
                                 reason == reasons.end() ? "nothing in a vehicle file is like it" : reason->second)});
  }
}

SdfModel read_sdf(SdfFiles& files, const std::string& path, const std::string& model_name) {
  SdfModel model;
  const XmlFile& file = files.open(path);
  const XmlElement root = file.root();
  const int version = minor_version(root, model.robot.notes);
  file.note_document_type(model.robot.notes);
  const XmlElement chosen = chosen_model(root, model_name, model.robot.notes);
  SdfModelReader reader(files, model, path);
  if (chosen.name() == "include")
    reader.add_included_root(chosen);
  else
    reader.add_root(chosen, version, chosen.text("name"));
  model.robot.comment = file.leading_comment();
  reader.finish();
  if (model.robot.links.empty()) chosen.refuse("a model needs a <link>");
  resolve_joints(model);
  return model;
}

}  // namespace tools
