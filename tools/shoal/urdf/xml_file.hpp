// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/shoal/urdf/xml_element.hpp"

namespace tinyxml2 {
class XMLDocument;
}

namespace tools {

/// A URDF or SDF file.  Entities of a document type are not expanded.
class XmlFile {
 public:
  /// Parses a text.  `file_name` is for errors and notes.  Throws sim::ConfigError when it is too large, not
  /// well-formed or has another root element than `root`.
  XmlFile(const std::string& text, const std::string& file_name, const std::string& root);
  ~XmlFile();

  XmlElement root() const;
  /// Lines of the comments before the root element, without blanks around them.
  std::vector<std::string> leading_comment() const;
  /// Adds a note when the file has a document type.
  void note_document_type(std::vector<ImportNote>& notes) const;

 private:
  std::unique_ptr<tinyxml2::XMLDocument> document_;
  const std::string* file_;
};

/// Throws sim::ConfigError about a file.
[[noreturn]] void refuse_file(const std::string& file_name, const std::string& text, int line = 0);

/// Returns the text of a file.  Throws sim::ConfigError when it is missing, not a file or too large.
std::string read_robot_file(const std::string& path);

}  // namespace tools
