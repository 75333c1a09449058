// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/film/film_writer.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "sim/image/image_file.hpp"
#include "viewer/film/avi_file.hpp"
#include "viewer/film/encoder_program.hpp"

namespace viewer {

namespace {

namespace fs = std::filesystem;

/// Film as one PNG file for each frame.
class PngFrames final : public FilmWriter {
 public:
  /// `start`: path before the number.
  PngFrames(std::string start, const fs::path& folder) : start_(std::move(start)) {
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw FilmError(folder.string() + ": cannot be created: " + error.message());
  }
  ~PngFrames() override {
    if (finished_) return;
    for (int i = 0; i < frames_; ++i) unlink(name(i).c_str());
  }

  void add(const sim::Image8& frame) override {
    const std::string file = name(frames_++);
    try {
      sim::write_image(file, frame);
    } catch (const sim::ImageError& error) {
      throw FilmError(file + ": " + error.what());
    }
  }
  void finish() override { finished_ = true; }

 private:
  std::string name(int number) const { return fmt::format("{}{:05}.png", start_, number); }

  std::string start_;
  int frames_ = 0;
  bool finished_ = false;
};

enum class FilmKind { mp4, webm, avi, png, folder };

FilmKind kind_of(const std::string& file) {
  if (file.ends_with('/')) return FilmKind::folder;
  const std::string ending = fs::path(file).extension().string();
  if (ending == ".mp4") return FilmKind::mp4;
  if (ending == ".webm") return FilmKind::webm;
  if (ending == ".avi") return FilmKind::avi;
  if (ending == ".png") return FilmKind::png;
  throw std::invalid_argument("must end in .mp4, .webm, .avi, .png or a slash (a folder for images), got '" + file +
                              "'");
}

std::vector<std::string> codec_of(FilmKind kind) {
  if (kind == FilmKind::mp4)
    return {"-c:v",     "libx264", "-preset",   "veryfast",   "-crf", "20",
            "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f",   "mp4"};
  return {"-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used", "8",       "-row-mt", "1",
          "-crf", "32",         "-b:v",      "0",        "-pix_fmt",  "yuv420p", "-f",      "webm"};
}

}  // namespace

void check_film_file(const std::string& file, const FilmFormat& format) {
  const FilmKind kind = kind_of(file);
  const bool encoded = kind == FilmKind::mp4 || kind == FilmKind::webm;
  if (encoded && (format.width % 2 != 0 || format.height % 2 != 0))
    throw std::invalid_argument(
        fmt::format("needs an even width and height, got {}x{}: '{}'", format.width, format.height, file));
  if (encoded && !has_ffmpeg())
    throw FilmError(file +
                    ": needs the program ffmpeg (apt install ffmpeg); without it write an .avi or a folder of "
                    "images, which ends in a slash");
  if (kind == FilmKind::folder) return;
  // Where it goes.
  std::error_code error;
  const fs::path folder = fs::path(file).has_parent_path() ? fs::path(file).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) throw FilmError(file + ": cannot be written: no such folder");
  if (fs::is_directory(file, error)) throw FilmError(file + ": cannot be written: it is a folder");
  if (access(folder.c_str(), W_OK) != 0) throw FilmError(file + ": cannot be written: not allowed");
}

std::unique_ptr<FilmWriter> make_film_writer(const std::string& file, const FilmFormat& format) {
  check_film_file(file, format);
  switch (const FilmKind kind = kind_of(file)) {
    case FilmKind::avi:
      return std::make_unique<AviFile>(file, format);
    case FilmKind::png:
      return std::make_unique<PngFrames>(file.substr(0, file.size() - 4) + "_", fs::path());
    case FilmKind::folder:
      return std::make_unique<PngFrames>(file + "frame_", fs::path(file));
    case FilmKind::mp4:
    case FilmKind::webm:
      return std::make_unique<EncoderProgram>(file, format, codec_of(kind));
  }
  throw std::invalid_argument("unknown kind of film");
}

}  // namespace viewer
