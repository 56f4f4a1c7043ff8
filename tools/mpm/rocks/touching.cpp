// Where soil touches rocks that are met at their surface, and which nodes lie in them. Declared in rocks.hpp.
#include <algorithm>
#include <cmath>

#include "tools/mpm/bodies/touching.hpp"
#include "tools/mpm/grid/clock.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {
constexpr int rock_sweeps = 8;
constexpr long chunk = 1024;  // points of one piece of work
}  // namespace

// Not in an anonymous namespace: lambdas of templates hold it.

/// The outline of a rock where it stands.
template <int D>
struct RockOutline {
  const RockShape<D>& shape;
  Mat<D> axes;
  Vec<D> half;  ///< m, of the box that holds it

  explicit RockOutline(const RockShape<D>& of, const Rot<D>& orientation) : shape(of), axes(matrix_of(orientation)) {
    for (int i = 0; i < D; ++i) half[i] = shape.height(Vec<D>::Unit(i));
  }
  /// m, from the surface to r from the centre; beyond `reach` a part of it, and no normal.
  double distance(const Vec<D>& r, double reach, Vec<D>& outward) const {
    const double length = r.norm(), beyond = length - shape.bounding_radius();
    if (beyond > reach) return beyond;
    if (shape.is_sphere()) {
      outward = length > 0 ? Vec<D>(r / length) : Vec<D>(Vec<D>::Unit(D - 1));
      return beyond;
    }
    // The box that holds the rock, and its tangent plane across r, are no farther than the rock itself.
    const Vec<D> own = axes.transpose() * r;
    double beside = (own.cwiseAbs() - half).maxCoeff();
    if (beside > reach) return beside;
    beside = length > 0 ? length - shape.height(own / length) : 0;
    if (beside > reach) return beside;
    const double distance = shape.distance(own, outward);
    outward = (axes * outward).eval();
    return distance;
  }
};

/// What is found of one rock.
template <int D>
struct Rocks<D>::FoundOnRock {
  bool near_soil = false;
  std::vector<Touched> points;

  void add(const SurfacePoint<D>& point, const Rigid<D>& rock, const Vec<D>& r, double gap, std::size_t index) {
    const Mat<D> mobility = point.mobility * Mat<D>::Identity() + rock.mobility(r, r);
    points.push_back({point, r, mobility, mobility.inverse(), std::max(0.0, gap), index});
  }
};

/// visit(number of a node in the grid, its position from `centre`) for all in the ball about it, x fastest.
template <int D, class Visit>
void each_node_near(const Grid<D>& grid, const Vec<D>& centre, double radius, const Visit& visit) {
  typename Grid<D>::Index first, last;
  for (int i = 0; i < D; ++i) {
    const double at = (centre[i] - grid.anchor[i]) / grid.cell[i], reach = radius / grid.cell[i];
    first[i] = int(std::max<double>(grid.low[i], std::ceil(at - reach)));
    last[i] = int(std::min<double>(grid.low[i] + grid.count[i] - 1, std::floor(at + reach)));
    if (first[i] > last[i]) return;
  }
  auto node = first;
  for (int axis = 0; axis < D;) {
    const Vec<D> r = grid.position(node) - centre;
    if (r.squaredNorm() <= radius * radius) visit(grid.flat(node), r);
    for (axis = 0; axis < D && ++node[axis] > last[axis]; ++axis) node[axis] = first[axis];
  }
}

/// Where a point of soil ends at a rock: position from the centre of the rock, normal, gap (m).
template <int D>
struct Foot {
  Vec<D> position, normal;
  double gap;
};

/// What rocks read of the points of soil, in the order in which they come to them.
template <int D>
class SoilEnds {
 public:
  /// slack: m, up to which a point touches; chunk: points of one piece of work.
  SoilEnds(const Grid<D>& grid, const std::vector<Point<D>>& soil, double slack, long chunk, rvelab::Workers& workers)
      : cells_(grid, soil), ends_(soil.size()), slack_(slack) {
    const long chunks = (long(soil.size()) + chunk - 1) / chunk;
    std::vector<double> widest(std::size_t(chunks), 0.0);
    workers.for_each(chunks, [&](std::int64_t piece) {
      const std::size_t end = std::min(soil.size(), std::size_t(piece + 1) * chunk);
      for (std::size_t k = std::size_t(piece) * chunk; k < end; ++k) {
        const auto& point = soil[std::size_t(cells_.numbers()[k])];
        const Vec<D> half = half_size<D>(point);
        ends_[k] = {point.position, half, slack + (1 + 1e-12) * half.maxCoeff()};
        widest[std::size_t(piece)] = std::max(widest[std::size_t(piece)], ends_[k].reach);
      }
    });
    for (const double each : widest) reach_ = std::max(reach_, each);
  }
  std::vector<Foot<D>> feet_on(const RockOutline<D>& outline, const Vec<D>& centre) const {
    std::vector<Foot<D>> feet;
    cells_.each_entry_near(centre, outline.shape.bounding_radius() + reach_, [&](long entry) {
      const End& point = ends_[std::size_t(entry)];
      Vec<D> outward;
      const Vec<D> r = point.position - centre;
      const double distance = outline.distance(r, point.reach, outward);
      if (distance > point.reach) return;
      const double gap = distance - point.half.cwiseProduct(outward).norm();
      if (gap < slack_) feet.push_back({r - distance * outward, outward, gap});
    });
    return feet;
  }

