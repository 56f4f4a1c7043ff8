// What rocks touch that is no rock: planes, prescribed bodies, plates. Declared in rocks.hpp.
#include <cmath>
#include <numbers>

#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

/// Gap of a plane and a rock above it, normal from the rock to the plane.
template <int D>
Gap<D> gap_to_plane(const Placed<D>& rock, const Vec<D>& point, const Vec<D>& normal) {
  const Vec<D> lowest =
      to_world<D>(rock.orientation, rock.shape->support(to_body<D>(rock.orientation, Vec<D>(-normal))));
  const double gap = normal.dot(rock.centre + lowest - point);
  return {gap, -normal, rock.centre + lowest - 0.5 * gap * normal};
}

/// Of a rock and ground: a ball's from its middle. Of others at the point of the rock that is lowest along the normal
/// of the ground below it, in turns, and at the point of the ground that is nearest to the rock's middle, for faces
/// over ridges: the least of these.
template <int D>
Gap<D> gap_to_terrain(const Placed<D>& rock, const Vec<D>& first, const Terrain<D>& ground) {
  const double radius = rock.shape->bounding_radius(), reach = radius + ground.far;
  Vec<D> normal;
  const double above = ground.distance_within(reach, rock.centre - first, normal);
  Gap<D> best{above - radius, -normal, rock.centre - (radius + 0.5 * (above - radius)) * normal};
  if (rock.shape->is_sphere() || above > reach) return best;
  const Vec<D> foot = rock.centre - above * normal;
  Vec<D> outward;
  const double depth = rock.shape->distance(to_body<D>(rock.orientation, Vec<D>(foot - rock.centre)), outward);
  best = {depth, to_world<D>(rock.orientation, outward), foot};
  for (int turn = 0; turn < 20; ++turn) {
    const Vec<D> lowest =
        rock.centre + to_world<D>(rock.orientation, rock.shape->support(to_body<D>(rock.orientation, Vec<D>(-normal))));
    const Vec<D> before = normal;
    const double gap = ground.distance_within(reach, lowest - first, normal);
    if (gap < best.gap) best = {gap, -normal, lowest - 0.5 * gap * normal};
    if ((normal - before).squaredNorm() < 1e-20) break;
  }
  return best;
}

/// Of a ball and a box: to the nearest point of it; inside, out by the nearest face.
template <int D>
Gap<D> gap_to_box(const Vec<D>& centre, double radius, const Vec<D>& middle, const Vec<D>& half) {
  const Vec<D> r = centre - middle, nearest = r.cwiseMax(-half).cwiseMin(half);
  Vec<D> outward = r - nearest;
  double distance = outward.norm();
  if (distance > 0) {
    outward /= distance;
  } else {
    int axis = 0;
    distance = (r.cwiseAbs() - half).maxCoeff(&axis);
    outward = Vec<D>::Unit(axis) * (r[axis] < 0 ? -1 : 1);
  }
  return {distance - radius, -outward, centre - (radius + 0.5 * (distance - radius)) * outward};
}

RockShape<3> box_polyhedron(const Vec<3>& half) {
  std::vector<Triangle> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const auto corner = [&](int u, int v) {
        Vec<3> point;
        point[axis] = side * half[axis];
        point[(axis + 1) % 3] = u * side * half[(axis + 1) % 3];
        point[(axis + 2) % 3] = v * half[(axis + 2) % 3];
        return point;
      };
      triangles.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
      triangles.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  }
  Vec<3> centre;
  Eigen::Quaterniond axes;
  return RockShape<3>::polyhedron(triangles, &centre, &axes);
}

/// Gap of two convex outlines in the plane of x and y: the largest of n.d - h_a(n) - h_b(-n), d from a to b.
template <int D, class Height>
double largest_gap(const Height& gap_along, Vec<D>& normal) {
  constexpr int around = 72;
  const auto direction = [](double angle) {
    Vec<D> n = Vec<D>::Zero();
    n[0] = std::cos(angle);
    n[1] = std::sin(angle);
    return n;
  };
  const double step = 2 * std::numbers::pi / around;
  double best = -1e300, at = 0;
  for (int k = 0; k < around; ++k) {
    const double gap = gap_along(direction(k * step));
    if (gap > best) best = gap, at = k * step;
  }
  double low = at - step, high = at + step;
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  for (int k = 0; k < 70; ++k) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    (gap_along(direction(a)) > gap_along(direction(b)) ? high : low) =
        gap_along(direction(a)) > gap_along(direction(b)) ? b : a;
  }
  normal = direction(0.5 * (low + high));
  return gap_along(normal);
}

}  // namespace

