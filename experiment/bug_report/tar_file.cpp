// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/bug_report/tar_file.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace experiment {

TarFile::TarFile(const std::string& path) : file_(path), archive_(archive_write_new()) {
  if (archive_ == nullptr) throw std::bad_alloc();
  archive_write_add_filter_gzip(archive_);
  archive_write_set_format_pax_restricted(archive_);
  try {
    if (archive_write_open_fd(archive_, file_.number()) != ARCHIVE_OK) fail();
  } catch (...) {
    archive_write_free(archive_);
    throw;
  }
}

TarFile::~TarFile() {
  archive_write_free(archive_);
}

void TarFile::fail() const {
  const char* reason = archive_error_string(archive_);
  throw std::runtime_error(file_.path() + ": cannot be written: " + (reason != nullptr ? reason : "unknown error"));
}

void TarFile::start_entry(const std::string& name, std::uint64_t size) {
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, name.c_str());
  archive_entry_set_size(entry, static_cast<la_int64_t>(size));
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  archive_entry_set_mtime(entry, std::time(nullptr), 0);
  const int outcome = archive_write_header(archive_, entry);
  archive_entry_free(entry);
  if (outcome != ARCHIVE_OK) fail();
}

void TarFile::write(const char* bytes, std::size_t size) {
  while (size > 0) {
    const la_ssize_t written = archive_write_data(archive_, bytes, size);
    if (written <= 0) fail();
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
}

void TarFile::add(const std::string& name, const std::string& bytes) {
  start_entry(name, bytes.size());
  write(bytes.data(), bytes.size());
}

void TarFile::add_file(const std::string& name, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + ": cannot be read: " + std::strerror(errno));
  // The header of an entry has its size, so what is appended meanwhile is left out.
  std::uint64_t left = std::filesystem::file_size(path);
  start_entry(name, left);
  std::vector<char> block(std::size_t{1} << 20);
  while (left > 0) {
    in.read(block.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, block.size())));
    const auto got = static_cast<std::size_t>(in.gcount());
    if (got == 0) throw std::runtime_error(path + ": was truncated while it was read");
    write(block.data(), got);
    left -= got;
  }
}

void TarFile::finish() {
  if (archive_write_close(archive_) != ARCHIVE_OK) fail();
  archive_write_free(archive_);
  archive_ = nullptr;
  file_.finish();
}

}  // namespace experiment
