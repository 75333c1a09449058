// SPDX-License-Identifier: BSD-3-Clause
#include <numeric>
#include <set>

#include "sim/director/action_run.hpp"
#include "sim/director/script.hpp"
#include "sim/script/action_registry.hpp"
#include "sim/world_file/check_script.hpp"

namespace sim {

namespace {

class OneOfAction final : public Action {
 public:
  static constexpr const char* meaning = "carries out one of several lists of actions, chosen at random";
  static constexpr const char* main_key = "choices";
  static constexpr bool main_alone = true;

  void read(ParamReader& in, const char* main) override {
    in.require(main);
    read_action_lists(in, main, choices_, "[[actions], [actions]]");
    in.read("weights", weights_, at_least(0), "relative frequency of each list; unset: equal");
    if (!in.has(main)) return;
    const std::size_t count = in.child(main)->items.size();
    if (choices_.empty() && count == 0)
      in.error(main, "'" + std::string(main) + "' must have at least one list of actions");
    if (!in.has("weights")) return;
    if (in.child("weights")->items.size() != count)
      in.error("weights", "'weights' must have as many numbers as 'choices' has lists, " + std::to_string(count));
    else if (!weights_.empty() && std::accumulate(weights_.begin(), weights_.end(), 0.0) <= 0)
      in.error("weights", "'weights' must not all be 0");
  }

  void check(const ActionCheck& check) override {
    for (const std::vector<ActionEntry>& choice : choices_) check.check(choice);
  }

  void carry_out(const ActionRun& run) const override { run.script.carry_out(choose(run.random), run); }

  void add_channels(std::set<std::string>& channels) const override {
    for (const std::vector<ActionEntry>& choice : choices_)
      for (const ActionEntry& entry : choice)
        if (entry.action) entry.action->add_channels(channels);
  }
  void add_triggered(std::set<std::string>& events) const override {
    for (const std::vector<ActionEntry>& choice : choices_)
      for (const ActionEntry& entry : choice)
        if (entry.action) entry.action->add_triggered(events);
  }

 private:
  const std::vector<ActionEntry>& choose(Random& random) const {
    if (weights_.empty()) return choices_[random.integer_below(static_cast<std::uint32_t>(choices_.size()))];
    double left = random.uniform() * std::accumulate(weights_.begin(), weights_.end(), 0.0);
    // Rounding may leave a rest after the last weight, so the last list with a weight above 0 is the answer then.
    std::size_t last = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (weights_[i] <= 0) continue;
      last = i;
      left -= weights_[i];
      if (left < 0) break;
    }
    return choices_[last];
  }

  std::vector<std::vector<ActionEntry>> choices_;
  std::vector<double> weights_;  ///< empty: equal
};

SHOAL_ACTION("one_of", OneOfAction);

}  // namespace

}  // namespace sim
