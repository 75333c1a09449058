// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_file.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <vector>

#include "devices/motion/joint_group.hpp"
#include "experiment/files/file_replacement.hpp"
#include "experiment/files/scratch_directory.hpp"
#include "sim/motion/motion_frames.hpp"

namespace motion {

namespace {

namespace fs = std::filesystem;

std::string frames_path(const std::string& path) {
  return fs::path(path).replace_extension(".csv").string();
}

/// Returns whether the motion file names the CSV file beside it, even when the motion file has mistakes.
bool has_frames(const std::string& path) {
  const std::string frames = fs::path(frames_path(path)).filename().string();
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("frames:") && line.find(frames) != std::string::npos) return true;
  return false;
}

/// Version of a motion file.
struct Version {
  int number;
  fs::path file;
};

/// Returns the versions of a kind, ascending; other files in the folder are ignored.
std::vector<Version> versions(const std::string& folder, const std::string& kind) {
  std::vector<Version> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string(), ending = "." + kind + ".yaml";
    if (!name.ends_with(ending)) continue;
    const char* const end = name.data() + name.size() - ending.size();
    int number = 0;
    if (const auto [at, failed] = std::from_chars(name.data(), end, number); failed == std::errc{} && at == end)
      found.push_back({number, entry.path()});
  }
  std::sort(found.begin(), found.end(), [](const Version& a, const Version& b) { return a.number < b.number; });
  return found;
}

fs::path frames_of(const Version& version) {
  return fs::path(version.file).replace_extension(".csv");
}

/// File of the operation between a version and the next one.
fs::path operation_of(const Version& version) {
  return fs::path(version.file).replace_extension(".txt");
}

void remove(const Version& version) {
  std::error_code error;
  fs::remove(frames_of(version), error);
  fs::remove(operation_of(version), error);
  fs::remove(version.file, error);
}

void copy_over(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::exists(from)) {
    fs::remove(to, error);
    return;
  }
  std::ifstream file(from, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error("'" + from.string() + "' cannot be read");
  experiment::write_whole_file(to.string(), text);
}

/// Content of a motion file and of the CSV file beside it.
struct Content {
  std::string text;
  std::optional<std::string> frames;

  void write_to(const std::string& path) const {
    if (frames) experiment::write_whole_file(frames_path(path), *frames);
    experiment::write_whole_file(path, text);
  }
};

/// Reads the content once.  Throws EditError when that fails.
void check_readable(const std::string& path, const Content& content) {
  const experiment::ScratchDirectory scratch;
  const std::string trial = (scratch.path / fs::path(path).filename()).string();
  content.write_to(trial);
  try {
    sim::load_motion(trial);
  } catch (const sim::ConfigError& error) {
    std::string line = error.lines().front();
    if (line.starts_with(scratch.path.string())) line.erase(0, scratch.path.string().size() + 1);
    throw EditError("'" + path + "' is not written, because it would be invalid: " + line);
  }
}

/// Returns what a file is to contain.  Throws EditError when it could not be read again.
Content content_of(const std::string& path, sim::JointMotion motion) {
  Content content;
  const double end_s = motion.end_s();
  if (!(end_s <= sim::max_motion_s))
    throw EditError(
        fmt::format("'{}' is not written: a motion lasts at most {} s, got {:g}", path, sim::max_motion_s, end_s));
  if (motion.keys.size() > max_written_keys) {
    const double values = end_s / motion.frame_s * static_cast<double>(motion.tracks().size());
    if (values > max_frame_values)
      throw EditError(fmt::format("'{}' is not written: its frames would have {:.3g} values, and {:.3g} are the most",
                                  path, values, max_frame_values));
    motion.frames = sim::sampled(motion.tracks(), motion.end_s(), motion.frame_s);
    motion.keys.clear();
  }
  if (!motion.frames.empty()) {
    content.frames = sim::motion_frames_text(motion.frames);  // frames have common times
    motion.frames_file = fs::path(frames_path(path)).filename().string();
  }
  content.text = sim::motion_text(motion);
  check_readable(path, content);
  return content;
}

}  // namespace

