// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/xml_file.hpp"

#include <tinyxml2.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "sim/config/message_text.hpp"

namespace tools {

namespace {

/// Hint for a file of another format; empty: unknown.
std::string hint_of(const std::string& root, const std::string& expected) {
  if (root == "sdf" && expected != root) return "; this is SDF: use `shoal import sdf`";
  if (root == "robot" && expected != root) return "; this is URDF: use `shoal import urdf`";
  if (root == "mujoco") return "; this is a model of MuJoCo";
  return root.find("xacro") != std::string::npos ? "; this is xacro: run `xacro FILE > robot.urdf`" : "";
}

}  // namespace

XmlFile::XmlFile(const std::string& text, const std::string& file_name, const std::string& root)
    : document_(std::make_unique<tinyxml2::XMLDocument>()), file_(sim::intern_file_name(file_name)) {
  if (text.size() > max_robot_file_bytes) refuse_file(file_name, "must be at most 16 MiB");
  if (document_->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document_->ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    refuse_file(file_name, deep ? "elements are nested too deeply" : "is not well-formed XML",
                document_->ErrorLineNum());
  }
  const tinyxml2::XMLElement* element = document_->RootElement();
  if (element == nullptr)
    refuse_file(file_name, "has no element: " + std::string(root == "sdf" ? "SDF" : "URDF") + " has a <" + root + ">");
  const std::string name = element->Name();
  if (name != root)
    refuse_file(file_name,
                "the root element must be <" + root + ">, got <" + sim::shortened(sim::printable(name)) + ">" +
                    hint_of(name, root),
                element->GetLineNum());
}

XmlFile::~XmlFile() = default;

XmlElement XmlFile::root() const {
  return {*document_->RootElement(), file_, ""};
}

std::vector<std::string> XmlFile::leading_comment() const {
  std::vector<std::string> lines;
  for (const auto* node = document_->FirstChild(); node != nullptr && node->ToElement() == nullptr;
       node = node->NextSibling()) {
    if (node->ToComment() == nullptr) continue;
    std::istringstream text(node->Value());
    for (std::string line; std::getline(text, line);) {
      const std::size_t first = line.find_first_not_of(" \t\r"), last = line.find_last_not_of(" \t\r");
      if (first != std::string::npos) lines.push_back(sim::printable(line.substr(first, last - first + 1)));
    }
  }
  return lines;
}

void XmlFile::note_document_type(std::vector<ImportNote>& notes) const {
  for (const auto* node = document_->FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToUnknown() == nullptr) continue;
    notes.push_back({{file_, node->GetLineNum(), 0}, "the document type is not read; its entities are not expanded"});
    return;  // other unknown nodes are its definitions
  }
}

void refuse_file(const std::string& file_name, const std::string& text, int line) {
  sim::throw_config_error({sim::intern_file_name(file_name), line, 0}, "", text);
}

std::string read_robot_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse_file(path, "is a folder, not a file");
  if (!std::filesystem::is_regular_file(path, error)) refuse_file(path, "does not exist");
  if (std::filesystem::file_size(path, error) > max_robot_file_bytes) refuse_file(path, "must be at most 16 MiB");
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) refuse_file(path, "cannot be read");
  return text;
}

}  // namespace tools
