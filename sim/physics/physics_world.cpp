// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/physics_world.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "sim/config/message_text.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/physics/physics_world_impl.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

PhysicsWorld::PhysicsWorld(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                           const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                           std::uint64_t seed) {
  start_again(config, materials, contacts, categories, seed);
}

void PhysicsWorld::start_again(const PhysicsConfig& config, const std::vector<MaterialConfig>& materials,
                               const std::vector<ContactConfig>& contacts, const std::vector<std::string>& categories,
                               std::uint64_t seed) {
  discard();
  start_ode();
  impl_ = std::make_unique<Impl>(config, ContactTable(materials, contacts), seed);
  add_categories(categories);
  use_threads(threads_);
  impl_->scene = make_world_scene(config.rays, impl_->moves);
}

PhysicsWorld::~PhysicsWorld() {
  discard();
}

void PhysicsWorld::discard() {
  if (!impl_ || !impl_->broken) return impl_.reset();
  // A world in which a step failed triggers ODE's asserts when it is destroyed.  It is therefore kept, reachable for
  // leak checkers.
  impl_->scene.reset();
  static std::mutex mutex;
  static std::vector<Impl*>& left_behind = *new std::vector<Impl*>;  // also after the end of main()
  const std::lock_guard lock(mutex);
  left_behind.push_back(impl_.release());
}

bool PhysicsWorld::anchored(int group) const {
  return impl_->group(group).anchored;
}

void PhysicsWorld::visit_state(StateArchive& archive) {
  double gravity = gravity_mps2();
  bool was_set = impl_->gravity_was_set;
  archive.unhashed(was_set);
  archive(gravity);
  if (archive.restoring()) {
    if (!std::isfinite(gravity)) archive.fail("gravity that is not finite");
    set_gravity(was_set ? gravity : impl_->config.gravity_mps2);
    impl_->gravity_was_set = was_set;
    ++impl_->moves.moving;
    impl_->plan_leaps_anew();
  }
  archive.unhashed(impl_->contact_reports, impl_->counts, impl_->quick_steps);
  const auto known = [&](int part) { return part >= 0 && part < static_cast<int>(impl_->parts.size()); };
  for (const ContactReport& contact : impl_->contact_reports)
    if (!known(contact.parts[0]) || !known(contact.parts[1])) archive.fail("a contact of a part that does not exist");
}

void PhysicsWorld::add_surfaces(const std::vector<MaterialConfig>& materials,
                                const std::vector<ContactConfig>& contacts) {
  impl_->collider.add_surfaces(materials, contacts);
}

void PhysicsWorld::add_categories(const std::vector<std::string>& names) {
  std::vector<std::string> all = impl_->categories;
  for (const std::string& name : names)
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  if (all.size() > 31) throw std::length_error("more than 31 categories of parts");
  impl_->categories = std::move(all);
}

void PhysicsWorld::set_gravity(double gravity_mps2) {
  if (!std::isfinite(gravity_mps2)) throw std::invalid_argument("gravity is not finite");
  impl_->gravity_mps2 = gravity_mps2;
  impl_->gravity_was_set = true;
  impl_->collider.set_gravity(gravity_mps2);
  for (const auto& shard : impl_->shards)
    if (shard) dWorldSetGravity(shard->world.get(), 0, 0, -gravity_mps2);
}

double PhysicsWorld::gravity_mps2() const {
  return impl_->gravity_mps2;
}

void PhysicsWorld::watch_contacts(int group) {
  impl_->group(group);
  impl_->collider.watch(group);
}
void PhysicsWorld::unwatch_contacts(int group) {
  impl_->group(group);
  impl_->collider.unwatch(group);
}
std::span<const ContactReport> PhysicsWorld::contacts() const {
  return impl_->contact_reports;
}

std::optional<int> PhysicsWorld::find_part(int group, std::string_view body_slash_part) const {
  const Impl::Group& owner = impl_->group(group);
  for (const int part : owner.parts)
    if (std::string_view(impl_->parts[part].name).substr(owner.name.size() + 1) == body_slash_part) return part;
  return std::nullopt;
}

void PhysicsWorld::use_threads(int threads) {
  threads_ = threads;
  impl_->threads = threads == 1 ? nullptr : std::make_unique<ThreadPool>(threads);
}

void PhysicsWorld::step(std::int64_t step_number) {
  impl_->islands.begin_step();
  impl_->deal_pairs(step_number);
  impl_->step_shards(step_number);
  ++impl_->moves.moving;
  impl_->collider.note_positions(impl_->moves);
  impl_->find_leaps();
}

bool PhysicsWorld::Impl::out_of_bounds(const Body& body) const {
  const auto square = [](const dReal* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; };
  // Comparisons with NaN are false, so that NaN is out of bounds.  Angular velocity has no configured bound, but must
  // be finite.
  return !(square(body.v_WC_W_) <= config.max_speed_mps * config.max_speed_mps &&
           square(body.p_WC_) <= config.max_distance_m * config.max_distance_m && square(body.w_WB_W_) < 1e300);
}

void PhysicsWorld::Impl::fault(const Body& body, std::int64_t step_number) const {
  const double speed = to_eigen(body.v_WC_W_).norm(), distance = to_eigen(body.p_WC_).norm();
  std::string text = "angular velocity is not finite";
  if (!std::isfinite(distance))
    text = "position is not finite";
  else if (!std::isfinite(speed))
    text = "velocity is not finite";
  else if (speed > config.max_speed_mps)
    text = fmt::format("speed {:.2g} m/s is over {:g} m/s", speed, config.max_speed_mps);
  else if (distance > config.max_distance_m)
    text = fmt::format("distance {:.3g} m from the origin is over {:g} m", distance, config.max_distance_m);
  throw PhysicsFault("body '" + body.name() + "': " + text + " at step " + std::to_string(step_number));
}

