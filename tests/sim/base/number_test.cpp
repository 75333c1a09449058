// SPDX-License-Identifier: BSD-3-Clause
#include "sim/base/number.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <vector>

#include "tests/comma_locale.hpp"
#include "tests/project_paths.hpp"

namespace sim {
namespace {

namespace fs = std::filesystem;

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Number, IsReadWholeOrNotAtAll) {
  EXPECT_EQ(read_number("-0.93"), -0.93);
  EXPECT_EQ(read_number("+2.5e3"), 2500);
  EXPECT_EQ(read_number(".5"), 0.5);
  for (const char* text : {"", "+", "+-1", "1,5", "1.5 ", " 1.5", "1.5m", "0x10", "--1"})
    EXPECT_EQ(read_number(text), std::nullopt) << text;
}

TEST(Number, OfATypeIsReadOnlyIfTheTypeHoldsIt) {
  EXPECT_EQ(sim::exact_number<int>("-12"), -12);
  EXPECT_EQ(sim::exact_number<std::size_t>("12"), 12u);
  EXPECT_EQ(sim::exact_number<double>("1.5e-3"), 1.5e-3);
  EXPECT_EQ(sim::exact_number<std::int64_t>("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  for (const char* text : {"", " 1", "1 ", "+1", "1.5", "1x", "x", "2147483648"})
    EXPECT_EQ(sim::exact_number<int>(text), std::nullopt) << text;
  EXPECT_EQ(sim::exact_number<std::size_t>("-1"), std::nullopt);
  EXPECT_EQ(sim::exact_number<double>("1e999"), std::nullopt);
}

TEST(Number, OutOfTheRangeOfADoubleIsZeroOrInfinite) {
  // The smallest double is 4.9e-324; long double ends at 1e4932.
  for (const char* text : {"1.5e-400", "1e-324", "1e-5000", "-1.5E-400"}) EXPECT_EQ(read_number(text), 0) << text;
  EXPECT_EQ(read_number("4.9e-324"), std::numeric_limits<double>::denorm_min());
  for (const char* text : {"1e309", "1.5e400", "1e5000"}) EXPECT_EQ(read_number(text), infinity) << text;
  EXPECT_EQ(read_number("-1e400"), -infinity);
  EXPECT_EQ(read_number("-1e5000"), -infinity);
}

TEST(Number, HasTheShortestTextThatReadsTheSame) {
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(shortest_text(1e-7), "1e-07");
}

TEST(Number, IsRoundedToSignificantDigits) {
  EXPECT_EQ(rounded_to(45.000000000000007, 12), 45);
  EXPECT_EQ(rounded_to(-123456.5, 4), -123500);
  EXPECT_EQ(rounded_to(infinity, 4), infinity);
}

TEST(Number, IsTheSameInEveryLocale) {
  const test_support::CommaLocale comma;
  EXPECT_EQ(read_number("-0.93"), -0.93);
  EXPECT_EQ(read_number("1.5e-400"), 0);
  EXPECT_EQ(read_number("0,93"), std::nullopt);
  EXPECT_EQ(shortest_text(0.25), "0.25");
  EXPECT_EQ(rounded_to(0.123456, 3), 0.123);
}

/// The lines of sources that read or write numbers by the locale of the process.
std::vector<std::string> lines_by_locale(const std::string& text) {
  static const std::regex reads(R"(\b(strto(d|f|ld)|sto(d|f|ld)|atof)\s*\()");
  static const std::regex prints(R"((printf|scanf)\s*\()");
  static const std::regex number(R"re(%[-+ #0]*([0-9]+|\*)?(\.([0-9]+|\*))?[lL]?[aefgAEFG])re");
  std::vector<std::string> lines;
  std::size_t since_print = 100;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line); ++since_print) {
    const auto has = [&](const char* word) { return line.find(word) != std::string::npos; };
    if ((has("printf") || has("scanf")) && std::regex_search(line, prints)) since_print = 0;  // and the next lines
    if (((has("sto") || has("strto") || has("atof")) && std::regex_search(line, reads)) ||
        (since_print < 3 && std::regex_search(line, number)))
      lines.push_back(line);
  }
  return lines;
}

TEST(Number, TheSearchOfTheNextTestFindsWhatItMust) {
  for (const char* line : {"x = std::strtod(text, &end);", "x = stod(text);", "atof(text)", "std::stof (t)",
                           R"(std::snprintf(text, sizeof text, "%.6f", x);)", R"(fprintf(file, "%s %9.3g\n", a, b);)",
                           R"(std::sscanf(text, "%lf", &x);)"})
    EXPECT_EQ(lines_by_locale(line).size(), 1u) << line;
  EXPECT_EQ(lines_by_locale("std::fprintf(file,\n             \"%.6f\\n\", x);").size(), 1u);
  for (const char* line : {R"(std::snprintf(text, sizeof text, "%08x", x);)", R"(fmt::format("{:.6f}", x))",
                           R"("--output=%A_%a.log")", "read_number(text)", "strtoll(text, nullptr, 10)"})
    EXPECT_TRUE(lines_by_locale(line).empty()) << line;
}

TEST(Number, NoSourceReadsOrWritesOneByTheLocaleOfTheProcess) {
  std::size_t files = 0;
  for (const char* folder : {"sim", "messages", "devices", "bridges", "experiment", "autonomy", "viewer", "motion",
                             "verification", "tools", "python"})
    for (const auto& entry : fs::recursive_directory_iterator(test_support::source_path(folder))) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      std::ifstream in(entry.path());
      ++files;
      EXPECT_THAT(lines_by_locale({std::istreambuf_iterator<char>(in), {}}), testing::IsEmpty()) << entry.path();
    }
  EXPECT_GT(files, 1000u);
}

}  // namespace
}  // namespace sim
