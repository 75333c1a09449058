// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/scene_names.hpp"

#include <algorithm>
#include <unordered_map>

#include "bridges/base/json_text.hpp"

namespace viewer {

void SceneNames::add(std::string_view scene) {
  const nlohmann::json json = nlohmann::json::parse(scene, nullptr, false);
  if (!json.is_object()) return;
  try {
    std::vector<std::string> names;
    for (const nlohmann::json& body : json.at("bodies"))
      if (!body.value("fixed", false)) names.push_back(body.value("name", ""));
    newest_ = json.at("revision").get<std::uint32_t>();
    names_[newest_] = std::move(names);
    if (names_.size() > max_scenes) names_.erase(names_.begin());
  } catch (const nlohmann::json::exception&) {  // the page reports it
  }
}

const std::vector<std::string>& SceneNames::of(std::uint32_t revision) const {
  static const std::vector<std::string> none;
  const auto found = names_.find(revision);
  return found == names_.end() ? none : found->second;
}

void SceneNames::arrange(std::uint32_t revision, std::span<const std::byte> bodies, StateFrame& frame) const {
  if (revision == newest_)
    frame.add(bodies);
  else
    viewer::arrange(bodies, of(revision), of(newest_), frame);
}

void arrange(std::span<const std::byte> bodies, const std::vector<std::string>& names,
             const std::vector<std::string>& order, StateFrame& frame) {
  const std::size_t count = std::min(bodies.size() / StateFrame::body_bytes, names.size());
  // The usual case, since a scene rarely changes.
  if (names == order && count == order.size()) return frame.add(bodies.first(count * StateFrame::body_bytes));
  std::unordered_map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < count; ++i) index.emplace(names[i], i);
  for (const std::string& name : order) {
    const auto found = index.find(name);
    if (found == index.end())
      frame.add_unknown();
    else
      frame.add(bodies.subspan(found->second * StateFrame::body_bytes, StateFrame::body_bytes));
  }
}

}  // namespace viewer
