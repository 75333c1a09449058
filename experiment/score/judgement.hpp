// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace experiment {

/// Outcome of the rules of a run or a study.  A run that was not judged has not passed.
enum class Judgement { passed, failed, not_judged };

/// Returns the readable form: `passed`, `FAILED` or `not judged`.
inline const char* judgement_word(Judgement judgement) {
  if (judgement == Judgement::not_judged) return "not judged";
  return judgement == Judgement::passed ? "passed" : "FAILED";
}

inline Judgement judgement_of(bool passed) {
  return passed ? Judgement::passed : Judgement::failed;
}

/// Returns the value of `passed` in JSON files: nothing, written as null, where nothing was judged.
inline std::optional<bool> as_flag(Judgement judgement) {
  if (judgement == Judgement::not_judged) return std::nullopt;
  return judgement == Judgement::passed;
}

}  // namespace experiment
