#include "tools/mpm/setup/points.hpp"

#include <algorithm>
#include <cmath>

#include "tools/mpm/scene/checks.hpp"
#include "tools/mpm/setup/cut_point.hpp"
#include "tools/mpm/setup/rocks.hpp"

namespace mpm {
namespace {

/// What lies under ground is left out; false: all of the point. A grain stays or goes as a whole.
template <int D>
bool above_ground(const Bodies<D>& bodies, Point<D>& point, double grain) {
  for (const auto& body : bodies.all) {
    const auto* ground = std::get_if<Terrain<D>>(&body.shape);
    if (ground == nullptr) continue;
    Vec<D> outward;
    const auto under = [&](const Vec<D>& position) {
      return ground->distance(position - body.centre, outward, point.half) < 0;
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
    const std::vector<double> position(point.position.data(), point.position.data() + D);
    throw InputError(region_name(scene, region) + ": its point at " + in_words(position) + " m would lie inside body." +
                     body.name + " at the start; move one of them, or set contact = \"nodes\" in body." + body.name +
                     ", which then holds what is inside");
  }
}

/// One point, which fills a box of these sides (m). grain: m, its radius; 0: of a box.
template <int D>
void put(const Scene& scene, const RegionOfScene& region, const Vec<D>& position, const Vec<D>& side, double grain,
         Solver<D>& solver) {
  Point<D> point;
  point.position = point.first = position;
  point.velocity = vector_of<D>(region.velocity);
  point.half = 0.5 * side;
  point.volume = side.prod() * (D == 2 ? scene.thickness : 1);
  if (!above_ground<D>(solver.bodies, point, grain)) return;
  refuse_inside<D>(scene, region, solver.bodies, point);
  if (clear_of_rocks<D>(solver, point, grain)) solver.points.push_back(point);
}

template <int D>
bool outside(const RegionOfScene& region, const Vec<D>& position) {
  if (!region.ellipsoid) return false;
  const Vec<D> low = vector_of<D>(region.lower), high = vector_of<D>(region.upper);
  return (2 * position - low - high).cwiseQuotient(high - low).squaredNorm() > 1;
}

/// m, of a box that fills space with its like: the number of the one where a position is, x fastest.
template <int D>
long number_at(const RegionOfScene& region, const Filling& filling, const Vec<D>& position) {
  long number = 0;
  for (int i = D - 1; i >= 0; --i) {
    const double at = (position[i] - region.lower[std::size_t(i)]) / filling.side[std::size_t(i)];
    const long count = filling.count[std::size_t(i)];
    number = number * count + std::clamp(long(std::floor(at)), 0L, count - 1);
  }
  return number;
}

/// Slivers beside rocks join the nearest point of the boxes about them, at the centre of mass of both; one that has
/// none goes. `first`: the number of the region's first point; points stand in the order of their boxes.
template <int D>
void join(const std::vector<Point<D>>& slivers, const RegionOfScene& region, const Filling& filling, std::size_t first,
          Solver<D>& solver) {
  auto& points = solver.points;
  std::vector<long> numbers;
  for (std::size_t k = first; k < points.size() && !slivers.empty(); ++k)
    numbers.push_back(number_at<D>(region, filling, points[k].first));
  const Vec<D> side = vector_of<D>(filling.side);
  for (const auto& sliver : slivers) {
    Point<D>* nearest = nullptr;
    const auto middle = [&](const Point<D>& of) -> Vec<D> {
      return (of.volume * of.position + sliver.volume * sliver.position) / (of.volume + sliver.volume);
    };
    const auto in_rock = [&](const Vec<D>& position) {
      const auto& rocks = *solver.rocks;
      return std::any_of(rocks.all.begin(), rocks.all.end(),
                         [&](const auto& rock) { return rocks.distance(rock, position, 0) < 0; });
    };
    for (long n = 0; n < (D == 2 ? 9 : 27); ++n) {
      const long steps[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      Vec<D> beside = sliver.first;
      for (int i = 0; i < D; ++i) beside[i] += double(steps[i]) * side[i];
      const auto found = std::lower_bound(numbers.begin(), numbers.end(), number_at<D>(region, filling, beside));
      if (found == numbers.end() || *found != number_at<D>(region, filling, beside)) continue;
      auto& point = points[first + std::size_t(found - numbers.begin())];
      const auto distance = [&](const Point<D>& to) { return (to.first - sliver.first).squaredNorm(); };
      if ((nearest == nullptr || distance(point) < distance(*nearest)) && !in_rock(middle(point))) nearest = &point;
    }
    if (nearest == nullptr) {
      ++solver.rocks->left_out;
      solver.rocks->left_out_volume += sliver.volume;
      continue;
    }
    const double volume = nearest->volume + sliver.volume;
    nearest->position = middle(*nearest);
    nearest->half *= std::pow(volume / nearest->volume, 1.0 / D);
    nearest->volume = volume;
  }
  for (std::size_t k = first; k < points.size() && !slivers.empty(); ++k) points[k].first = points[k].position;
}

/// Part of its box that a point beside a rock has at least. A smaller one is squeezed into what stands behind it,
/// plates or other rocks, swells there, and its waves shorten every step: rocks of 10 mm (soil_rock_triaxial) take
/// 3,720 steps of 0.06 s with parts of 0.05, 2,480 of 0.25, 2,075 of 0.4, where the soil's own would be 2,000, and the
/// same stress. With 0.33 the mean stress of soil around a rock is coarser than half a per cent.
constexpr double least_part = 0.25;

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
  const double least = least_part * side.prod() * (D == 2 ? scene.thickness : 1);
  const bool by_rocks = solver.rocks && !solver.rocks->soil.ghosts;
  const std::size_t first = solver.points.size();
  std::vector<Point<D>> slivers;
  for (long k = 0; k < filling.total; ++k) {
    Vec<D> position;
    long rest = k;
    for (int i = 0; i < D; ++i) {
      const long count = filling.count[std::size_t(i)];
      position[i] = region.lower[std::size_t(i)] + (double(rest % count) + 0.5) * side[i];
      rest /= count;
    }
    if (outside<D>(region, position)) continue;
    const std::size_t before = solver.points.size();
    put<D>(scene, region, position, side, 0, solver);
    if (!by_rocks || solver.points.size() == before || solver.points.back().volume >= least) continue;
    slivers.push_back(solver.points.back());
    solver.points.pop_back();
  }
  join<D>(slivers, region, filling, first, solver);
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
