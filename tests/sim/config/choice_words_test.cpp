// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/choice_words.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace {

using sim::ChoiceWord;

enum class Primary { red, green, blue };
enum class Numbered { one = 1, two = 2 };
enum class Gap { zero, two = 2 };

struct Lamp {
  enum class State { on, off };
  static constexpr sim::ChoiceWords<State> state_words{{"lit", State::on}, {"dark", State::off}};
};

constexpr sim::ChoiceWords<Primary> primary_words{
    {"blue", Primary::blue}, {"red", Primary::red}, {"green", Primary::green}};

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
  static_assert(word_of(primary_words, Primary::green) == "green");
  static_assert(value_of(primary_words, "blue") == Primary::blue);
  static_assert(value_of(primary_words, "pink") == std::nullopt);
  static_assert(word_of(Lamp::state_words, Lamp::State::off) == "dark");
  std::vector<std::string_view> words;
  for (const auto& [word, value] : primary_words) words.push_back(word);
  EXPECT_THAT(words, testing::ElementsAre("blue", "red", "green"));  // in the order of the table
}

TEST(ChoiceWords, EachEnumeratorHasAWord) {
  EXPECT_EQ(problem_of<Primary>({{"red", Primary::red}, {"green", Primary::green}, {"blue", Primary::blue}}), "");
  EXPECT_EQ(problem_of<Primary>({{"red", Primary::red}, {"blue", Primary::blue}}), "an enumerator has no word");
  EXPECT_EQ(problem_of<Primary>({}), "an enumerator has no word");
  EXPECT_EQ(problem_of<Lamp::State>({{"lit", Lamp::State::on}}), "an enumerator has no word");
}

TEST(ChoiceWords, NoWordIsThereTwice) {
  EXPECT_EQ(problem_of<Primary>({{"red", Primary::red}, {"green", Primary::green}, {"red", Primary::blue}}),
            "a word stands for two enumerators");
  EXPECT_EQ(problem_of<Primary>({{"red", Primary::red}, {"scarlet", Primary::red}, {"blue", Primary::blue}}),
            "an enumerator has two words");
  EXPECT_EQ(problem_of<Primary>({{"red", Primary::red}, {"", Primary::green}, {"blue", Primary::blue}}),
            "a word is empty");
}

TEST(ChoiceWords, EnumeratorsAreCounted) {
  EXPECT_EQ(problem_of<Primary>({{"pink", static_cast<Primary>(3)}}), "a word stands for no enumerator");
  EXPECT_EQ(problem_of<Numbered>({{"one", Numbered::one}, {"two", Numbered::two}}),
            "enumerators must be numbered from 0 without gaps");
  EXPECT_EQ(problem_of<Gap>({{"zero", Gap::zero}, {"two", Gap::two}}),
            "enumerators must be numbered from 0 without gaps");
}

}  // namespace
