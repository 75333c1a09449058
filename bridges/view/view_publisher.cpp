// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/view/view_publisher.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "bridges/view/scene_text.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/sim_asset_t.hpp"

namespace bridges {

namespace {

/// Shortest time between two scenes: additions in every step must not fill the bus.
constexpr sim::Time min_scene_interval{500'000};

const char* kind_word(sim::Signal::Kind kind) {
  switch (kind) {
    case sim::Signal::Kind::message:
      return "message";
    case sim::Signal::Kind::ping:
      return "ping";
    case sim::Signal::Kind::answer:
      return "answer";
    case sim::Signal::Kind::noise:
      return "noise";
  }
  return "";
}

void copy(const sim::Vector3d& from, double* to) {
  std::copy_n(from.data(), 3, to);
}

}  // namespace

ViewPublisher::ViewPublisher(sim::Bus& bus, sim::World& world, FillScores fill_scores,
                             std::function<bool()> is_observed)
    : bus_(bus), world_(world), fill_scores_(std::move(fill_scores)), is_observed_(std::move(is_observed)) {
  world_.set_observer(this);
}

ViewPublisher::~ViewPublisher() {
  world_.set_observer(nullptr);
}

template <typename Message>
void ViewPublisher::publish(const char* channel, const Message& message) {
  shoal::encode_into(message, buffer_);
  bus_.publish(channel, buffer_, world_.now());
}

template <typename Message>
void ViewPublisher::publish_all(const char* channel, std::vector<Message>& messages) {
  for (const Message& message : messages) publish(channel, message);
  messages.clear();
}

/// Returns a new message with its step; null when it is switched off or the step has too many.
template <typename Message>
Message* ViewPublisher::add(bool enabled, std::vector<Message>& messages) {
  if (!enabled || !is_observed_()) return nullptr;
  if (messages.size() >= max_per_step) {
    ++left_out_;
    return nullptr;
  }
  messages.emplace_back();
  messages.back().step = world_.step_number();
  return &messages.back();
}

void ViewPublisher::sound_sent(const sim::SoundSent& sent) {
  auto* const message = add(world_.config().view.sounds, sounds_);
  if (message == nullptr) return;
  message->utime = utime(sent.sent);
  message->source = sent.source;
  message->sequence = sent.sequence;
  message->kind = kind_word(sent.signal.kind);
  copy(sent.p_W, message->position_m);
  message->duration_us = sent.signal.duration.count();
  message->sound_speed_mps = sent.sound_speed_mps;
  message->source_level_dB = sent.signal.source_level.dB();
  message->centre_Hz = sent.signal.centre_Hz;
  message->bandwidth_Hz = sent.signal.bandwidth_Hz;
  message->bytes = static_cast<std::int32_t>(sent.signal.payload.size());
  message->network = sent.signal.network;
  message->to = sent.signal.to.address;
}

void ViewPublisher::sound_arrived(const sim::SoundArrived& arrived) {
  auto* const message = add(world_.config().view.sounds, arrivals_);
  if (message == nullptr) return;
  message->utime = utime(arrived.started);
  message->source = arrived.source;
  message->sequence = arrived.sequence;
  message->receiver = arrived.receiver;
  message->addressed = static_cast<std::int8_t>(arrived.addressed);
  copy(arrived.p_W, message->position_m);
  message->duration_us = (arrived.ended - arrived.started).count();
  message->travel_time_s = arrived.travel_time_s;
  // The ratio of a signal that did not arrive is minus infinity, which a message cannot have.
  message->snr_dB = std::isfinite(arrived.snr_dB) ? arrived.snr_dB : -1000;
  message->outcome = arrived.loss == sim::SignalLoss::none ? "received" : sim::signal_loss_word(arrived.loss);
}

void ViewPublisher::happened(const sim::Occurrence& occurrence) {
  // Poses of fixed objects and the ranges of sensors are only in the scene.
  using Kind = sim::Occurrence::Kind;
  if (occurrence.kind == Kind::moved || occurrence.kind == Kind::changed) scene_is_old_ = true;
  auto* const message = add(world_.config().view.events, events_);
  if (message == nullptr) return;
  message->utime = utime(world_.now());
  message->kind = sim::occurrence_word(occurrence.kind);
  message->who = occurrence.who;
  message->text = occurrence.text;
}

void ViewPublisher::discard() {
  sounds_.clear();
  arrivals_.clear();
  events_.clear();
}

bool ViewPublisher::due(double rate_hz) const {
  if (rate_hz <= 0) return false;
  // Returns true once in each period: at the first step at or after a multiple of it.
  const double period_us = 1e6 / rate_hz;
  const double now = static_cast<double>(world_.now().count());
  const double before = now - static_cast<double>(world_.step_time().count());
  return world_.step_number() == 0 || std::floor(now / period_us + 1e-9) > std::floor(before / period_us + 1e-9);
}

void ViewPublisher::after_step() {
  if (!is_observed_()) return discard();
  update_structure();
  if (world_.now() < scene_time_) scene_is_old_ = true;  // it is of another future
  const bool may_publish = revision_ == 1 || world_.now() < scene_time_ ||
                           world_.now() - scene_time_ >= min_scene_interval || scene_requested_;
  if (world_.config().view.scene) {
    if (scene_requested_ || (scene_is_old_ && may_publish))
      publish_scene();
    else if (repeat_is_due())
      repeat_scene();
  }
  // A large world lowers the rate of its poses.
  const double share = std::min(1.0, static_cast<double>(max_bodies_at_full_rate) /
                                         static_cast<double>(std::max<std::size_t>(1, movables_.size())));
  if (due(world_.config().view.bodies_rate_hz * share)) publish_bodies();
  publish_current();
  publish_all("sim.sound", sounds_);
  publish_all("sim.sound.arrival", arrivals_);
  publish_all("sim.event", events_);
  if (scores_are_due()) publish_scores();
}

/// Starts a new revision when bodies were added or removed.
void ViewPublisher::update_structure() {
  if (revision_ > 0 && generation_ == world_.generation()) return;
  generation_ = world_.generation();
  ++revision_;
  scene_is_old_ = true;
  movables_.clear();
  for (const auto& body : world_.physics().bodies())
    if (body && !body->fixed()) movables_.push_back({body.get(), body->number()});
}

void ViewPublisher::publish_scene() {
  scene_.revision = revision_;
  scene_.scene = scene_text(world_, revision_, assets_);
  scene_time_ = world_.now();
  scene_is_old_ = false;
  // Assets are published once, and again on request.
  if (std::exchange(scene_requested_, false)) published_assets_.clear();
  publish_stamped_scene();
}

/// Publishes the last scene again, with equal text, by which viewers know that they have it.
void ViewPublisher::repeat_scene() {
  published_assets_.clear();
  publish_stamped_scene();
}

bool ViewPublisher::repeat_is_due() const {
  return revision_ > 0 && world_.now() - repeated_ >= repeat_after_;
}

void ViewPublisher::publish_stamped_scene() {
  scene_.utime = utime(world_.now());
  scene_.step = world_.step_number();
  scene_.branch = branch_;
  publish("sim.scene", scene_);
  std::size_t bytes = scene_.scene.size();
  for (const auto& [hash, content] : assets_.all()) {
    bytes += content.size();
    // Assets are named by the hash of their content, so an unchanged mesh is sent once, however often the scene
    // changes.
    if (!published_assets_.insert(hash).second) continue;
    shoal::sim_asset_t asset{};
    asset.utime = scene_.utime;
    asset.hash = hash;
    asset.size = static_cast<std::int32_t>(content.size());
    asset.data.resize(content.size());
    std::memcpy(asset.data.data(), content.data(), content.size());
    publish("sim.asset", asset);
  }
  repeated_ = world_.now();
  // A viewer that joins late gets the scene by repetition. The interval grows with the size, so that large meshes
  // take a bounded data rate.
  repeat_after_ = std::max(repeat_interval, sim::from_seconds(static_cast<double>(bytes) / repeated_bytes_per_s));
}

void ViewPublisher::fill_in_bodies(shoal::sim_bodies_t& bodies) const {
  bodies.utime = utime(world_.now());
  bodies.step = world_.step_number();
  bodies.branch = branch_;
  bodies.revision = revision_;
  const std::size_t count = movables_.size();
  bodies.count = static_cast<std::int32_t>(count);
  bodies.body.resize(count);
  bodies.position_m.resize(count, std::vector<double>(3));
  bodies.orientation.resize(count, std::vector<float>(4));
  for (std::size_t i = 0; i < count; ++i) {
    const sim::Pose X_WB = movables_[i].body->X_WB();
    const sim::Quaterniond q(X_WB.linear());
    bodies.body[i] = movables_[i].number;
    copy(X_WB.translation(), bodies.position_m[i].data());
    // Single precision turns a body by less than a pixel, and halves the message.
    bodies.orientation[i] = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
                             static_cast<float>(q.z())};
  }
}

shoal::sim_bodies_t ViewPublisher::bodies() const {
  shoal::sim_bodies_t bodies{};
  fill_in_bodies(bodies);
  return bodies;
}

void ViewPublisher::publish_bodies() {
  fill_in_bodies(bodies_);
  publish("sim.bodies", bodies_);
}

/// Publishes the part of the current that the scene cannot tell beforehand, because it is random.
void ViewPublisher::publish_current() {
  constexpr double rate_hz = 1;
  const sim::Current* const current = world_.medium().current();
  if (current == nullptr || !current->is_random() || !world_.config().view.scene || !due(rate_hz)) return;
  current_.utime = utime(world_.now());
  current_.step = world_.step_number();
  copy(current->uniform_W(), current_.velocity_mps);
  publish("sim.current", current_);
}

/// Figures are computed from all samples of a run: the interval grows with the time, so that their cost in all grows
/// only in proportion to it.
bool ViewPublisher::scores_are_due() {
  constexpr int times_per_doubling = 50;
  const double rate_hz = world_.config().view.scores_rate_hz;
  if (rate_hz <= 0 || !fill_scores_) return false;
  const sim::Time now = world_.now(), period = sim::from_seconds(1 / rate_hz);
  const sim::Time interval = std::max(period, now / times_per_doubling);
  if (now < next_scores_ && next_scores_ - now <= interval) return false;  // else the run was rewound
  next_scores_ = (now / period + 1) * period;
  if (interval > period) next_scores_ = now + interval;
  return true;
}

void ViewPublisher::publish_scores() {
  scores_.utime = utime(world_.now());
  scores_.step = world_.step_number();
  fill_scores_(scores_);
  if (scores_.count > 0 || scores_.rules > 0) publish("sim.scores", scores_);
}

}  // namespace bridges
