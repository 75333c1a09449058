// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/server/past_view.hpp"

#include <algorithm>

#include "bridges/base/json_text.hpp"

namespace viewer {

namespace {

using Json = nlohmann::json;

/// Maximum number of branches in the list: the newest.
constexpr std::size_t max_listed = 100;

}  // namespace

void PastView::set_scene(const std::string& scene) {
  names_.add(scene);
}

void PastView::remember(const sim::World& world, const bridges::ViewPublisher& publisher) {
  const std::int64_t now_us = world.now().count();
  if (!history_.is_due(now_us, world.step_time().count())) return;
  kept_.begin({});
  publisher.for_each_movable(
      [&](const sim::Pose& X_WB) { kept_.add(X_WB.translation(), sim::Quaterniond(X_WB.linear())); });
  history_.add(now_us, static_cast<std::uint32_t>(publisher.revision()), kept_.bodies());
}

void PastView::start_branch(std::int32_t number, std::int64_t start_us, std::int64_t left_us, bool continues) {
  history_.start_branch(number, start_us, left_us, continues);
  comparisons_.clear();
  next_update_ = {};
}

void PastView::set_programs(const std::string& text) {
  if (text.empty()) return;
  programs_[history_.present()] = text;
  while (programs_.size() > PoseHistory::max_branches) programs_.erase(programs_.begin());
}

void PastView::clear() {
  programs_.clear();
  history_ = PoseHistory();
  names_ = {};
  comparisons_.clear();
  next_update_ = {};
}

void PastView::answer(const bridges::ViewRequest& request) {
  try {
    const LookRequest look = parse_look(request.text);
    if (!look.time_us) return;  // the newest state comes anyway
    const std::int32_t branch = look.branch.value_or(history_.present());
    if (!history_.has(branch)) throw std::runtime_error("look: there is no branch " + std::to_string(branch));
    const auto state = history_.at(branch, *look.time_us);
    if (!state) throw std::runtime_error("look: no state is kept yet");
    StateFrame::Head head;
    head.time_us = state->time_us;
    head.branch = branch;
    head.revision = names_.newest();
    head.paused = head.past = true;
    sent_.begin(head);
    names_.arrange(state->revision, state->bodies, sent_);
    server_.send_state_to(request.client, sent_.end());
  } catch (const std::runtime_error& error) {
    server_.reply(request.client, bridges::json_text({{"op", "error"}, {"text", error.what()}}));
  }
}

void PastView::compare() {
  for (const PoseHistory::Branch& branch : history_.branches()) {
    if (branch.number == history_.present()) continue;
    Comparison& known = comparisons_[branch.number];
    // A branch that was left does not grow.
    if (known.differs_us || known.until_us >= branch.end_us) continue;
    known.differs_us = history_.first_difference(history_.present(), branch.number);
    if (const auto newest = history_.at(history_.present(), INT64_MAX)) known.until_us = newest->time_us;
  }
}

std::string PastView::branches_text() const {
  Json items = Json::array();
  const std::vector<PoseHistory::Branch> branches = history_.branches();
  // The newest ones: a long session can have thousands.
  for (std::size_t i = branches.size() - std::min(branches.size(), max_listed); i < branches.size(); ++i) {
    const PoseHistory::Branch& branch = branches[i];
    const auto known = comparisons_.find(branch.number);
    const bool differs = known != comparisons_.end() && known->second.differs_us;
    const bool present = branch.number == history_.present();
    items.push_back({{"branch", branch.number},
                     {"parent", branch.parent ? Json(*branch.parent) : Json(nullptr)},
                     {"start_us", branch.start_us},
                     {"end_us", present ? Json(nullptr) : Json(branch.end_us)},
                     {"differs_us", differs ? Json(*known->second.differs_us) : Json(nullptr)}});
    if (const auto programs = programs_.find(branch.number); programs != programs_.end())
      items.back()["programs"] = programs->second;
  }
  return bridges::json_text(
      {{"op", "branches"}, {"present", history_.present()}, {"by", "poses"}, {"items", std::move(items)}});
}

void PastView::update(Clock::time_point now) {
  if (now < next_update_) return;
  next_update_ = now + std::chrono::seconds(1);
  compare();
  std::string text = branches_text();
  if (text == branches_) return;
  branches_ = text;
  server_.retain("branches", std::move(text));
}

}  // namespace viewer
