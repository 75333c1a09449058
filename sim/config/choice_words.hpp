// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

namespace sim {

/// YAML word and the enumerator that it denotes.
template <typename Enum>
struct ChoiceWord {
  std::string_view word;
  Enum value{};
};

constexpr std::size_t max_choice_words = 16;

namespace detail {

/// Returns whether the enum of `value` has an enumerator with this value.  The compiler writes the template argument
/// into the name of the function: `Color::red` for an enumerator, `(Color)7` otherwise.
template <auto value>
consteval bool is_enumerator() {
  // The names end in `value = Color::red]` with GCC and Clang.
  constexpr std::string_view name = __PRETTY_FUNCTION__;
  const auto in_word = [](char c) {
    return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  std::size_t begin = name.size() - 1;
  while (begin > 0 && in_word(name[begin - 1])) --begin;
  return begin < name.size() - 1 && !(name[begin] >= '0' && name[begin] <= '9');
}

/// Returns the number of enumerators of an enum.  They must have the consecutive values 0, 1, 2, ...
template <typename Enum, std::size_t... number>
constexpr std::size_t count_enumerators(std::index_sequence<number...>) {
  constexpr std::array exists = {is_enumerator<static_cast<Enum>(number)>()...};
  std::size_t count = 0;
  while (count < exists.size() && exists[count]) ++count;
  for (std::size_t i = count; i < exists.size(); ++i)
    if (exists[i]) throw std::logic_error("enumerators must be numbered from 0 without gaps");
  return count;
}

}  // namespace detail

/// Throws std::logic_error unless words and enumerators correspond one to one.
template <typename Enum>
constexpr void check_choice_words(std::span<const ChoiceWord<Enum>> words) {
  const std::size_t count = detail::count_enumerators<Enum>(std::make_index_sequence<max_choice_words + 1>());
  if (words.size() > max_choice_words) throw std::logic_error("too many words");
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].word.empty()) throw std::logic_error("a word is empty");
    if (static_cast<std::size_t>(words[i].value) >= count) throw std::logic_error("a word stands for no enumerator");
    for (std::size_t k = 0; k < i; ++k) {
      if (words[k].word == words[i].word) throw std::logic_error("a word stands for two enumerators");
      if (words[k].value == words[i].value) throw std::logic_error("an enumerator has two words");
    }
  }
  // The words denote different enumerators, so equal counts mean that every enumerator has a word.
  if (words.size() < count) throw std::logic_error("an enumerator has no word");
}

/// Table of the YAML words of an enum, in the order in which messages and documentation list them.  The table is
/// checked at compile time by check_choice_words(): an enumerator without a word does not compile.
template <typename Enum>
class ChoiceWords {
  static_assert(std::is_enum_v<Enum> && !std::is_convertible_v<Enum, int>, "words stand for an enum class");

 public:
  consteval ChoiceWords(std::initializer_list<ChoiceWord<Enum>> words) {
    check_choice_words(std::span(words.begin(), words.size()));
    for (const ChoiceWord<Enum>& each : words) words_[count_++] = each;
  }

  constexpr const ChoiceWord<Enum>* begin() const { return words_.data(); }
  constexpr const ChoiceWord<Enum>* end() const { return words_.data() + count_; }
  constexpr std::size_t size() const { return count_; }

 private:
  std::array<ChoiceWord<Enum>, max_choice_words> words_{};
  std::size_t count_ = 0;
};

/// Returns the word of a value.
template <typename Enum>
constexpr std::string_view word_of(const ChoiceWords<Enum>& words, Enum value) {
  for (const ChoiceWord<Enum>& each : words)
    if (each.value == value) return each.word;
  assert(false && "a value that is not an enumerator");
  return "?";
}

/// Returns the value of a word; none when the word is not in the table.
template <typename Enum>
constexpr std::optional<Enum> value_of(const ChoiceWords<Enum>& words, std::string_view word) {
  for (const ChoiceWord<Enum>& each : words)
    if (each.word == word) return each.value;
  return std::nullopt;
}

}  // namespace sim
