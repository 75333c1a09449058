// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/pose_table.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/config/message_text.hpp"

namespace motion {

namespace {

constexpr double same_time_s = 1e-9;
constexpr double tick_rounding = 1e-6;          // share of a tick
constexpr std::size_t max_checked = 1'000'000;  // values that are compared with those of the motion
constexpr std::size_t max_table_values = 10'000'000;

/// Instants of a table.
class TableTimes {
 public:
  TableTimes(double tick_s, double frame_s) : tick_s_(tick_s), frame_s_(frame_s) {}

  /// Adds an instant; between two ticks both.
  void add(double t_s) {
    if (tick_s_ <= 0) {
      // A key at a frame has the time of the frame, to the last bit: then a player commands the same.
      const double frame_time_s = std::round(t_s / frame_s_) * frame_s_;
      times_s_.insert(std::abs(frame_time_s - t_s) < same_time_s ? frame_time_s : t_s);
      return;
    }
    const double ticks = t_s / tick_s_;
    const double nearest = std::round(ticks);
    if (std::abs(ticks - nearest) <= tick_rounding) {
      // The exact time of a key: a step changes the value there.
      by_tick_.insert_or_assign(static_cast<std::int64_t>(nearest), t_s);
      return;
    }
    ++between_;
    for (const double tick : {std::floor(ticks), std::floor(ticks) + 1})
      by_tick_.try_emplace(static_cast<std::int64_t>(tick), tick * tick_s_);
  }

  std::size_t size() const { return std::max(times_s_.size(), by_tick_.size()); }
  std::size_t between_ticks() const { return between_; }

  /// Calls `use` with the time in the file, and the time in the motion.
  template <typename Use>
  void for_each(const Use& use) const {
    if (tick_s_ > 0) {
      for (const auto& [tick, t_s] : by_tick_) use(static_cast<double>(tick) * tick_s_, t_s);
      return;
    }
    double before = -1;
    for (const double t_s : times_s_) {
      if (t_s - before > same_time_s) use(t_s, t_s);
      before = t_s;
    }
  }

 private:
  double tick_s_, frame_s_;
  std::set<double> times_s_;
  std::map<std::int64_t, double> by_tick_;
  std::size_t between_ = 0;
};

/// Builder of a table.
class TableBuilder {
 public:
  TableBuilder(const sim::JointMotion& motion, const JointNames& names, const MotionFormat& format,
               const TableRules& rules, Losses& losses)
      : motion_(motion),
        names_(names),
        format_(format),
        rules_(rules),
        losses_(losses),
        times_(rules.tick_s, motion.frame_s) {}

  PoseTable build() {
    choose_joints();
    // A table has the start and the end in any case, and between them all times at which a joint has a key.
    times_.add(0);
    times_.add(motion_.end_s());
    for (const sim::MotionTrack* track : tracks_)
      if (track != nullptr) add_times(*track);
    if (times_.size() * tracks_.size() > max_table_values)
      refuse_motion(motion_, "a file must have at most 10000000 values, got " + std::to_string(times_.size()) +
                                 " poses of " + std::to_string(tracks_.size()) + " joints");
    fill_rows();
    add_notes();
    list_differences();
    return std::move(table_);
  }

 private:
  void choose_joints() {
    all_tracks_ = motion_.tracks();
    const JointNameList* const list = names_.empty() ? nullptr : names_.find_list(format_.list);
    std::vector<bool> used(all_tracks_.size());
    std::vector<std::string> absent, unnamed;
    std::vector<std::optional<std::string>> foreign;
    for (const sim::MotionTrack& track : all_tracks_) {
      check(track);
      foreign.push_back(names_.foreign_name(format_.list, format_.uses_aliases, track.joint));
      if (!foreign.back())
        unnamed.push_back(track.joint);
      else if (std::count(foreign.begin(), foreign.end(), foreign.back()) > 1)
        refuse_motion(motion_, "joint '" + track.joint + "' has two names in the motion");
    }
    const auto add = [&](std::size_t i) {
      table_.joints.push_back({all_tracks_[i].joint, *foreign[i]});
      tracks_.push_back(&all_tracks_[i]);
      rest_.push_back(0);
    };
    // The format needs all joints in its own order, so those that the motion does not name are filled in at rest.
    if (list != nullptr && list->complete) {
      for (const auto& [servo, name] : list->names) {
        std::size_t i = 0;
        while (i < all_tracks_.size() && foreign[i] != name) ++i;
        if (i < all_tracks_.size()) {
          add(i);
          continue;
        }
        const NamedJoint* const joint = names_.find(servo);
        table_.joints.push_back({servo, name});
        tracks_.push_back(nullptr);
        rest_.push_back(joint != nullptr ? joint->rest : 0);
        absent.push_back(servo);
      }
    } else {
      for (std::size_t i = 0; i < all_tracks_.size(); ++i)
        if (foreign[i]) add(i);
    }
    if (!unnamed.empty())
      losses_.push_back("joints that have no name in this format are left out: " + sim::list_text(unnamed));
    if (!absent.empty())
      losses_.push_back("joints that the motion does not name stay at rest: " + sim::list_text(absent));
    if (unnamed.size() == all_tracks_.size()) refuse_motion(motion_, "none of its joints has a name in this format");
  }

  void check(const sim::MotionTrack& track) const {
    const NamedJoint* const joint = names_.find(track.joint);
    const bool is_slider =
        std::find(motion_.sliders.begin(), motion_.sliders.end(), track.joint) != motion_.sliders.end() ||
        (joint != nullptr && joint->is_slider);
    if (is_slider && !rules_.holds_sliders)
      refuse_motion(motion_, "joint '" + track.joint + "' is a slider, and the format holds only angles");
    for (const sim::TrackKey& key : track.keys)
      if (!std::isfinite(key.value) || std::abs(key.value) > rules_.max_value)
        refuse_motion(motion_, "joint '" + track.joint + "' at " + sim::number_text(key.at_s) + " s: must be from -" +
                                   sim::number_text(rules_.max_value) + " to " + sim::number_text(rules_.max_value) +
                                   ", got " + sim::number_text(key.value));
  }

