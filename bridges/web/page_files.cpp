// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/web/page_files.hpp"

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bridges/web/web_error.hpp"

namespace bridges {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view index_path = "/index.html";
constexpr std::string_view no_page =
    "<!doctype html><meta charset=\"utf-8\"><title>Shoal</title><p>This build of Shoal does not contain the "
    "page.</p>\n";

struct ContentType {
  std::string_view ending, type;
};

constexpr std::array<ContentType, 14> content_types = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".wasm", "application/wasm"},
    {".txt", "text/plain; charset=utf-8"},
    {".md", "text/plain; charset=utf-8"},
}};

/// FNV-1a with 64 bits: tells versions of a file apart.
std::string etag_of(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211u;
  std::array<char, 24> text{};
  const int length = std::snprintf(text.data(), text.size(), "\"%016llx\"", static_cast<unsigned long long>(hash));
  return {text.data(), static_cast<std::size_t>(length)};
}

bool is_text(std::string_view content_type) {
  return content_type.starts_with("text/") || content_type == "application/json" || content_type == "image/svg+xml";
}

std::string bytes_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw WebError(path.string() + ": cannot be read");
  return bytes;
}

}  // namespace

PageFiles::PageFiles(std::string directory) : directory_(std::move(directory)) {
  if (!directory_.empty()) {
    read_folder();
    return;
  }
  for (const EmbeddedFile& file : embedded_page())
    add(file.path, {reinterpret_cast<const char*>(file.begin), reinterpret_cast<const char*>(file.end)});
  if (!files_.contains(index_path)) add("index.html", std::string(no_page));
}

const PageFile* PageFiles::find(std::string_view path) {
  if (path == "/") path = index_path;
  // While the page is developed, a reload of it shows the present files.
  if (path == index_path && !directory_.empty()) read_folder();
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : &found->second;
}

void PageFiles::read_folder() {
  files_.clear();
  std::error_code error;
  fs::recursive_directory_iterator entry(directory_, error);
  if (error) throw WebError("folder of the page: " + directory_ + ": " + error.message());
  for (; entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (error || !entry->is_regular_file(error)) continue;
    // Limits
    const fs::path& path = entry->path();
    if (files_.size() == max_files)
      throw WebError("folder of the page: " + directory_ + ": has more than " + std::to_string(max_files) + " files");
    if (entry->file_size(error) > max_file_bytes)
      throw WebError(path.string() + ": must be at most " + std::to_string(max_file_bytes) + " bytes");
    add(path.lexically_relative(directory_).generic_string(), bytes_of_file(path));
  }
  if (!files_.contains(index_path)) throw WebError("folder of the page: " + directory_ + ": has no index.html");
}

void PageFiles::add(const std::string& path, std::string bytes) {
  PageFile file;
  file.content_type = content_type_of(path);
  file.etag = etag_of(bytes);
  if (is_text(file.content_type)) {
    std::string smaller = gzip(bytes);
    if (smaller.size() < bytes.size() / 10 * 9) file.gzipped = std::make_shared<const std::string>(std::move(smaller));
  }
  file.bytes = std::make_shared<const std::string>(std::move(bytes));
  files_["/" + path] = std::move(file);
}

std::string_view content_type_of(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  for (const ContentType& each : content_types)
    if (name.ends_with(each.ending)) return each.type;
  // LICENSE and the like
  return name.find('.') == std::string_view::npos ? "text/plain; charset=utf-8" : "application/octet-stream";
}

std::string gzip(std::string_view bytes) {
  z_stream stream{};
  constexpr int window_with_gzip_head = 15 + 16, memory_level = 8;
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window_with_gzip_head, memory_level,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw WebError("zlib does not work on this system");
  std::string result(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  // deflateBound() is enough for one call to finish.
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

}  // namespace bridges
