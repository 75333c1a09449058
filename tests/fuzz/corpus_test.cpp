// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/fuzz_target.hpp"
#include "tests/project_paths.hpp"

namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Bytes bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::filesystem::path corpus() {
  return test_support::source_path("tests/fuzz/corpus");
}

class FuzzCorpus : public testing::TestWithParam<std::string> {
 protected:
  FuzzCorpus() { spdlog::set_level(spdlog::level::off); }
  ~FuzzCorpus() override { spdlog::set_level(spdlog::level::info); }
};

// An input that once made a crash or a hang stays in the corpus.
TEST_P(FuzzCorpus, EveryInputIsReadOrRefused) {
  const fuzz::Target target = fuzz::targets().at(GetParam());
  std::vector<std::filesystem::path> inputs;
  for (const auto& entry : std::filesystem::directory_iterator(corpus() / GetParam())) inputs.push_back(entry.path());
  std::sort(inputs.begin(), inputs.end());
  EXPECT_FALSE(inputs.empty());
  for (const auto& path : inputs) {
    SCOPED_TRACE(path.filename().string());
    EXPECT_NO_THROW(target(bytes_of(path)));
  }
}

TEST_P(FuzzCorpus, CutAndFlippedInputsAreReadOrRefused) {
  const fuzz::Target target = fuzz::targets().at(GetParam());
  for (const auto& entry : std::filesystem::directory_iterator(corpus() / GetParam())) {
    SCOPED_TRACE(entry.path().filename().string());
    Bytes bytes = bytes_of(entry.path());
    if (bytes.empty()) continue;
    EXPECT_NO_THROW(target(fuzz::Input(bytes).first(bytes.size() / 2)));
    bytes[bytes.size() / 3] ^= std::byte{0x80};
    EXPECT_NO_THROW(target(bytes));
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& [name, target] : fuzz::targets()) all.push_back(name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(, FuzzCorpus, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& of) { return of.param; });

TEST(FuzzCorpora, BelongToTargets) {
  for (const auto& entry : std::filesystem::directory_iterator(corpus()))
    EXPECT_TRUE(fuzz::targets().contains(entry.path().filename().string())) << entry.path();
}

}  // namespace
