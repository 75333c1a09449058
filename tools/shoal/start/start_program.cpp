// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/start/start_program.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "sim/config/shipped_files.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

/// Returns an example without its licence line, for a program and a vehicle with other names.
std::string adapted(const fs::path& file, const std::string& name, const std::string& vehicle) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read; the installation is incomplete");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  if (text.substr(0, text.find('\n')).find("SPDX") != std::string::npos) text.erase(0, text.find('\n') + 1);
  text = replaced(std::move(text), " of worlds/minimal.yaml", "");
  // The vehicle last, because its name may contain the word.
  return replaced(replaced(std::move(text), "pilot", name), "rover1", vehicle);
}

fs::path shipped() {
  const std::string folder = sim::shipped_folder();
  if (folder.empty())
    throw std::runtime_error(
        "this program finds no shipped examples: there is neither share/shoal beside its folder nor a checkout that it "
        "was built from");
  return folder;
}

/// Returns the folders of the Python message types and the client: in an installation, or in a checkout and its build
/// folder.
std::vector<fs::path> python_folders() {
  std::error_code error;
  const fs::path build = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  // python/ of a checkout has neither: it is the source of the package.
  std::vector<fs::path> found;
  for (const fs::path& folder : {shipped() / "python", shipped() / "examples/python", build / "python"})
    if (fs::is_regular_file(folder / "pilot.py", error) ||
        fs::is_regular_file(folder / "shoal/twist_command_t.py", error))
      found.push_back(folder);
  return found;
}

/// Returns the file in the first folder that contains it.
fs::path find_in(const std::vector<fs::path>& folders, const std::string& file) {
  std::error_code error;
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / file, error)) return folder / file;
  throw std::runtime_error("there is no " + file +
                           " for Python: cmake --build build/release --target messages_python makes the message types");
}

}  // namespace

std::string replaced(std::string text, const std::string& word, const std::string& with) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + with.size()))
    text.replace(at, word.size(), with);
  return text;
}

StartFiles start_cpp_program(const std::string& name, const std::string& vehicle) {
  const fs::path example = shipped() / "examples/client";
  return {{name + "/" + name + ".cpp", adapted(example / "pilot.cpp", name, vehicle)},
          {name + "/CMakeLists.txt", adapted(example / "CMakeLists.txt", name, vehicle)}};
}

StartFiles start_python_program(const std::string& name, const std::string& vehicle) {
  const std::vector<fs::path> folders = python_folders();
  find_in(folders, "shoal/twist_command_t.py");
  std::string list;
  for (const fs::path& folder : folders) list += (list.empty() ? "\"" : ", \"") + folder.string() + "\"";
  const std::string text = adapted(find_in(folders, "pilot.py"), name, vehicle);
  return {
      {name + ".py", replaced(text, "\nimport sys\n",
                              "\nimport sys\n\nsys.path[:0] = [" + list + "]  # the message types and the client\n")}};
}

}  // namespace tools
