// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/distance_field.hpp"

#include <spdlog/fmt/fmt.h>

#include <limits>

#include "shoal/message_codec.hpp"

namespace autonomy {

namespace {

constexpr double far = 1e20;

/// The lower envelope of the parabolas y = (x - i)^2 + squares[i], for each whole x.
void transform(std::vector<double>& squares, std::vector<int>& vertices, std::vector<double>& borders,
               std::vector<double>& result) {
  const int n = static_cast<int>(squares.size());
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  int last = -1;
  for (int i = 0; i < n; ++i) {
    if (squares[at(i)] >= far) continue;
    double border = -far;
    for (; last >= 0; --last) {
      const int vertex = vertices[at(last)];
      border = (squares[at(i)] - squares[at(vertex)] + double(i) * i - double(vertex) * vertex) / (2.0 * (i - vertex));
      if (border > borders[at(last)]) break;
    }
    if (last < 0) border = -far;
    ++last;
    vertices[at(last)] = i;
    borders[at(last)] = border;
  }
  int current = 0;
  for (int x = 0; x < n; ++x) {
    while (current < last && borders[at(current + 1)] < x) ++current;
    result[at(x)] = last < 0 ? far : squared(x - vertices[at(current)]) + squares[at(vertices[at(current)])];
  }
}

}  // namespace

GridFrame frame_of(const shoal::occupancy_grid_t& map) {
  constexpr double max_cells = 16e6, farthest_m = 1e7;
  const double cells = static_cast<double>(map.width) * map.height;
  if (map.width < 1 || map.height < 1 || cells > max_cells || cells != map.ncells)
    // The map comes from another program; the limits bound memory and time.
    throw shoal::MessageError(
        fmt::format("'ncells' must be width * height, above 0 and at most {:g}, got {} of {} x {}", max_cells,
                    map.ncells, map.width, map.height));
  if (!(map.cell_m >= 0.001 && map.cell_m <= 1))
    throw shoal::MessageError(fmt::format("'cell_m' must be from 0.001 to 1 m, got {:g}", map.cell_m));
  for (const double origin_m : map.origin_m)
    if (!(std::abs(origin_m) <= farthest_m))
      throw shoal::MessageError(fmt::format("'origin_m' must be within {:g} m, got {:g}", farthest_m, origin_m));
  return {{map.origin_m[0], map.origin_m[1]}, map.cell_m, map.width, map.height};
}

std::vector<float> distances_m(const GridFrame& frame, const std::vector<char>& marked) {
  // Squared distances separate by axes: a pass over the columns and one over the rows, each linear in the number of
  // cells (Felzenszwalb and Huttenlocher 2012).
  std::vector<double> squares(frame.size());
  for (std::size_t i = 0; i < squares.size(); ++i) squares[i] = marked[i] != 0 ? 0 : far;
  const auto pass = [&](int lines, int length, std::size_t line_step, std::size_t step) {
    std::vector<double> line(static_cast<std::size_t>(length)), borders(line), result(line);
    std::vector<int> vertices(line.size());
    for (int i = 0; i < lines; ++i) {
      double* first = squares.data() + static_cast<std::size_t>(i) * line_step;
      for (std::size_t k = 0; k < line.size(); ++k) line[k] = first[k * step];
      transform(line, vertices, borders, result);
      for (std::size_t k = 0; k < line.size(); ++k) first[k * step] = result[k];
    }
  };
  const auto columns = static_cast<std::size_t>(frame.columns);
  pass(frame.columns, frame.rows, 1, columns);
  pass(frame.rows, frame.columns, columns, 1);
  std::vector<float> distances(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i)
    distances[i] = squares[i] >= far ? std::numeric_limits<float>::infinity()
                                     : static_cast<float>(frame.cell_m * std::sqrt(squares[i]));
  return distances;
}

}  // namespace autonomy
