#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>

#include "sim/terrain/terrain.hpp"

namespace sim {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// libpng's reader of one file.  Its errors come back by longjmp, so that what it does stays in functions without
/// objects of their own.
class PngReader {
 public:
  explicit PngReader(std::FILE* file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &on_error, &on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw TerrainError("cannot be read: no memory");
    png_init_io(png_, file);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  void read_header() {
    if (!try_header()) fail();
  }
  /// 16 bits a point, as the machine keeps them; the northern row first.
  void read_rows(std::uint16_t* points) {
    if (!try_rows(points)) fail();
  }
  std::int64_t columns() const { return png_get_image_width(png_, info_); }
  std::int64_t rows() const { return png_get_image_height(png_, info_); }
  bool grey() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY; }

 private:
  [[noreturn]] void fail() const { throw TerrainError("is no readable PNG: " + std::string(message_)); }
  bool try_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    return true;
  }
  bool try_rows(std::uint16_t* points) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_expand_16(png_);
    png_set_swap(png_);
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    for (int pass = 0; pass < passes; ++pass)
      for (std::int64_t row = 0; row < rows(); ++row)
        png_read_row(png_, reinterpret_cast<png_bytep>(points + row * columns()), nullptr);
    png_read_end(png_, nullptr);
    return true;
  }
  static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[120] = "";
};

}  // namespace

HeightGrid read_png_grid(const std::string& path, double cell_m, double low_m, double high_m) {
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw TerrainError("cannot be read");
  PngReader png(file.get());
  png.read_header();
  if (!png.grey()) throw TerrainError("is a picture with colors or transparency: heights must be plain grey");
  check_grid_size(png.columns(), png.rows());
  HeightGrid grid;
  grid.columns = static_cast<int>(png.columns());
  grid.rows = static_cast<int>(png.rows());
  grid.cell_m = cell_m;
  std::vector<std::uint16_t> points(static_cast<std::size_t>(grid.columns) * grid.rows);
  png.read_rows(points.data());
  grid.heights_m.resize(points.size());
  std::size_t next = 0;
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column)
      grid.at(column, row) = low_m + (high_m - low_m) * points[next++] / 65535.0;
  return grid;
}

}  // namespace sim