/// Names the lightest and the heaviest body of the island with the largest mass ratio: the usual cause when the solver
/// fails with finite inputs.  Returns the beginning of an error message, or an empty text.
std::string PhysicsWorld::Impl::suspects(const Shard& shard) {
  std::map<int, std::pair<const Body*, const Body*>> islands_by_first;  // lightest, heaviest
  for (const int group : shard.groups)
    for (const Body* body : groups[group].moving) {
      if (!body->free()) continue;
      auto& [lightest, heaviest] = islands_by_first[islands.first_of(body->number_)];
      if (lightest == nullptr || body->mass_kg_ < lightest->mass_kg_) lightest = body;
      if (heaviest == nullptr || body->mass_kg_ > heaviest->mass_kg_) heaviest = body;
    }
  // Find the island with the largest mass ratio.
  const auto ratio = [](const auto& island) { return island.second.second->mass_kg_ / island.second.first->mass_kg_; };
  const auto worst = std::max_element(islands_by_first.begin(), islands_by_first.end(),
                                      [&](const auto& a, const auto& b) { return ratio(a) < ratio(b); });
  if (worst == islands_by_first.end()) return "";
  const auto [lightest, heaviest] = worst->second;
  if (lightest == heaviest) return "body '" + lightest->name() + "': ";
  return "body '" + lightest->name() + "' of " + number_text(lightest->mass_kg_) +
         " kg, in contact or joined with body '" + heaviest->name() + "' of " + number_text(heaviest->mass_kg_) +
         " kg: ";
}

std::pair<std::string, double> PhysicsWorld::deepest_overlap(int group) const {
  impl_->bring_parts();
  const Collider::Overlap overlap = impl_->collider.deepest_overlap(group, impl_->group(group).parts, impl_->moves);
  return {overlap.group < 0 ? "" : group_name(overlap.group), overlap.depth_m};
}

const Scene& PhysicsWorld::scene() const {
  return *impl_->scene;
}
std::span<const std::unique_ptr<Body>> PhysicsWorld::bodies() const {
  return impl_->bodies;
}
std::span<const std::unique_ptr<Joint>> PhysicsWorld::joints() const {
  return impl_->joints;
}
std::span<const PartInfo> PhysicsWorld::parts() const {
  return impl_->parts;
}
int PhysicsWorld::materials() const {
  return impl_->collider.table().materials();
}
const MaterialConfig& PhysicsWorld::material(int number) const {
  return impl_->collider.table().material(number);
}
Pose PhysicsWorld::X_WP(int part) const {
  const PartInfo& info = impl_->parts[static_cast<std::size_t>(part)];
  return impl_->bodies[static_cast<std::size_t>(info.body)]->X_WB() * info.X_BP;
}
std::optional<Eigen::AlignedBox3d> PhysicsWorld::bounds_W(int part) const {
  if (impl_->parts[static_cast<std::size_t>(part)].plane) return std::nullopt;
  if (const auto ground = impl_->terrains.find(part); ground != impl_->terrains.end()) {
    // The geom extends far below the surface, so use the vertices.
    Eigen::AlignedBox3d box;
    const Pose X_WP_now = X_WP(part);
    for (const Vector3d& vertex : ground->second->mesh.vertices_m) box.extend(X_WP_now * vertex);
    return box;
  }
  impl_->bring_parts();
  dReal sides[6];
  dGeomGetAABB(impl_->collider.parts()[static_cast<std::size_t>(part)].geom, sides);
  return Eigen::AlignedBox3d(Vector3d(sides[0], sides[2], sides[4]), Vector3d(sides[1], sides[3], sides[5]));
}
const std::string& PhysicsWorld::group_name(int group) const {
  return impl_->groups.at(static_cast<std::size_t>(group)).name;
}
const StepCounts& PhysicsWorld::last_step() const {
  return impl_->counts;
}
IslandInfo PhysicsWorld::largest_island() const {
  constexpr std::size_t max_names = 1000;
  IslandInfo found;
  int first = -1;
  impl_->for_each_moving([&](const Body& body) {
    const int rows = impl_->islands.knows(body.number_) ? impl_->islands.rows_of(body.number_) : 0;
    if (rows > found.rows) found.rows = rows, first = impl_->islands.first_of(body.number_);
  });
  for (const auto& body : impl_->bodies) {
    if (first < 0 || !body || body->fixed() || !impl_->islands.knows(body->number_)) continue;
    if (impl_->islands.first_of(body->number_) != first) continue;
    ++found.body_count;
    if (found.bodies.size() < max_names) found.bodies.push_back(body->name());
  }
  return found;
}
std::int64_t PhysicsWorld::quick_steps() const {
  return impl_->quick_steps;
}
double PhysicsWorld::step_s() const {
  return impl_->config.step_s;
}
std::uint32_t PhysicsWorld::category_bit(const std::string& name) const {
  return impl_->category_bit(name);
}

std::uint32_t PhysicsWorld::Impl::category_bit(const std::string& name) const {
  const auto at = std::find(categories.begin(), categories.end(), name);
  if (at == categories.end()) throw std::out_of_range("unknown category '" + name + "'");
  return 1u << (at - categories.begin());
}

std::uint32_t PhysicsWorld::Impl::category_bits(const std::vector<std::string>& names) const {
  if (names.empty()) return ~0u;
  std::uint32_t bits = 0;
  for (const std::string& name : names) bits |= category_bit(name);
  return bits;
}

}  // namespace sim
