#include "tools/mpm/setup_points.hpp"

#include <cmath>

#include "tools/mpm/cut_point.hpp"
#include "tools/mpm/scene_checks.hpp"
#include "tools/mpm/setup_rocks.hpp"

namespace mpm {
namespace {

/// What lies under ground is left out; false: all of the point. A grain stays or goes as a whole.
template <int D>
bool above_ground(const Bodies<D>& bodies, Point<D>& point, double grain) {
  for (const auto& body : bodies.all) {
    const auto* ground = std::get_if<Terrain<D>>(&body.shape);
    if (ground == nullptr) continue;
    Vec<D> outward;
    const auto under = [&](const Vec<D>& place) {
      return ground->distance(place - body.centre, outward, point.half) < 0;
    };
    if (grain > 0 && under(point.position)) return false;
    if (grain > 0) continue;
    if (ground->distance(point.position - body.centre, outward, point.half) > point.half.norm()) continue;
    if (!cut_point<D>(point, under)) return false;
  }
  return true;
}

/// What lies inside a body that is met at its surface would be left there, and move through it.
template <int D>
void refuse_inside(const Scene& scene, const RegionOfScene& region, const Bodies<D>& bodies, const Point<D>& point) {
  for (const auto& body : bodies.all) {
    Vec<D> outward;
    const double depth = -body.distance(point.position - body.centre, outward, point.half);
    if (!body.at_surface || depth < 1e-6 * point.half.minCoeff()) continue;
    const std::vector<double> place(point.position.data(), point.position.data() + D);
    throw InputError(region_name(scene, region) + ": its point at " + text_of(place) + " m would lie inside body." +
                     body.name + " at the start; move one of them, or set contact = \"nodes\" in body." + body.name +
                     ", which then holds what is inside");
  }
}

/// One point, which fills a box of these sides (m). grain: m, its radius; 0: of a box.
template <int D>
void put(const Scene& scene, const RegionOfScene& region, const Vec<D>& place, const Vec<D>& side, double grain,
         Solver<D>& solver) {
  Point<D> point;
  point.position = point.first = place;
  point.velocity = vector_of<D>(region.velocity);
  point.half = 0.5 * side;
  point.volume = side.prod() * (D == 2 ? scene.thickness : 1);
  if (!above_ground<D>(solver.bodies, point, grain)) return;
  refuse_inside<D>(scene, region, solver.bodies, point);
  if (clear_of_rocks<D>(solver, point, grain)) solver.points.push_back(point);
}

template <int D>
bool outside(const RegionOfScene& region, const Vec<D>& place) {
  if (!region.ellipsoid) return false;
  const Vec<D> low = vector_of<D>(region.lower), high = vector_of<D>(region.upper);
  return (2 * place - low - high).cwiseQuotient(high - low).squaredNorm() > 1;
}

/// Its points, whatever stands there.
template <int D>
void fill_all(const Scene& scene, const RegionOfScene& region, Solver<D>& solver) {
  for (const auto& grain : region.grains) {
    const double side = std::pow(region.volume_of(grain), 1.0 / D);
    put<D>(scene, region, Eigen::Map<const Vec<D>>(grain.data()), Vec<D>::Constant(side), grain.back(), solver);
  }
  if (!region.grains.empty()) return;
  const auto filling = filling_of(scene, region);
  const Vec<D> side = vector_of<D>(filling.side);
  for (long k = 0; k < filling.total; ++k) {
    Vec<D> place;
    long rest = k;
    for (int i = 0; i < D; ++i) {
      const long count = filling.count[std::size_t(i)];
      place[i] = region.lower[std::size_t(i)] + (double(rest % count) + 0.5) * side[i];
      rest /= count;
    }
    if (!outside<D>(region, place)) put<D>(scene, region, place, side, 0, solver);
  }
}

}  // namespace

template <int D>
void fill(const Scene& scene, const RegionOfScene& region, Solver<D>& solver) {
  const std::size_t before = solver.points.size();
  fill_all<D>(scene, region, solver);
  if (solver.points.size() > before) return;
  throw InputError(region_name(scene, region) + ": has no point that is clear of terrain and rocks; move it, or them");
}

template void fill<2>(const Scene&, const RegionOfScene&, Solver<2>&);
template void fill<3>(const Scene&, const RegionOfScene&, Solver<3>&);

}  // namespace mpm
