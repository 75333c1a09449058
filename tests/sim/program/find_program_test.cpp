// SPDX-License-Identifier: BSD-3-Clause
#include "sim/program/find_program.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// A folder of programs.
class FindProgram : public testing::Test {
 protected:
  FindProgram() { fs::create_directories(folder_ / "b"); }
  ~FindProgram() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text = "shoal_args: 1\nprogram: pilot\n") {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  sim::FoundProgram find(const std::string& program, const sim::FileAccess* files = nullptr) {
    diagnostics_ = sim::Diagnostics();
    return sim::find_program(program, {folder_.string(), (folder_ / "b").string()}, files,
                             {sim::intern_file_name("w.yaml"), 2, 3}, "process 'p'", diagnostics_);
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("find_program_" + std::to_string(::getpid()));
  sim::Diagnostics diagnostics_;
};

TEST_F(FindProgram, TakesTheFirstFolderThatHasADeclaration) {
  write("b/pilot.args.yaml");
  EXPECT_EQ(find("pilot").path, folder_ / "b/pilot");
  write("pilot.args.yaml");
  const sim::FoundProgram found = find("pilot");
  EXPECT_EQ(found.path, folder_ / "pilot") << "the program itself need not be there";
  ASSERT_NE(found.declaration, nullptr);
  EXPECT_EQ(found.declaration->program, "pilot");
  EXPECT_FALSE(find("navigator").exists);
  EXPECT_THAT(diagnostics_.lines(), ElementsAre());
  EXPECT_THAT(sim::declared_programs(folder_.string()), ElementsAre("pilot"));
}

TEST_F(FindProgram, ABrokenDeclarationIsAnErrorOfItsOwn) {
  const std::string file = write("pilot.args.yaml", "shoal_args: 1\nprogram: pilot\nargs: [{name: a}]\n");
  const sim::FoundProgram found = find("pilot");
  EXPECT_TRUE(found.exists);
  EXPECT_EQ(found.declaration, nullptr);
  EXPECT_THAT(diagnostics_.lines(), ElementsAre(file + ":3:8: argument 'a': missing key 'type'"));
}

TEST_F(FindProgram, TheSizeOfADeclarationIsBounded) {
  const std::string file = write("pilot.args.yaml", std::string((256 << 10) + 1, '#'));
  find("pilot");
  EXPECT_THAT(diagnostics_.lines(), ElementsAre(file + ": a declaration must have at most 256 KiB"));
}

TEST_F(FindProgram, ADeclarationIsARegularFile) {
  ASSERT_EQ(::mkfifo((folder_ / "pilot.args.yaml").c_str(), 0600), 0);
  find("pilot");
  EXPECT_THAT(diagnostics_.lines(), ElementsAre(HasSubstr("must be a regular file")));
}

TEST_F(FindProgram, APathIsReadOnlyWhereTheWorldMayRead) {
  write("b/pilot.args.yaml");
  const std::string program = (folder_ / "b/pilot").string();
  const sim::FileAccess own({(folder_ / "b").string()}, {}, {}), elsewhere({"/nowhere"}, {}, {});
  EXPECT_NE(find(program, &own).declaration, nullptr);
  EXPECT_EQ(find(program, &elsewhere).declaration, nullptr);
  EXPECT_THAT(
      diagnostics_.lines(),
      ElementsAre(HasSubstr("w.yaml:2:3: process 'p': the declaration of 'program' must lie below the folder")));
  fs::create_symlink("/etc/passwd", folder_ / "b/secret.args.yaml");
  EXPECT_EQ(find((folder_ / "b/secret").string(), &own).declaration, nullptr);
  EXPECT_THAT(diagnostics_.lines(), ElementsAre(HasSubstr("must lie below the folder")));
}

TEST_F(FindProgram, ADeclarationThatAWorldNamesByItsPathIsNotQuoted) {
  write("b/pilot.args.yaml", "secret: word\n");
  const sim::FileAccess own({(folder_ / "b").string()}, {}, {});
  find((folder_ / "b/pilot").string(), &own);
  EXPECT_THAT(diagnostics_.lines(), ElementsAre(HasSubstr("has errors; `shoal check ")));
  const sim::FileAccess allowed({}, {folder_.string()}, {});
  find((folder_ / "b/pilot").string(), &allowed);
  EXPECT_THAT(diagnostics_.lines(), testing::Contains(HasSubstr("unknown key 'secret'")));
}

}  // namespace
