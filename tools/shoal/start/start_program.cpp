// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/start/start_program.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "sim/config/file_access.hpp"

namespace tools {

namespace {

namespace fs = std::filesystem;

/// Returns an example without its license line, for a program and a vehicle with other names.
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

/// Returns the folder of the Python package of this installation or build folder.
fs::path package_folder() {
  std::error_code error;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path();
  // A build folder has the part in Python before its module is built.
  for (const char* folder : {"lib/python3/dist-packages", "lib/python"})
    for (const fs::directory_entry& file : fs::directory_iterator(prefix / folder / "shoal", error))
      if (file.path().extension() == ".so") return prefix / folder;
  throw std::runtime_error(
      "there is no Python package beside this program: `tools/build programs` in the checkout builds "
      "it, `cmake --install` installs it");
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
  const std::string folder = package_folder().string();
  const std::string text = adapted(shipped() / "examples/python/pilot.py", name, vehicle);
  if (folder.starts_with("/usr/lib/")) return {{name + ".py", text}};  // python3 looks there
  const std::string path = "\nimport sys\n\nsys.path.insert(0, \"" + folder + "\")  # the Python package\n";
  return {{name + ".py", replaced(text, "\nimport sys\n", path)}};
}

}  // namespace tools
