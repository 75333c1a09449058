// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/bug_report/tar_file.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "tests/scratch_folder.hpp"

namespace {

/// The files of an archive.
std::map<std::string, std::string> content_of(const std::string& path) {
  const std::unique_ptr<archive, int (*)(archive*)> in(archive_read_new(), archive_read_free);
  archive_read_support_filter_gzip(in.get());
  archive_read_support_format_tar(in.get());
  EXPECT_EQ(archive_read_open_filename(in.get(), path.c_str(), 10'240), ARCHIVE_OK);
  std::map<std::string, std::string> files;
  for (archive_entry* entry = nullptr; archive_read_next_header(in.get(), &entry) == ARCHIVE_OK;) {
    std::string bytes(static_cast<std::size_t>(archive_entry_size(entry)), '\0');
    EXPECT_EQ(archive_read_data(in.get(), bytes.data(), bytes.size()), static_cast<la_ssize_t>(bytes.size()));
    files[archive_entry_pathname(entry)] = bytes;
  }
  return files;
}

TEST(TarFile, HoldsTextsAndFiles) {
  const test_support::ScratchFolder folder;
  const std::string large(3'000'000, 'x');
  std::ofstream(folder.file("large")) << large;
  experiment::TarFile tar(folder.file("bug.tar.gz"));
  tar.add("bug/README", "text");
  tar.add_file("bug/large", folder.file("large"));
  tar.add("bug/empty", "");
  tar.finish();
  EXPECT_EQ(content_of(folder.file("bug.tar.gz")),
            (std::map<std::string, std::string>{{"bug/README", "text"}, {"bug/empty", ""}, {"bug/large", large}}));
  EXPECT_LT(std::filesystem::file_size(folder.file("bug.tar.gz")), 100'000u);
}

TEST(TarFile, IsThereOnlyWhenItIsComplete) {
  const test_support::ScratchFolder folder;
  {
    experiment::TarFile tar(folder.file("bug.tar.gz"));
    tar.add("a", "text");
    EXPECT_FALSE(std::filesystem::exists(folder.file("bug.tar.gz")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.file("")));
}

TEST(TarFile, NamesWhatCannotBeReadOrWritten) {
  const test_support::ScratchFolder folder;
  const auto error_of = [](const auto& work) -> std::string {
    try {
      work();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  experiment::TarFile tar(folder.file("bug.tar.gz"));
  EXPECT_EQ(error_of([&] { tar.add_file("a", folder.file("missing")); }),
            folder.file("missing") + ": cannot be read: No such file or directory");
  const std::string nowhere = folder.file("no/bug.tar.gz");
  EXPECT_NE(error_of([&] { experiment::TarFile other(nowhere); }).find(nowhere), std::string::npos);
}

}  // namespace
