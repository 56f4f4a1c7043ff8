#include "tools/mpm/setup/rocks.hpp"

#include <algorithm>
#include <numbers>

#include "tools/mpm/scene/checks.hpp"
#include "tools/mpm/setup/cut_point.hpp"

namespace mpm {
namespace {

std::string name_of(const RockOfScene& rock, std::size_t number) {
  return rock.single ? "rock." + rock.name : "rock " + std::to_string(number) + " of rocks." + rock.name;
}

/// Of any form: so large that mass and inertia are numbers to divide by.
template <int D>
void expect_size(const std::string& name, const RockShape<D>& shape) {
  const double across = 2 * std::min(shape.inner_radius(), shape.equivalent_radius());
  const auto range = range_of("size_m");
  if (across >= range.least && shape.bounding_radius() <= range.most) return;
  throw InputError(name + ": is " + in_words(across) + " m across at its thinnest, and reaches " +
                   in_words(shape.bounding_radius()) + " m from its centre; allowed: " + in_words(range.least) +
                   " to " + in_words(range.most) + " m; give its sizes (radius_m, half_axes_m, file_stl) in m");
}

template <int D>
Rock<D> made(const RockOfScene& each, const RockMaterialOfScene& material, double thickness, Rocks<D>& rocks) {
  Rock<D> rock;
  rock.name = each.name;
  rock.single = each.single;
  rock.material = int(each.material);
  rock.shape = int(rocks.shapes.size());
  Vec<3> centre = Vec<3>::Zero();
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
  rocks.shapes.push_back(shape_of<D>(each, &centre, &axes));
  const auto& shape = rocks.shapes.back();
  expect_size<D>(name_of(each, rocks.all.size()), shape);
  auto& body = rock.body;
  body.mass = material.density * shape.volume() * thickness;
  body.inertia = material.density * thickness * shape.inertia();
  body.centre = vector_of<D>(each.centre);
  body.orientation = orientation_of<D>(each);
  // A polyhedron is turned about the origin of its file, and that is put at centre_m.
  if constexpr (D == 3) {
    body.centre += body.orientation * centre;
    body.orientation = body.orientation * axes;
  }
  body.velocity = vector_of<D>(each.velocity);
  body.set_spin(Eigen::Map<const Spin<D>>(each.spin.data()));
  for (const auto& held : each.held) {
    if (held == "rotation") body.turns = false;
    for (int i = 0; i < D; ++i) {
      if (held == axis_names[i]) body.free[i] = 0;
    }
  }
  return rock;
}

/// m, the largest side of a domain of soil.
template <int D>
double point_size(const Scene& scene) {
  double size = 0;
  for (const auto& region : scene.regions) {
    const auto side = filling_of(scene, region).side;
    size = std::max(size, *std::max_element(side.begin(), side.end()));
  }
  return size;
}

template <int D>
void check_places(const Scene& scene, const Solver<D>& solver) {
  auto& rocks = *solver.rocks;
  const auto walls = walls_at<D>(solver.grid, solver.planes, solver.bodies, 0);
  const auto& all = scene.rocks->all;
  const double size = point_size<D>(scene);
  constexpr double most_points = 1e6;  // of the surface of a rock, a cell apart
  for (std::size_t k = 0; k < all.size() && size > 0 && !rocks.soil.ghosts; ++k) {
    const double radius = rocks.shapes[k].bounding_radius(), cells = radius / solver.grid.cell.minCoeff();
    const double points = D == 2 ? 2 * std::numbers::pi * cells : 4 * std::numbers::pi * cells * cells;
    if (points <= most_points) continue;
    throw InputError(name_of(all[k], k) + ": reaches " + in_words(radius) + " m from its centre, and would have " +
                     in_words(points) + " points of its surface, a cell apart; allowed: up to " +
                     in_words(most_points) + "; make the rock smaller, or grid.cell_m larger");
  }
  rocks.find_candidates(walls, Vec<D>::Zero(), 0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double across = 2 * rocks.shapes[k].inner_radius();
    if (across >= 2.5 * size) continue;
    throw InputError(name_of(all[k], k) + ": is " + in_words(across) + " m across, and the soil's points " +
                     in_words(size) +
                     " m: soil cannot part before it; allowed: two and a half points or more; make it larger, or "
                     "grid.cell_m smaller");
  }
  for (const auto& pair : rocks.pairs) {
    const auto& a = rocks.all[std::size_t(pair.first)];
    const bool wall = pair.second >= int(rocks.all.size());
    const auto number = std::size_t(pair.second) - (wall ? rocks.all.size() : 0);
    const double gap = wall ? rocks.gap_to(a, walls[number]).gap
                            : gap_between<D>(a.placed(rocks.shapes), rocks.all[number].placed(rocks.shapes)).gap;
    const double allowed = 0.05 * rocks.shapes[std::size_t(a.shape)].inner_radius();
    if (gap >= -allowed) continue;
    const std::string other = !wall ? name_of(all[number], number)
                              : number < solver.planes.all.size()
                                  ? "boundary." + solver.planes.all[number].name
                                  : "body." + solver.bodies.all[number - solver.planes.all.size()].name;
    throw InputError(name_of(all[std::size_t(pair.first)], std::size_t(pair.first)) + ": stands " + in_words(-gap) +
                     " m in " + other + " at the start; move one of them");
  }
}

}  // namespace

template <int D>
void place_rocks(const Scene& scene, Solver<D>& solver) {
  if (!scene.rocks) return;
  const auto& of = *scene.rocks;
  auto rocks = std::make_unique<Rocks<D>>();
  rocks->soil = of.soil;
  rocks->thickness = scene.thickness;
  rocks->steps_per_collision = of.steps_per_collision;
  for (const auto& material : of.materials) rocks->materials.push_back(material.constants);
  for (const auto& each : of.all) {
    rocks->all.push_back(made<D>(each, of.materials[each.material], D == 2 ? scene.thickness : 1, *rocks));
  }
  rocks->prepare_walls(solver.bodies);
  solver.rocks = std::move(rocks);
  check_places<D>(scene, solver);
  solver.rocks->first_energy = solver.rocks->energy(vector_of<D>(scene.gravity)).residual;
}

/// What lies in rocks; false: the point goes as a whole.
template <int D>
bool cut(const Rocks<D>& rocks, Point<D>& point) {
  const double corner = point.half.norm();
  std::vector<const Rock<D>*> near;
  for (const auto& rock : rocks.all) {
    if (rocks.distance(rock, point.position, corner) < corner) near.push_back(&rock);
  }
  return near.empty() || cut_point<D>(point, [&](const Vec<D>& position) {
           return std::any_of(near.begin(), near.end(),
                              [&](const auto* rock) { return rocks.distance(*rock, position, 0) < 0; });
         });
}

/// Its ball, if its middle is in no rock; a grain's, if that is in none by more than half.
template <int D>
bool give_ball(Rocks<D>& rocks, const Point<D>& point, double grain) {
  const double radius = grain > 0 ? grain : ghost_radius<D>(point, rocks.soil.porosity);
  const double middle = grain > 0 ? 0.5 * grain : 0, farthest = std::max(middle, 2 * point.half.norm());
  for (std::size_t k = 0; k < rocks.all.size(); ++k) {
    const auto& rock = rocks.all[k];
    if (rocks.distance(rock, point.position, farthest) > farthest) continue;
    Vec<D> outward;
    const auto& shape = rocks.shapes[std::size_t(rock.shape)];
    const double gap = shape.distance(to_body<D>(rock.body.orientation, point.position - rock.body.centre), outward);
    if (gap < middle) {
      rocks.displacing.insert(int(k));
      return false;
    }
    // Its own domain, or where the next point along an axis would stand, reaches into the rock.
    const Vec<D> along = to_world<D>(rock.body.orientation, outward).cwiseAbs().cwiseProduct(point.half);
    if (grain == 0 && gap < std::max(along.sum(), 2 * along.maxCoeff()))
      rocks.beside.push_back({rocks.balls.size(), int(k), gap});
  }
  rocks.add_ball(point, radius, grain > 0);
  return true;
}

/// The ball of a point between which and a rock in the soil no other stands reaches that rock: on a lattice balls of
/// one size touch few places of a rock, and it would lie loose. A rock that lies on the soil finds it as flat as it is.
template <int D>
void widen_balls(Rocks<D>& rocks, const std::vector<Point<D>>& points) {
  for (const auto& [ball, number, gap] : rocks.beside) {
    if (!rocks.displacing.contains(number) || gap <= rocks.balls[ball]) continue;
    double room = gap;
    for (const auto& rock : rocks.all) room = std::min(room, rocks.distance(rock, points[ball].position, room));
    rocks.balls[ball] = std::max(rocks.balls[ball], room);
  }
  rocks.beside.clear();
  rocks.displacing.clear();
}

template <int D>
bool clear_of_rocks(Solver<D>& solver, Point<D>& point, double grain) {
  if (!solver.rocks) return true;
  auto& rocks = *solver.rocks;
  const double volume = point.volume;
  const bool stays = rocks.soil.ghosts ? give_ball<D>(rocks, point, grain) : cut<D>(rocks, point);
  rocks.left_out += !stays;
  rocks.left_out_volume += volume - (stays ? point.volume : 0);
  return stays;
}

template <int D>
void finish_rocks(const Scene& scene, Solver<D>& solver, std::vector<std::string>& told) {
  if (!solver.rocks) return;
  auto& rocks = *solver.rocks;
  widen_balls<D>(rocks, solver.points);
  double volume = 0;
  for (const auto& rock : rocks.all) volume += rocks.shapes[std::size_t(rock.shape)].volume() * rocks.thickness;
  told.push_back(std::to_string(rocks.all.size()) + " rocks of " + in_words(volume) + " m3; " +
                 std::to_string(rocks.left_out) + " points left out where they stand, " +
                 in_words(rocks.left_out_volume) + " m3 of soil in all");
  const double size = point_size<D>(scene), cell = solver.grid.cell.minCoeff();
  const auto small = std::count_if(rocks.all.begin(), rocks.all.end(), [&](const auto& rock) {
    return 2 * rocks.shapes[std::size_t(rock.shape)].inner_radius() < 5 * size;
  });
  if (small > 0) {
    told.push_back(std::to_string(small) +
                   " rocks are less than five points of soil across: what soil does between them "
                   "is coarse");
  }
  long narrow = 0;
  for (const auto& [first, second] : rocks.rocks_within(cell)) {
    const auto& a = rocks.all[std::size_t(first)];
    const auto& b = rocks.all[std::size_t(second)];
    narrow += size > 0 && gap_between<D>(a.placed(rocks.shapes), b.placed(rocks.shapes)).gap < cell;
  }
  if (narrow > 0) {
    told.push_back(std::to_string(narrow) +
                   " gaps between rocks are narrower than a cell: soil in them has no stress of "
                   "its own");
  }
  // With the first size of the cells, also in a run that is resumed.
  const bool met = !rocks.soil.ghosts && !scene.regions.empty();
  for (int k = 0; met && k < int(rocks.shapes.size()); ++k) rocks.outline(k, outline_spacing * cell);
}

#define MPM_INSTANTIATE(D)                                        \
  template void place_rocks<D>(const Scene&, Solver<D>&);         \
  template bool clear_of_rocks<D>(Solver<D>&, Point<D>&, double); \
  template void finish_rocks<D>(const Scene&, Solver<D>&, std::vector<std::string>&);
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