  /// Adds the keys of a track, and frames where it is not linear between them.
  void add_times(const sim::MotionTrack& track) {
    const double period_s = std::max(motion_.frame_s, rules_.tick_s);
    for (std::size_t i = 0; i < track.keys.size(); ++i) {
      times_.add(track.keys[i].at_s);
      const bool is_spline = i > 0 && track.keys[i].ease == sim::Easing::spline;
      const bool is_line = i == 0 || track.keys[i].ease == sim::Easing::linear ||
                           (!is_spline && track.keys[i].value == track.keys[i - 1].value);
      if (is_line || !rules_.samples_easing) continue;
      sampled_.insert(track.keys[i].at_s);
      const double from_s = track.keys[i - 1].at_s, to_s = track.keys[i].at_s;
      const double count = std::ceil(to_s / period_s - tick_rounding);  // frames before the key
      double first = std::floor(from_s / period_s + tick_rounding) + 1;
      // Before a step the value is constant.
      if (track.keys[i].ease == sim::Easing::step) first = std::max(first, count - 1);
      if (count - first > static_cast<double>(rules_.max_rows)) refuse_rows();
      for (double k = first; k < count; ++k) times_.add(k * period_s);
      if (times_.size() > rules_.max_rows) refuse_rows();
    }
    if (times_.size() > rules_.max_rows) refuse_rows();
  }

  [[noreturn]] void refuse_rows() const {
    refuse_motion(motion_, "the format holds at most " + std::to_string(rules_.max_rows) + " poses");
  }

  void fill_rows() {
    times_.for_each([&](double file_s, double motion_s) {
      table_.times_s.push_back(file_s);
      std::vector<double>& row = table_.rows.emplace_back();
      for (std::size_t i = 0; i < tracks_.size(); ++i)
        row.push_back(tracks_[i] != nullptr ? tracks_[i]->value_at(motion_s) : rest_[i]);
    });
  }

  void add_notes() {
    table_.notes.resize(table_.times_s.size());
    if (!rules_.keeps_notes) return;
    for (const sim::MotionKey& key : motion_.keys) {
      if (key.note.empty()) continue;
      const double t_s = key.at_s + std::max(same_time_s, rules_.tick_s * tick_rounding);
      const auto after = std::upper_bound(table_.times_s.begin(), table_.times_s.end(), t_s);
      if (after != table_.times_s.begin())
        table_.notes[static_cast<std::size_t>(after - table_.times_s.begin()) - 1] = key.note;
    }
  }

  void list_differences() {
    const std::size_t between = times_.between_ticks();
    if (sampled_.empty() && between == 0) return;
    std::string text;
    if (!sampled_.empty())
      text = "easing is sampled every " + sim::number_text(std::max(motion_.frame_s, rules_.tick_s) * 1000) + " ms";
    if (between > 0)
      text += (text.empty() ? "" : ", and ") + std::string("times are rounded to whole ") +
              sim::number_text(rules_.tick_s * 1000) + " ms";
    losses_.push_back(text + deviation());
  }

  /// Returns how far the table is from the motion at its frames.
  std::string deviation() const {
    const std::vector<sim::MotionTrack> written = table_.tracks();
    const double frames = std::floor(motion_.end_s() / motion_.frame_s + tick_rounding) + 1;
    if (frames * static_cast<double>(written.size()) > static_cast<double>(max_checked)) return "";
    double furthest = 0;
    std::string joint;
    for (std::size_t i = 0; i < written.size(); ++i)
      for (double k = 0; tracks_[i] != nullptr && k < frames; ++k) {
        // A step changes its value in a frame: either value is right there.
        const double t_s = k * motion_.frame_s;
        const double value = written[i].value_at(t_s);
        const double off = std::min(std::abs(value - tracks_[i]->value_at(t_s)),
                                    std::abs(value - tracks_[i]->value_at(t_s + tick_rounding * motion_.frame_s)));
        if (off > furthest) furthest = off, joint = written[i].joint;
      }
    constexpr double exact = 1e-9;
    if (furthest <= exact) return "; at its frames the motion is exact";
    return fmt::format("; at its frames up to {:.2g} rad from the motion, joint '{}'", furthest, joint);
  }

  const sim::JointMotion& motion_;
  const JointNames& names_;
  const MotionFormat& format_;
  const TableRules& rules_;
  Losses& losses_;
  PoseTable table_;
  std::vector<sim::MotionTrack> all_tracks_;
  std::vector<const sim::MotionTrack*> tracks_;  ///< by joint of the table; null: at rest
  std::vector<double> rest_;
  TableTimes times_;
  std::set<double> sampled_;  ///< times of keys with easing
};

}  // namespace

std::vector<sim::MotionTrack> PoseTable::tracks() const {
  std::vector<sim::MotionTrack> tracks;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    sim::MotionTrack& track = tracks.emplace_back(sim::MotionTrack{joints[j].joint, {}});
    for (std::size_t i = 0; i < times_s.size(); ++i)
      track.keys.push_back({times_s[i], rows[i][j], sim::Easing::linear});
  }
  return tracks;
}

PoseTable pose_table(const sim::JointMotion& motion, const JointNames& names, const MotionFormat& format,
                     const TableRules& rules, Losses& losses) {
  return TableBuilder(motion, names, format, rules, losses).build();
}

}  // namespace motion