 private:
  struct End {
    Vec<D> position, half;  ///< m
    double reach;           ///< m, no farther does it touch, rounding included
  };
  PointsByCell<D> cells_;
  std::vector<End> ends_;
  double slack_, reach_ = 0;
};

/// m, from a point on a rock to the soil, whose end is plane about the foot of each point, as far as `near`: the
/// rounded edge of a block stands over it. Soil under a block does not touch its front: their normals differ.
template <int D>
double gap_at(const std::vector<Foot<D>>& feet, double near, const Vec<D>& point, const Vec<D>& normal) {
  double gap = 1e300;
  for (const auto& foot : feet) {
    const bool about = (foot.position - point).squaredNorm() < near * near && foot.normal.dot(normal) > 0.5;
    if (about) gap = std::min(gap, foot.gap + foot.normal.dot(foot.position - point));
  }
  return gap;
}

template <int D>
void Rocks<D>::detect_soil(const Grid<D>& grid, const Planes<D>& planes, Shape shape,
                           const std::vector<Point<D>>& points, rvelab::Workers& workers) {
  surface.clear();
  sweeps = 0;
  if (soil.ghosts) return;
  pressed.resize(all.size());
  const double begin = wall_seconds();
  // More than half of the distance between points of soil.
  const double cell = grid.cell.minCoeff(), near = 0.6 * cell, slack = early * cell;
  const SoilEnds<D> ends(grid, points, slack, chunk, workers);
  for (std::size_t k = 0; k < shapes.size(); ++k) outline(int(k), outline_spacing * cell);
  std::vector<FoundOnRock> found(all.size());
  workers.for_each(std::int64_t(found.size()), [&](std::int64_t k) {
    const auto& rock = all[std::size_t(k)];
    const RockOutline<D> outline(shapes[std::size_t(rock.shape)], rock.body.orientation);
    FoundOnRock& here = found[std::size_t(k)];
    const auto feet = ends.feet_on(outline, rock.body.centre);
    here.near_soil = !feet.empty();
    if (!here.near_soil) return;
    // Nodes in the rock, each by itself: points of the surface a cell apart leave some of them free, which then fall in
    // with the soil's stress in every step.
    each_node_near<D>(grid, rock.body.centre, outline.shape.bounding_radius(), [&](long node, const Vec<D>& r) {
      if (!(grid.nodes[std::size_t(node)].mass > 0) || planes.is_mirror(node)) return;
      SurfacePoint<D> point;
      const double depth = -outline.distance(r, 0, point.normal);
      if (!(depth > 0)) return;
      const double gap = gap_at<D>(feet, near, r + depth * point.normal, point.normal);
      if (gap > slack) return;
      point.owner = int(k);
      point.node[0] = node;
      point.weight[0] = 1;
      point.count = 1;
      point.mobility = 1 / grid.nodes[std::size_t(node)].mass;
      here.add(point, rock.body, r, gap, at_node);
    });
    const auto& around = kept_outline(rock.shape);
    pressed[std::size_t(k)].resize(around.size(), Vec<D>::Zero());
    for (std::size_t number = 0; number < around.size(); ++number) {
      const auto& corner = around[number];
      const Vec<D> r = to_world<D>(rock.body.orientation, corner.at);
      SurfacePoint<D> point;
      point.normal = to_world<D>(rock.body.orientation, corner.normal);
      const double gap = gap_at<D>(feet, near, r, point.normal);
      typename Grid<D>::Index nearest;
      const Vec<D> at = rock.body.centre + r;
      if (gap > slack || !nearest_node(grid, at, nearest) || planes.is_mirror(grid.flat(nearest))) continue;
      point.owner = int(k);
      point.add_nodes(grid, planes, shape, at);
      // To hold light nodes too, as bodies do, cost a ball of points another 4 % of its speed.
      if (point.complete(grid, [](long) {})) here.add(point, rock.body, r, gap, number);
    }
  });
  for (const FoundOnRock& here : found) {
    if (here.near_soil) sweeps = rock_sweeps;
    surface.insert(surface.end(), here.points.begin(), here.points.end());
  }
  soil_contacts = long(surface.size());
  soil_seconds += wall_seconds() - begin;
}

template void Rocks<2>::detect_soil(const Grid<2>&, const Planes<2>&, Shape, const std::vector<Point<2>>&,
                                    rvelab::Workers&);
template void Rocks<3>::detect_soil(const Grid<3>&, const Planes<3>&, Shape, const std::vector<Point<3>>&,
                                    rvelab::Workers&);

}  // namespace mpm
