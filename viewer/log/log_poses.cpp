// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/log_poses.hpp"

#include "shoal/message_codec.hpp"
#include "shoal/sim_scene_t.hpp"
#include "viewer/log/scene_names.hpp"

namespace viewer {

bool LogPoses::read_names(std::uint64_t offset) {
  reader_.seek(offset);
  bridges::LogEventView event;
  if (!reader_.next(event) || event.channel != "sim.scene") return false;
  const auto scene = shoal::decode<shoal::sim_scene_t>(event.payload, shoal::Finite::required);
  SceneNames names;
  names.add(scene.scene);
  names_ = names.of(names.newest());
  return true;
}

const LogPoses::Poses* LogPoses::at(std::int64_t time_us) {
  try {
    const LogIndex::Mark mark = index_.bodies_at(time_us), scene = index_.scene_at(mark.time_us);
    if (bodies_at_ == mark.offset) return &poses_;
    bodies_at_.reset();
    if (scene_at_ != scene.offset) {
      scene_at_.reset();
      if (!read_names(scene.offset)) return nullptr;
      scene_at_ = scene.offset;
    }
    // The poses, as the page gets them.
    reader_.seek(mark.offset);
    bridges::LogEventView event;
    if (!reader_.next(event) || event.channel != "sim.bodies") return nullptr;
    poses_.message = shoal::decode<shoal::sim_bodies_t>(event.payload, shoal::Finite::required);
    frame_.begin({});
    for (std::size_t i = 0; i < poses_.message.position_m.size(); ++i) {
      const std::vector<double>& p = poses_.message.position_m[i];
      const std::vector<float>& q = poses_.message.orientation[i];
      frame_.add({p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]});
    }
    poses_.time_us = mark.time_us;
    poses_.names = &names_;
    poses_.bodies = frame_.bodies();
    bodies_at_ = mark.offset;
    return &poses_;
  } catch (const shoal::MessageError&) {  // damaged
    return nullptr;
  }
}

}  // namespace viewer
