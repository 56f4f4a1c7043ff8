// Soil met at the surface of rocks: as with bodies (surface_contact.cpp), and the impulses move the rock too. Declared
// in bodies.hpp.
//
//   K J = -u,   K = (sum N_I^2/m_I) 1 + 1/M + (r x) I^-1 (r x)^T
//
// u: velocity of the soil at a point of the surface less that of the rock there, r from the centre of the rock. J n >=
// 0 and |J_t| <= mu J_n; where it slides, J_n is that with which the soil does not enter: no stiffness, no time step.
#include <algorithm>
#include <cmath>

#include "tools/mpm/clock.hpp"
#include "tools/mpm/rocks.hpp"
#include "tools/mpm/touching.hpp"

namespace mpm {

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

namespace {
constexpr int rock_sweeps = 8;
}  // namespace

/// What is found of one rock.
template <int D>
struct Bodies<D>::RockFound {
  bool near_soil = false;
  std::vector<SurfacePoint> points;
  std::vector<typename Rocks<D>::SurfacePoint> of_rock;
};

template <int D>
void Bodies<D>::detect_rocks(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil) {
  rocks->surface.clear();
  if (rocks->soil.ghosts) return;
  rocks->pressed.resize(rocks->all.size());
  const double begin = wall_seconds();
  const PointsByCell<D> points(grid, soil);
  struct Foot {
    Vec<D> place, normal;
    double gap;
  };
  // More than half of the distance between points of soil.
  const double cell = grid.cell.minCoeff(), near = 0.6 * cell, slack = early * cell;
  // What a rock reads of a point, in the order in which it comes to them.
  struct Near {
    Vec<D> position, half;  ///< m
    double reach;           ///< m, no farther does it touch, rounding included
  };
  std::vector<Near> near_points(soil.size());
  const long chunks = (long(soil.size()) + chunk - 1) / chunk;
  std::vector<double> widest(std::size_t(chunks), 0.0);
  workers_->for_each(chunks, [&](std::int64_t piece) {
    const std::size_t end = std::min(soil.size(), std::size_t(piece + 1) * chunk);
    for (std::size_t k = std::size_t(piece) * chunk; k < end; ++k) {
      const auto& point = soil[std::size_t(points.numbers()[k])];
      const Vec<D> half = half_size<D>(point);
      near_points[k] = {point.position, half, slack + (1 + 1e-12) * half.maxCoeff()};
      widest[std::size_t(piece)] = std::max(widest[std::size_t(piece)], near_points[k].reach);
    }
  });
  const double reach = chunks > 0 ? *std::max_element(widest.begin(), widest.end()) : 0;
  for (std::size_t k = 0; k < rocks->shapes.size(); ++k) rocks->outline(int(k), outline_spacing * cell);
  std::vector<RockFound> found(rocks->all.size());
  workers_->for_each(std::int64_t(found.size()), [&](std::int64_t k) {
    const auto& rock = rocks->all[std::size_t(k)];
    const auto& shape = rocks->shapes[std::size_t(rock.shape)];
    const RockOutline<D> outline(shape, rock.body.orientation);
    RockFound& here = found[std::size_t(k)];
    std::vector<Foot> feet;
    points.each_entry_near(rock.body.centre, shape.bounding_radius() + reach, [&](long entry) {
      const Near& point = near_points[std::size_t(entry)];
      Vec<D> outward;
      const Vec<D> r = point.position - rock.body.centre;
      const double distance = outline.distance(r, point.reach, outward);
      if (distance > point.reach) return;
      const double gap = distance - point.half.cwiseProduct(outward).norm();
      if (gap < slack) feet.push_back({r - distance * outward, outward, gap});
    });
    here.near_soil = !feet.empty();
    if (!here.near_soil) return;
    const auto& places = rocks->kept_outline(rock.shape);
    rocks->pressed[std::size_t(k)].resize(places.size(), Vec<D>::Zero());
    for (std::size_t number = 0; number < places.size(); ++number) {
      const auto& place = places[number];
      const Vec<D> r = to_world<D>(rock.body.orientation, place.at);
      const Vec<D> normal = to_world<D>(rock.body.orientation, place.normal);
      // From each place to the soil, whose end is plane about the foot of each point: the rounded edge of a block
      // stands over it. Soil under a block does not touch its front: their normals differ.
      double gap = 1e300;
      for (const auto& foot : feet) {
        const bool about = (foot.place - r).squaredNorm() < near * near && foot.normal.dot(normal) > 0.5;
        if (about) gap = std::min(gap, foot.gap + foot.normal.dot(foot.place - r));
      }
      typename Grid<D>::Index nearest;
      const Vec<D> at = rock.body.centre + r;
      if (gap > slack || !nearest_node(grid, at, nearest) || planes.is_mirror(grid.flat(nearest))) continue;
      SurfacePoint point;
      point.body = int(all.size()) + int(k);
      point.normal = normal;
      if (!hold_at(grid, planes, point, 0, at)) continue;
      const Mat<D> soil_part = point.mobility * Mat<D>::Identity();
      const Mat<D> mobility = soil_part + rock.body.mobility(r, r);
      here.points.push_back(point);
      here.of_rock.push_back({r, mobility, mobility.inverse(), std::max(0.0, gap), number});
    }
  });
  for (const RockFound& here : found) {
    if (here.near_soil) sweeps_ = std::max(sweeps_, rock_sweeps);
    surface_.insert(surface_.end(), here.points.begin(), here.points.end());
    rocks->surface.insert(rocks->surface.end(), here.of_rock.begin(), here.of_rock.end());
  }
  rocks->soil_contacts = long(rocks->surface.size());
  rocks->soil_seconds += wall_seconds() - begin;
}

template <int D>
void Bodies<D>::predict_rocks(const Vec<D>& gravity, double dt) {
  for (std::size_t k = 0; k < rocks->motion.size(); ++k) {
    const auto& rock = rocks->all[k];
    rocks->motion[k].velocity += dt * (gravity + rock.mean_force / rock.body.mass).cwiseProduct(rock.body.free);
    rocks->motion[k].spin += rock.body.spin_of(dt * rock.mean_torque);
  }
}

/// The impulses of the step before, so that the sweeps of one step go on with those of the last.
template <int D>
void Bodies<D>::press_rocks(Grid<D>& grid) {
  const std::size_t first = surface_.size() - rocks->surface.size();
  each_run(false, [&](const Run& run) {
    for (std::size_t k = std::max(first, run.first); k < run.last; ++k) {
      auto& point = surface_[k];
      const auto& here = rocks->surface[k - first];
      const std::size_t number = std::size_t(point.body) - all.size();
      const auto& rock = rocks->all[number];
      point.now = rocks->step * to_world<D>(rock.body.orientation, rocks->pressed[number][here.place]);
      push_rock(k, point.now, grid, true);
    }
  });
  for (auto& each : rocks->pressed) std::fill(each.begin(), each.end(), Vec<D>::Zero());
}

template <int D>
void Bodies<D>::keep_pressed() {
  const std::size_t first = surface_.size() - rocks->surface.size();
  for (std::size_t k = first; k < surface_.size(); ++k) {
    const std::size_t number = std::size_t(surface_[k].body) - all.size();
    rocks->pressed[number][rocks->surface[k - first].place] =
        to_body<D>(rocks->all[number].body.orientation, Vec<D>(surface_[k].now / rocks->step));
  }
}

/// An impulse (N s) on the soil at a point of a rock, and its opposite on the rock.
template <int D>
void Bodies<D>::push_rock(std::size_t k, const Vec<D>& impulse, Grid<D>& grid, bool end) {
  auto& point = surface_[k];
  const auto& here = rocks->surface[k + rocks->surface.size() - surface_.size()];
  const std::size_t number = std::size_t(point.body) - all.size();
  const auto& rock = rocks->all[number].body;
  auto& motion = rocks->motion[number];
  push(grid, point, impulse, end);
  motion.velocity -= (impulse / rock.mass).cwiseProduct(rock.free);
  motion.spin -= rock.spin_of(moment<D>(here.r, impulse));
}

template <int D>
void Bodies<D>::hold_rock(std::size_t k, Grid<D>& grid, bool end) {
  auto& point = surface_[k];
  const auto& here = rocks->surface[k + rocks->surface.size() - surface_.size()];
  const auto& motion = rocks->motion[std::size_t(point.body) - all.size()];
  Vec<D> relative = velocity_at(grid, point, end) - motion.velocity - spun<D>(motion.spin, here.r);
  relative -= here.mobility * point.now;  // without this point's impulse
  relative += here.gap / rocks->step * point.normal;
  Vec<D> impulse = Vec<D>::Zero();
  const double across = relative.dot(point.normal);
  const Vec<D> stuck = -here.resistance * relative;
  const double pressed = stuck.dot(point.normal);
  if (pressed > 0 || across < 0) {
    impulse = stuck;
    Vec<D> along = stuck - pressed * point.normal;
    const double size = along.norm(), friction = rocks->soil.friction;
    if (!rocks->soil.rough && (size > friction * pressed || pressed <= 0)) {
      if (size > 0) along /= size;
      const Vec<D> direction = point.normal + friction * along;
      const double gives = point.normal.dot(here.mobility * direction);
      impulse = across < 0 && gives > 0 ? Vec<D>(-across / gives * direction) : Vec<D>(Vec<D>::Zero());
    } else if (pressed <= 0) {
      impulse.setZero();
    }
  }
  const Vec<D> more = impulse - point.now;
  if (more.isZero(0)) return;
  point.now = impulse;
  push_rock(k, more, grid, end);
}

/// Impulse and work on the soil, and what the rocks get of it. An impulse J that gives the soil the work A loses
/// J.(U + U')/2 - A, U and U' the velocity of the rock there at the start and at the end of the step: over a step the
/// rock has the sum of both impulses as a force.
template <int D>
void Bodies<D>::book_rocks(const Grid<D>& grid, const Planes<D>& planes) {
  const std::size_t first = surface_.size() - rocks->surface.size();
  for (std::size_t k = first; k < surface_.size(); ++k) {
    const auto& point = surface_[k];
    auto& rock = rocks->all[std::size_t(point.body) - all.size()];
    const Vec<D> impulse = point.at_start + point.at_end;
    rock.impulse -= impulse;
    rock.angular_impulse -= moment<D>(rocks->surface[k - first].r, impulse);
    double work = 0;
    for (int j = 0; j < point.count; ++j) {
      const auto& node = grid.nodes[point.node[j]];
      for (int i = 0; i < D; ++i) {
        if (planes.holds(point.node[j], i)) continue;
        work += point.weight[j] * work_at(node, i, point.at_start[i], point.at_end[i]);
      }
    }
    rocks->work_on_soil += work;
    const auto& end = rocks->motion[std::size_t(point.body) - all.size()];
    const Vec<D>& r = rocks->surface[k - first].r;
    const Vec<D> mean = 0.5 * (rock.body.velocity_at(r) + end.velocity + spun<D>(end.spin, r));
    rocks->surface_loss += impulse.dot(mean) - work;
  }
}

template <int D>
void Bodies<D>::start_rocks() {
  if (rocks == nullptr) return;
  rocks->motion.clear();
  for (const auto& rock : rocks->all) rocks->motion.push_back({rock.body.velocity, rock.body.spin()});
}

#define MPM_INSTANTIATE(D)                                                                               \
  template void Bodies<D>::detect_rocks(const Grid<D>&, const Planes<D>&, const std::vector<Point<D>>&); \
  template void Bodies<D>::predict_rocks(const Vec<D>&, double);                                         \
  template void Bodies<D>::press_rocks(Grid<D>&);                                                        \
  template void Bodies<D>::keep_pressed();                                                               \
  template void Bodies<D>::hold_rock(std::size_t, Grid<D>&, bool);                                       \
  template void Bodies<D>::book_rocks(const Grid<D>&, const Planes<D>&);                                 \
  template void Bodies<D>::start_rocks();
MPM_INSTANTIATE(2)
MPM_INSTANTIATE(3)
#undef MPM_INSTANTIATE

}  // namespace mpm
