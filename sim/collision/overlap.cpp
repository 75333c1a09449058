// SPDX-License-Identifier: BSD-3-Clause
// How deep a group penetrates others, for entities that are placed.  A first request looks at the rounded positions of
// all bodies, which is fast enough beside 10 000 vehicles; further ones of the same poses, as those of all vehicles at
// the start, use an index of all parts.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/collision/collider.hpp"
#include "sim/ode/find_contacts.hpp"
#include "sim/ode/ode_math.hpp"

namespace sim {

namespace {

AlignedBox box_of(dGeomID geom) {
  dReal b[6];
  dGeomGetAABB(geom, b);
  return {{b[0], b[2], b[4]}, {b[1], b[3], b[5]}};
}

bool is_endless(const AlignedBox& box) {
  return !box.low.allFinite() || !box.high.allFinite();
}

int number_of(dGeomID geom) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(dGeomGetData(geom)));
}

}  // namespace

/// Notes what requests need of a group that was completed: it has the same shape from now on.
void Collider::note_places(Group& closed) {
  ++changes_;
  if (!closed.fixed.empty()) fixed_boxes_.clear();
  for (const dGeomID geom : closed.fixed) fixed_parts_.push_back(number_of(geom));
  closed.has_fixed |= !closed.fixed.empty();
  const int count = dSpaceGetNumGeoms(closed.space.get());
  std::vector<std::pair<int, double>> reach_m;  // of each body; few
  for (int i = 0; i < count; ++i) {
    const dGeomID geom = dSpaceGetGeom(closed.space.get(), i);
    const int body = parts_[number_of(geom)].body;
    const AlignedBox box = box_of(geom);
    const Vector3d from_W = Eigen::Map<const Vector3d>(bodies_[body].position);
    const Vector3d farthest = (box.high - from_W).cwiseAbs().cwiseMax((box.low - from_W).cwiseAbs());
    auto at = std::find_if(reach_m.begin(), reach_m.end(), [&](const auto& each) { return each.first == body; });
    if (at == reach_m.end()) at = reach_m.insert(at, {body, 0.0});
    at->second = std::max(at->second, farthest.norm());
  }
  for (const auto& [body, m] : reach_m) {
    places_.set_reach(body, m);
    places_.set_position(body, bodies_[body].position);
  }
}

void Collider::discard_places(bool of_fixed_parts) {
  ++changes_;
  if (!of_fixed_parts) return;
  fixed_boxes_.clear();
  std::erase_if(fixed_parts_, [&](int part) { return parts_[part].geom == nullptr; });
}

void Collider::build_index() const {
  std::vector<AlignedBox> boxes;
  near_.parts.clear();
  near_.endless.clear();
  for (int number = 0; number < static_cast<int>(parts_.size()); ++number) {
    if (parts_[number].geom == nullptr) continue;
    const AlignedBox box = box_of(parts_[number].geom);
    if (is_endless(box)) {
      near_.endless.push_back(number);
      continue;
    }
    near_.parts.push_back(number);
    boxes.push_back(box);
  }
  near_.grid.build(boxes);
  near_.built = true;
}

std::vector<AlignedBox> Collider::fixed_boxes() const {
  std::vector<AlignedBox> boxes;
  for (const int part : fixed_parts_) boxes.push_back(box_of(parts_[part].geom));
  return boxes;
}

/// Returns the parts whose boxes may meet a box, ascending.
std::vector<int> Collider::parts_near(const AlignedBox& box) const {
  std::vector<int> near;
  const auto add = [&](dGeomID geom) {
    if (box.meets(box_of(geom))) near.push_back(number_of(geom));
  };
  if (near_.built) {
    near_.grid.find(box, [&](int index) { near.push_back(near_.parts[static_cast<std::size_t>(index)]); });
    for (const int part : near_.endless) add(parts_[part].geom);
  } else {
    places_.find_near(box.center(), box.half_extents().norm(), [&](int body) {
      for (dGeomID geom = dBodyGetFirstGeom(bodies_[body].ode); geom != nullptr; geom = dBodyGetNextGeom(geom))
        add(geom);
    });
    for (std::size_t i = 0; i < fixed_parts_.size(); ++i)
      if (box.meets(fixed_boxes_[i])) near.push_back(fixed_parts_[i]);
  }
  std::sort(near.begin(), near.end());
  return near;
}

Collider::Overlap Collider::deepest_overlap(int group, std::span<const int> own_parts, const SceneMoves& moves) const {
  if (near_.moves.fixed != moves.fixed || fixed_boxes_.size() != fixed_parts_.size()) fixed_boxes_ = fixed_boxes();
  const bool repeated =
      near_.moves.moving == moves.moving && near_.moves.fixed == moves.fixed && near_.changes == changes_;
  near_.moves = moves;
  near_.changes = changes_;
  if (!repeated) near_.built = false;
  if (repeated && !near_.built) build_index();
  if (!near_.built && !has_noted_positions(moves)) {
    for (std::size_t body = 0; body < bodies_.size(); ++body)
      if (bodies_[body].position != nullptr) places_.set_position(static_cast<int>(body), bodies_[body].position);
    noted_moves_ = moves.moving;
  }
  // Collect the boxes of the group.
  std::vector<std::pair<const CollisionPart*, AlignedBox>> own;
  for (const int number : own_parts)
    if (parts_[number].geom != nullptr) own.emplace_back(&parts_[number], box_of(parts_[number].geom));
  if (own.empty()) return {};
  AlignedBox around = own.front().second;
  for (const auto& [part, box] : own) around = {around.low.cwiseMin(box.low), around.high.cwiseMax(box.high)};
  // Find the maximum contact depth over all pairs.
  Overlap deepest;
  std::array<dContactGeom, 8> touching;
  const std::vector<int> near = parts_near(around);
  for (const auto& [part, box] : own)
    for (const int number : near) {
      const CollisionPart& other = parts_[number];
      if (other.group == group) continue;
      if ((part->category & other.collides_with) == 0 || (other.category & part->collides_with) == 0) continue;
      if (!box.meets(box_of(other.geom))) continue;
      const int count = find_contacts(part->geom, other.geom, static_cast<int>(touching.size()), touching.data(),
                                      sizeof(dContactGeom));
      for (int i = 0; i < count; ++i)
        if (touching[static_cast<std::size_t>(i)].depth > deepest.depth_m)
          deepest = {other.group, touching[static_cast<std::size_t>(i)].depth};
    }
  return deepest;
}

}  // namespace sim