template <int D>
Gap<D> Rocks<D>::gap_to(const Rock<D>& rock, const Wall<D>& wall) const {
  const auto placed = rock.placed(shapes);
  if (wall.body == nullptr) return gap_to_plane<D>(placed, wall.point, wall.normal);
  if (const auto* half = std::get_if<HalfSpace<D>>(&wall.body->shape)) {
    return gap_to_plane<D>(placed, wall.point, half->normal);
  }
  if (const auto* ground = std::get_if<Terrain<D>>(&wall.body->shape)) {
    return gap_to_terrain<D>(placed, wall.point, *ground);
  }
  const double radius = placed.shape->bounding_radius();
  const auto* box = std::get_if<Box<D>>(&wall.body->shape);
  if (placed.shape->is_sphere() && box != nullptr)
    return gap_to_box<D>(rock.body.centre, radius, wall.point, box->half);
  if (placed.shape->is_sphere()) {
    Vec<D> outward;
    const double distance = wall.body->distance(rock.body.centre - wall.point, outward);
    return {distance - radius, -outward, rock.body.centre - (radius + 0.5 * (distance - radius)) * outward};
  }
  if (box != nullptr && D == 3) {
    const Placed<D> other{&*box_shapes_[std::size_t(wall.number)], wall.point, unturned<D>()};
    const bool far = (placed.centre - other.centre).norm() > radius + other.shape->bounding_radius();
    return far ? Gap<D>{1e300, Vec<D>::Unit(0), placed.centre} : gap_between<D>(placed, other);
  }
  // A box in the plane, or a disc; in space a cylinder along z.
  const auto* disc = std::get_if<Disc<D>>(&wall.body->shape);
  const auto gap_along = [&](const Vec<D>& n) {
    const double own = placed.shape->height(to_body<D>(placed.orientation, n));
    const double others = disc != nullptr ? disc->radius : box->half.dot(n.cwiseAbs());
    return n.dot(wall.point - placed.centre) - own - others;
  };
  Vec<D> normal;
  const double gap = largest_gap<D>(gap_along, normal);
  const Vec<D> end = to_world<D>(placed.orientation, placed.shape->support(to_body<D>(placed.orientation, normal)));
  return {gap, normal, placed.centre + end + 0.5 * gap * normal};
}

template <int D>
std::vector<Wall<D>> walls_at(const Grid<D>& grid, const Planes<D>& planes, const Bodies<D>& bodies, double time) {
  std::vector<Wall<D>> walls;
  for (const auto& plane : planes.all) {
    Wall<D> wall;
    wall.normal[plane.axis] = plane.inside;
    wall.point[plane.axis] = grid.anchor[plane.axis] + plane.node * grid.cell[plane.axis];
    wall.velocity = plane.velocity.at(time);
    wall.follows_material = plane.fixed;
    wall.there = time < plane.removed_at;
    walls.push_back(wall);
  }
  for (const auto& body : bodies.all) {
    Wall<D> wall;
    wall.body = &body;
    wall.point = body.centre_at(time);
    wall.velocity = body.velocity_at(time);
    if (body.pressed()) {
      wall.mass = body.plate->mass;
      wall.acceleration = body.plate->acceleration();
    }
    wall.follows_material = body.rough;
    wall.friction = body.friction;
    wall.number = int(&body - bodies.all.data());
    walls.push_back(wall);
  }
  return walls;
}

template <int D>
void Rocks<D>::prepare_walls(const Bodies<D>& bodies) {
  box_shapes_.clear();
  for (const auto& body : bodies.all) {
    box_shapes_.emplace_back();
    if constexpr (D == 3) {
      if (const auto* box = std::get_if<Box<3>>(&body.shape)) box_shapes_.back() = box_polyhedron(box->half);
    }
  }
}

template std::vector<Wall<2>> walls_at(const Grid<2>&, const Planes<2>&, const Bodies<2>&, double);
template std::vector<Wall<3>> walls_at(const Grid<3>&, const Planes<3>&, const Bodies<3>&, double);
template Gap<2> Rocks<2>::gap_to(const Rock<2>&, const Wall<2>&) const;
template Gap<3> Rocks<3>::gap_to(const Rock<3>&, const Wall<3>&) const;
template void Rocks<2>::prepare_walls(const Bodies<2>&);
template void Rocks<3>::prepare_walls(const Bodies<3>&);

}  // namespace mpm
