// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/mtn_file.hpp"

#include "sim/config/message_text.hpp"
#include "sim/motion/motion.hpp"

namespace motion {

namespace {

constexpr std::string_view magic = "OMTN";
constexpr std::uint32_t head_size = 24;
constexpr std::uint32_t number_of_sections = 4;

/// Reader of little-endian numbers.
class MtnParser {
 public:
  MtnParser(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  MtnFile parse() {
    MtnFile file;
    if (!bytes_.starts_with(magic)) fail(0, "must start with 'OMTN'");
    at_ = magic.size();
    const std::size_t keys = read_head();
    read_names(file);
    read_locators(file);
    read_keys(file, keys);
    if (at_ != bytes_.size()) fail(at_, "must end here, and " + std::to_string(bytes_.size() - at_) + " bytes follow");
    return file;
  }

 private:
  [[noreturn]] void fail(std::size_t at, const std::string& text) const {
    sim::throw_config_error({sim::intern_file_name(file_), 0, 0}, "", "byte " + std::to_string(at) + ": " + text);
  }

  void need(std::size_t size, const char* what) const {
    if (bytes_.size() - at_ < size) fail(at_, std::string("the file ends in ") + what);
  }

  std::uint32_t number(std::size_t size, const char* what) {
    need(size, what);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes_[at_ + i])) << (8 * i);
    at_ += size;
    return value;
  }

  void expect(std::size_t size, std::uint32_t expected, const char* what) {
    const std::size_t begin = at_;
    const std::uint32_t value = number(size, what);
    if (value != expected)
      fail(begin, std::string(what) + " must be " + std::to_string(expected) + ", got " + std::to_string(value));
  }

  std::string text(const char* what) {
    const std::size_t size = number(1, what);
    need(size, what);
    const std::string text(bytes_.substr(at_, size));
    at_ += size;
    return text;
  }

  std::size_t read_head() {
    expect(4, 0, "the number of the section");
    expect(4, head_size, "the size of section 0");
    expect(4, number_of_sections, "the number of sections");
    expect(2, 1, "the major version");
    expect(2, 2, "the minor version");
    const std::size_t keys = number(2, "the number of keys");
    if (keys == 0) fail(at_ - 2, "the number of keys must be at least 1, got 0");
    expect(2, 16, "the time of a frame in ms");
    expect(4, 0, "the last field of section 0");
    return keys;
  }

  /// Starts a section; returns where it ends.
  std::size_t begin_section(std::uint32_t section) {
    const std::size_t begin = at_;
    expect(4, section, "the number of the section");
    const std::size_t size = number(4, "the size of the section");
    if (size < 8 || size % 4 != 0 || size > bytes_.size() - begin)
      fail(begin + 4, "the size of section " + std::to_string(section) +
                          " must be a multiple of 4 up to the end of the file, got " + std::to_string(size));
    return begin + size;
  }

  /// Ends a section with up to 3 zero bytes.
  void end_section(std::size_t end) {
    if (at_ > end || end - at_ > 3)
      fail(at_, "the section must end here, and its size says byte " + std::to_string(end));
    while (at_ < end) expect(1, 0, "a byte after the texts of the section");
  }

  void read_names(MtnFile& file) {
    const std::size_t end = begin_section(1);
    file.name = text("the name of the motion");
    file.creator = text("the name of the creator");
    file.design = text("the design label");
    end_section(end);
  }

  void read_locators(MtnFile& file) {
    const std::size_t end = begin_section(2);
    const std::size_t joints = number(2, "the number of joints");
    if (joints == 0 || joints > sim::max_motion_joints)
      fail(at_ - 2, "the number of joints must be from 1 to 200, got " + std::to_string(joints));
    for (std::size_t i = 0; i < joints; ++i) file.locators.push_back(text("the locator of a joint"));
    end_section(end);
  }

  void read_keys(MtnFile& file, std::size_t keys) {
    const std::size_t end = begin_section(3);
    expect(4, 0, "the type of the data");
    const std::size_t joints = file.locators.size();
    // Every key but the first is preceded by a number of frames.
    const std::size_t size = 4 * (3 + joints) + (keys - 1) * 4 * (4 + joints);
    if (end - at_ != size)
      fail(at_, std::to_string(keys) + " keys of " + std::to_string(joints) + " joints need " + std::to_string(size) +
                    " bytes, and the section has " + std::to_string(end - at_));
    double time_s = 0;
    for (std::size_t i = 0; i < keys; ++i) {
      MtnKey& key = file.keys.emplace_back();
      if (i > 0) {
        key.between = signed_number();
        if (key.between < 0) fail(at_ - 4, "the number of frames must be >= 0, got " + std::to_string(key.between));
        // The number counts the frames between two keys, without the key itself.
        time_s += (key.between + 1.0) * mtn_frame_s;
        if (time_s > sim::max_motion_s) fail(at_ - 4, "the motion must last at most 86400 s");
      }
      key.roll = signed_number();
      key.pitch = signed_number();
      key.yaw = signed_number();
      for (std::size_t j = 0; j < joints; ++j) key.joints.push_back(signed_number());
    }
  }

  std::int32_t signed_number() { return static_cast<std::int32_t>(number(4, "a key")); }

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
};

/// Writer of little-endian numbers.
class MtnWriter {
 public:
  void number(std::size_t size, std::uint32_t value) {
    for (std::size_t i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
  }
  void signed_number(std::int32_t value) { number(4, static_cast<std::uint32_t>(value)); }
  void text(const std::string& text) {
    number(1, static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
  }
  void begin_section(std::uint32_t section) {
    begin_ = bytes_.size();
    number(4, section);
    number(4, 0);
  }
  /// Fills the section up with zeros and sets its size.
  void end_section() {
    while ((bytes_.size() - begin_) % 4 != 0) bytes_ += '\0';
    const std::size_t size = bytes_.size() - begin_;
    for (std::size_t i = 0; i < 4; ++i) bytes_[begin_ + 4 + i] = static_cast<char>(size >> (8 * i) & 0xff);
  }

  std::string bytes_{magic};

 private:
  std::size_t begin_ = 0;
};

}  // namespace

MtnFile parse_mtn(std::string_view bytes, const std::string& file) {
  return MtnParser(bytes, file).parse();
}

std::string mtn_bytes(const MtnFile& file) {
  MtnWriter out;
  out.begin_section(0);
  out.number(4, number_of_sections);
  out.number(2, 1);
  out.number(2, 2);
  out.number(2, static_cast<std::uint32_t>(file.keys.size()));
  out.number(2, 16);
  out.number(4, 0);
  out.end_section();
  out.begin_section(1);
  for (const std::string& text : {file.name, file.creator, file.design}) out.text(text);
  out.end_section();
  out.begin_section(2);
  out.number(2, static_cast<std::uint32_t>(file.locators.size()));
  for (const std::string& locator : file.locators) out.text(locator);
  out.end_section();
  out.begin_section(3);
  out.number(4, 0);
  for (std::size_t i = 0; i < file.keys.size(); ++i) {
    const MtnKey& key = file.keys[i];
    if (i > 0) out.signed_number(key.between);
    for (const std::int32_t angle : {key.roll, key.pitch, key.yaw}) out.signed_number(angle);
    for (const std::int32_t angle : key.joints) out.signed_number(angle);
  }
  out.end_section();
  return std::move(out.bytes_);
}

}  // namespace motion
