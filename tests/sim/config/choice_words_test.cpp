// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/choice_words.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace {

using sim::ChoiceWord;

enum class Color { red, green, blue };
enum class Numbered { one = 1, two = 2 };
enum class Gap { zero, two = 2 };

struct Lamp {
  enum class State { on, off };
  static constexpr sim::ChoiceWords<State> state_words{{"lit", State::on}, {"dark", State::off}};
};

constexpr sim::ChoiceWords<Color> color_words{{"blue", Color::blue}, {"red", Color::red}, {"green", Color::green}};

/// A table in the source that is as wrong as these stops the compiler at the line that throws.
template <typename Enum>
std::string problem_of(const std::vector<ChoiceWord<Enum>>& words) {
  try {
    sim::check_choice_words(std::span<const ChoiceWord<Enum>>(words));
  } catch (const std::logic_error& error) {
    return error.what();
  }
  return "";
}

TEST(ChoiceWords, StandForTheValuesOfAnEnum) {
  static_assert(word_of(color_words, Color::green) == "green");
  static_assert(value_of(color_words, "blue") == Color::blue);
  static_assert(value_of(color_words, "pink") == std::nullopt);
  static_assert(word_of(Lamp::state_words, Lamp::State::off) == "dark");
  std::vector<std::string_view> words;
  for (const auto& [word, value] : color_words) words.push_back(word);
  EXPECT_THAT(words, testing::ElementsAre("blue", "red", "green"));  // in the order of the table
}

TEST(ChoiceWords, EachEnumeratorHasAWord) {
  EXPECT_EQ(problem_of<Color>({{"red", Color::red}, {"green", Color::green}, {"blue", Color::blue}}), "");
  EXPECT_EQ(problem_of<Color>({{"red", Color::red}, {"blue", Color::blue}}), "an enumerator has no word");
  EXPECT_EQ(problem_of<Color>({}), "an enumerator has no word");
  EXPECT_EQ(problem_of<Lamp::State>({{"lit", Lamp::State::on}}), "an enumerator has no word");
}

TEST(ChoiceWords, NoWordIsThereTwice) {
  EXPECT_EQ(problem_of<Color>({{"red", Color::red}, {"green", Color::green}, {"red", Color::blue}}),
            "a word stands for two enumerators");
  EXPECT_EQ(problem_of<Color>({{"red", Color::red}, {"scarlet", Color::red}, {"blue", Color::blue}}),
            "an enumerator has two words");
  EXPECT_EQ(problem_of<Color>({{"red", Color::red}, {"", Color::green}, {"blue", Color::blue}}), "a word is empty");
}

TEST(ChoiceWords, EnumeratorsAreCounted) {
  EXPECT_EQ(problem_of<Color>({{"pink", static_cast<Color>(3)}}), "a word stands for no enumerator");
  EXPECT_EQ(problem_of<Numbered>({{"one", Numbered::one}, {"two", Numbered::two}}),
            "enumerators must be numbered from 0 without gaps");
  EXPECT_EQ(problem_of<Gap>({{"zero", Gap::zero}, {"two", Gap::two}}),
            "enumerators must be numbered from 0 without gaps");
}

}  // namespace
