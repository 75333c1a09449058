// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/param_reader.hpp"

namespace sim {

using ChoiceKeys = std::vector<const char*>;

/// Reports keys that apply only to other values of an enum, such as `'gamma' does not apply to type regular`: a key
/// without effect is most likely meant for another value.  `keys_of` returns the keys of a value that are not common to
/// all values; it is a switch without default, so that the compiler requires an entry for a new value.  `what`: the key
/// of the enum.
template <typename Enum, typename KeysOf>
void refuse_keys_of_others(ParamReader& in, std::string_view what, const ChoiceWords<Enum>& words, Enum value,
                           const KeysOf& keys_of) {
  const ChoiceKeys own = keys_of(value);
  std::set<std::string_view> done(own.begin(), own.end());
  for (const ChoiceWord<Enum>& each : words)
    for (const char* key : keys_of(each.value))
      if (done.insert(key).second && in.has(key))
        in.error(key, "'" + std::string(key) + "' does not apply to " + std::string(what) + " " +
                          std::string(word_of(words, value)));
}

}  // namespace sim
