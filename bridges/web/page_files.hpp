// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace bridges {

/// File of the page that the build put into the program (cmake/EmbedFiles.cmake).
struct EmbeddedFile {
  const char* path;            ///< relative to the folder of the page
  const unsigned char* begin;  ///< first byte
  const unsigned char* end;    ///< after the last byte
};

/// Returns the embedded files of viewer/page; none if the build had no page.
std::span<const EmbeddedFile> embedded_page();

/// File as it is sent.
struct PageFile {
  std::string content_type;                    ///< with its character set
  std::string etag;                            ///< with quotes
  std::shared_ptr<const std::string> bytes;    ///< content
  std::shared_ptr<const std::string> gzipped;  ///< the same by gzip; null where that saves little
};

/// Files of the page by their path in an address.  The table is fixed when it is filled, so that no path of a request
/// is ever used to open a file.
class PageFiles {
 public:
  static constexpr std::size_t max_files = 200;                         ///< in a folder
  static constexpr std::size_t max_file_bytes = std::size_t{16} << 20;  ///< of one file

  /// Takes the embedded page if `directory` is empty, else the files of this folder; throws WebError if it has no
  /// `index.html`, or too many or too large files.
  explicit PageFiles(std::string directory);
  /// Returns the file of a path such as `/vendor/three.js`; `/` is `/index.html`.  Null: no such file.
  const PageFile* find(std::string_view path);

 private:
  void read_folder();
  void add(const std::string& path, std::string bytes);

  std::string directory_;
  std::map<std::string, PageFile, std::less<>> files_;
};

/// Returns the content type by the ending of a name; `application/octet-stream` for an unknown one.
std::string_view content_type_of(std::string_view path);
/// Returns the bytes compressed by gzip.
std::string gzip(std::string_view bytes);

}  // namespace bridges