void check_readable(const std::string& path, const sim::JointMotion& motion) {
  Content content{sim::motion_text(motion), std::nullopt};
  if (!motion.frames.empty()) content.frames = sim::motion_frames_text(motion.frames);
  check_readable(path, content);
}

void write_motion(const std::string& path, const sim::JointMotion& motion) {
  content_of(path, motion).write_to(path);
}

std::string foreign_frames(const std::string& path) {
  const std::string frames = frames_path(path);
  std::error_code error;
  return fs::exists(frames, error) && !has_frames(path) ? frames : "";
}

std::string foreign_frames(const std::string& path, const sim::JointMotion& motion) {
  return motion.frames.empty() && motion.keys.size() <= max_written_keys ? "" : foreign_frames(path);
}

std::string motion_name_of(const std::string& path) {
  std::string name = fs::path(path).stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return name.empty() ? "motion" : name;
}

namespace {

/// Copies a motion file as the next version of a kind, with the operation that leads to or from it.  Removes it again
/// when that fails.
Version store(const std::string& path, const std::string& folder, const std::string& kind,
              const std::string& operation) {
  std::error_code error;
  fs::create_directories(folder, error);
  const std::vector<Version> before = versions(folder, kind);
  const int number = before.empty() ? 1 : before.back().number + 1;
  char name[40];
  std::snprintf(name, sizeof name, "%06d.%s.yaml", number, kind.c_str());
  const Version version{number, fs::path(folder) / name};
  try {
    if (has_frames(path)) copy_over(frames_path(path), frames_of(version));
    if (!operation.empty()) experiment::write_whole_file(operation_of(version).string(), operation + "\n");
    copy_over(path, version.file);
  } catch (...) {
    remove(version);
    throw;
  }
  return version;
}

}  // namespace

void MotionHistory::replace(const sim::JointMotion& motion, const std::string& operation) const {
  const Content content = content_of(path_, motion);
  const Version kept = store(path_, folder(), "undo", operation);
  try {
    content.write_to(path_);
  } catch (...) {
    remove(kept);
    throw;
  }
  for (const Version& version : versions(folder(), "redo")) remove(version);
}

std::string MotionHistory::move(const std::string& from, const std::string& to) const {
  const std::vector<Version> found = versions(folder(), from);
  if (found.empty()) throw std::runtime_error("there is nothing to " + from + " for '" + path_ + "'");
  const fs::path frames = frames_of(found.back());
  const std::string foreign = foreign_frames(path_);
  if (!foreign.empty() && fs::exists(frames))
    throw std::runtime_error("'" + foreign + "' does not belong to '" + path_ + "', and is in the way of its frames");
  std::string operation;
  std::ifstream file(operation_of(found.back()));
  std::getline(file, operation);
  // The present version is stored first, so that no failure loses one.
  const Version kept = store(path_, folder(), to, operation);
  try {
    if (foreign.empty()) copy_over(frames, frames_path(path_));
    copy_over(found.back().file, path_);
  } catch (...) {
    remove(kept);
    throw;
  }
  remove(found.back());
  return operation;
}

sim::JointMotion MotionHistory::previous() const {
  const std::vector<Version> found = versions(folder(), "undo");
  if (found.empty()) throw std::runtime_error("'" + path_ + "' has no earlier version");
  // The motion names its frames as they are named beside the file.
  const experiment::ScratchDirectory scratch;
  const fs::path file = scratch.path / fs::path(path_).filename();
  copy_over(found.back().file, file);
  copy_over(frames_of(found.back()), frames_path(file.string()));
  return sim::load_motion(file.string());
}

MirrorRule mirror_rule(const sim::VehicleConfig& vehicle) {
  for (const sim::DeviceConfig& device : vehicle.devices) {
    const auto* group = dynamic_cast<const sim::detail::ParamsOf<devices::JointGroup::Params>*>(device.params.get());
    if (group == nullptr || group->params.mirror.swap.empty()) continue;
    MirrorRule rule;
    for (const auto& [left, right] : group->params.mirror.swap) rule.swap.emplace_back(left, right);
    rule.negate = group->params.mirror.negate;
    return rule;
  }
  throw EditError("vehicle '" + vehicle.vehicle +
                  "' does not say how its motions are mirrored: 'mirror' of a joint_group");
}

}  // namespace motion
