// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/choice_words.hpp"

namespace sim {

/// Form of the path from the key before to a key, with s = 0...1 the share of the time between them.
enum class Easing : unsigned char {
  linear,
  cosine,  ///< (1 - cos(pi s)) / 2: at rest at both ends
  smooth,  ///< 3 s^2 - 2 s^3: at rest at both ends
  spline,  ///< cubic Hermite; slope at a key: that of the line from its neighbor before to the one after, 0 at the
           ///< ends
  step     ///< the value before until the key
};

inline const ChoiceWords<Easing> easing_words{{"linear", Easing::linear},
                                              {"cosine", Easing::cosine},
                                              {"smooth", Easing::smooth},
                                              {"spline", Easing::spline},
                                              {"step", Easing::step}};

/// Value of a joint at a time of a motion: rad, or m for a slider.
struct TrackKey {
  double at_s = 0;
  double value = 0;
  Easing ease = Easing::linear;
};

/// Values of one joint over the time of a motion.
struct MotionTrack {
  std::string joint;           ///< name of its servo, or an alias
  std::vector<TrackKey> keys;  ///< times increase; at least one

  /// Returns the value at a time; that of the first or the last key outside of their times.
  double value_at(double t_s) const;
};

}  // namespace sim
