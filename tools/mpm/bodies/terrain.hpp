// Ground of any form: heights on a regular map, soil and rocks above them. A shape of shapes.hpp.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "tools/mpm/grid/grid.hpp"
#include "tools/mpm/keys/keys.hpp"

namespace mpm {

/// Heights along the last axis over the others. Between them a cubic convolution (Keys 1981, IEEE Trans. Acoust. Speech
/// Signal Process. 29, 1153): through every height, with slopes that do not jump. At an edge the slope goes on.
template <int D>
struct Terrain {
  static constexpr const char* kind = "terrain";
  static constexpr bool rough_by_default = false;
  static constexpr int up = D - 1;
  double spacing = 0;           ///< m, of the map along each axis
  std::array<int, up> count{};  ///< heights along each axis
  std::vector<double> heights;  ///< m above the centre, which is the place of the first; along x fastest
  double cosine = 1;            ///< of the steepest slope
  double far = 0;               ///< m; farther places need no exact distance

  static Terrain read(Keys& keys);
  void settle(const Keys& keys);
  /// m, at a place from the first height; slope: its gradient, 0 along the last axis; curvature, 1/m, if it is asked
  /// for: its second derivatives likewise.
  double height(const Vec<D>& r, Vec<D>& slope, Mat<D>* curvature = nullptr) const;
  /// To the nearest place of the surface, found from the one below; a lower bound of what is farther than `far` or 16
  /// times `unit`, which is enough for soil.
  double distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>& unit) const;
  /// The same of whatever is not farther than `reach` (m).
  double distance_within(double reach, const Vec<D>& r, Vec<D>& outward) const;
  bool spans(const Vec<D>&, const Vec<D>&) const { return true; }
  unsigned char face_of(const Vec<D>&) const { return 1; }
  int column_axis() const { return -1; }
  /// Where columns of nodes come through the surface, on steep ground more closely, so that points stay a cell or so
  /// apart.
  template <class Visit>
  void each_surface_point(const Grid<D>& grid, const Vec<D>& centre, const Visit& visit) const {
    long columns = 1;
    for (int i = 0; i < up; ++i) columns *= grid.count[i];
    for (long column = 0; column < columns; ++column) {
      auto node = grid.low;
      long rest = column;
      for (int i = 0; i < up; ++i) {
        node[i] += int(rest % grid.count[i]);
        rest /= grid.count[i];
      }
      const Vec<D> middle = grid.position(node);
      Vec<D> at = middle, slope;
      at[up] = centre[up] + height(at - centre, slope);
      const long parts = std::lround(std::ceil(0.7 / upward(slope)[up]));
      if (parts <= 1) {
        visit(at, upward(slope));
        continue;
      }
      for (long part = 0; part < (up == 1 ? parts : parts * parts); ++part) {
        long left = part;
        for (int i = 0; i < up; ++i) {
          at[i] = middle[i] + ((double(left % parts) + 0.5) / double(parts) - 0.5) * grid.cell[i];
          left /= parts;
        }
        at[up] = centre[up] + height(at - centre, slope);
        visit(at, upward(slope));
      }
    }
  }

 private:
  static Vec<D> upward(const Vec<D>& slope) { return (Vec<D>::Unit(up) - slope).normalized(); }
};

/// Of scenes: a CSV file of heights becomes their rows.
void include_terrain(toml::table& file, const std::string& scene_path);

}  // namespace mpm
