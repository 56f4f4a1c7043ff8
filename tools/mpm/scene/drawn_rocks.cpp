// Rocks drawn at random, and what a scene with rocks may not have. Declared in rocks.hpp.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/mpm/scene/rocks.hpp"
#include "tools/mpm/scene/scene.hpp"

namespace mpm {
namespace {

constexpr int most_sweeps = 5000;  // of pushing apart; random places at 50 % by volume want some hundreds
constexpr std::size_t most_rocks = 200'000;

/// Uniform from 0 to 1, the same with any library.
class Draw {
 public:
  explicit Draw(long seed) : engine_(std::uint64_t(seed)) {}
  double operator()() { return double(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// Shoemake 1992: uniform over all orientations.
Rot<3> any_orientation(Draw& draw, std::integral_constant<int, 3>) {
  const double u = draw(), a = 2 * std::numbers::pi * draw(), b = 2 * std::numbers::pi * draw();
  return {std::sqrt(u) * std::cos(b), std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
          std::sqrt(u) * std::sin(b)};
}
Rot<2> any_orientation(Draw& draw, std::integral_constant<int, 2>) { return 2 * std::numbers::pi * draw(); }

std::vector<double> numbers_of(double angle) { return {angle}; }
std::vector<double> numbers_of(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

template <int D>
struct Drawn {
  RockShape<D> shape;
  Vec<D> centre;
  Rot<D> orientation;
  bool moves;
  Placed<D> placed() const { return {&shape, centre, orientation}; }
};

/// m, of the box that a shape fills along each axis, to one side.
template <int D>
Vec<D> extent(const Drawn<D>& rock) {
  Vec<D> half;
  for (int i = 0; i < D; ++i) half[i] = rock.shape.height(to_body<D>(rock.orientation, Vec<D>::Unit(i)));
  return half;
}

template <int D>
void keep_inside(const RockField& field, Drawn<D>& rock) {
  const Vec<D> half = extent(rock);
  for (int i = 0; i < D; ++i) {
    const double low = field.lower[std::size_t(i)] + half[i], high = field.upper[std::size_t(i)] - half[i];
    rock.centre[i] = std::clamp(rock.centre[i], std::min(low, high), std::max(low, high));
  }
}

/// One sweep; the least gap found, m.
template <int D>
double push_apart(const RockField& field, std::vector<Drawn<D>>& rocks) {
  std::vector<std::size_t> order(rocks.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto low = [&](std::size_t k) { return rocks[k].centre[0] - rocks[k].shape.bounding_radius(); };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
  double least = 1e300;
  for (std::size_t m = 0; m < order.size(); ++m) {
    auto& a = rocks[order[m]];
    const double reach = a.shape.bounding_radius() + field.gap;
    for (std::size_t n = m + 1; n < order.size() && low(order[n]) < a.centre[0] + reach + 1e-3 * reach; ++n) {
      auto& b = rocks[order[n]];
      const double touch = reach + b.shape.bounding_radius();
      if ((!a.moves && !b.moves) || (a.centre - b.centre).squaredNorm() > touch * touch) continue;
      const auto gap = gap_between<D>(a.placed(), b.placed());
      least = std::min(least, gap.gap);
      const double wanted = field.gap + 1e-4 * std::min(a.shape.inner_radius(), b.shape.inner_radius()) - gap.gap;
      if (wanted <= 0) continue;
      const Vec<D> apart = wanted / (a.moves && b.moves ? 2 : 1) * gap.normal;
      if (a.moves) a.centre -= apart;
      if (b.moves) b.centre += apart;
    }
  }
  for (auto& rock : rocks) {
    if (rock.moves) keep_inside<D>(field, rock);
  }
  return least;
}

/// Diameters from the largest on: as many of each as its part of the volume asks for.
template <int D>
std::vector<double> diameters_of(const RockField& field, Draw& draw) {
  double box = field.share, parts = 0;
  for (int i = 0; i < D; ++i) box *= field.upper[std::size_t(i)] - field.lower[std::size_t(i)];
  for (const auto& row : field.diameters) parts += row[1];
  std::vector<double> all;
  for (const auto& row : field.diameters) {
    const double one = D == 2 ? std::numbers::pi / 4 * row[0] * row[0] : std::numbers::pi / 6 * std::pow(row[0], 3);
    const double count = std::round(box * row[1] / parts / one);
    if (count > double(most_rocks)) {
      throw InputError("rocks." + field.name + ".diameters_m: " + in_words(count) + " rocks of " + in_words(row[0]) +
                       " m would be drawn; allowed: up to " + std::to_string(most_rocks) +
                       "; take larger ones, or a smaller volume_share");
    }
    for (double left = box * row[1] / parts;;) {
      const double size = 1 + field.spread * (2 * draw() - 1), volume = one * std::pow(size, D);
      if (left < 0.5 * volume) break;
      left -= volume;
      all.push_back(row[0] * size);
    }
  }
  std::sort(all.begin(), all.end(), std::greater<>());
  return all;
}

template <int D>
RockOfScene rock_of(const RockField& field, double diameter, Draw& draw) {
  RockOfScene rock;
  rock.name = field.name;
  rock.single = false;
  rock.material = field.material;
  rock.velocity.assign(D, 0);
  rock.spin.assign(D == 2 ? 1 : 3, 0);
  rock.rotation = field.aligned ? field.rotation : numbers_of(any_orientation(draw, std::integral_constant<int, D>()));
  rock.blockiness = field.blockiness;
  const bool round =
      field.blockiness == std::vector<double>{2, 2} &&
      std::all_of(field.aspect.begin(), field.aspect.end(), [&](double a) { return a == field.aspect[0]; });
  if (round) {
    rock.radius = 0.5 * diameter;
    return rock;
  }
  rock.form = RockOfScene::Form::superquadric;
  rock.half_axes = field.aspect;
  const double radius = shape_of<D>(rock).equivalent_radius();
  for (double& axis : rock.half_axes) axis *= 0.5 * diameter / radius;
  return rock;
}

template <int D>
void draw_in(const RockField& field, std::vector<RockOfScene>& all) {
  std::vector<Drawn<D>> rocks;
  for (const auto& other : all) {
    rocks.push_back({shape_of<D>(other), vector_of<D>(other.centre), orientation_of<D>(other), false});
  }
  const std::size_t first = all.size();
  Draw draw(field.seed);
  for (const double diameter : diameters_of<D>(field, draw)) {
    auto rock = rock_of<D>(field, diameter, draw);
    Drawn<D> drawn{shape_of<D>(rock), Vec<D>::Zero(), orientation_of<D>(rock), true};
    for (int i = 0; i < D; ++i) {
      const auto axis = std::size_t(i);
      drawn.centre[i] = field.lower[axis] + draw() * (field.upper[axis] - field.lower[axis]);
      if (field.upper[axis] - field.lower[axis] >= 2 * extent(drawn)[i]) continue;
      throw InputError("rocks." + field.name + ".diameters_m: a rock of " + in_words(diameter) +
                       " m does not fit between lower_m and upper_m along " + axis_names[i] +
                       "; make it smaller, or the box larger");
    }
    keep_inside<D>(field, drawn);
    rocks.push_back(drawn);
    all.push_back(rock);
  }
  if (all.size() == first) {
    throw InputError("rocks." + field.name + ".volume_share = " + in_words(field.share) +
                     " is less than one rock in the box; make it larger, or diameters_m smaller");
  }
  double least = -1;
  for (int sweep = 0; sweep < most_sweeps && least < field.gap; ++sweep) least = push_apart<D>(field, rocks);
  if (least < field.gap) {
    throw InputError("rocks." + field.name + ".volume_share = " + in_words(field.share) + ": after " +
                     std::to_string(most_sweeps) + " sweeps two rocks are still " + in_words(least) +
                     " m apart (asked: " + in_words(field.gap) +
                     "); make volume_share or gap_m smaller, or the grading wider");
  }
  for (std::size_t k = first; k < all.size(); ++k) {
    all[k].centre.assign(rocks[k].centre.data(), rocks[k].centre.data() + D);
  }
}

}  // namespace

void draw_rocks(const RockField& field, std::vector<RockOfScene>& all) {
  if (field.lower.size() == 2) {
    draw_in<2>(field, all);
  } else {
    draw_in<3>(field, all);
  }
}

void check_rocks(const Scene& scene, const std::string& path) {
  if (!scene.rocks) return;
  const auto refuse = [&](const std::string& words) { throw InputError(path + ": " + words); };
  if (scene.surface_pressure != 0) {
    refuse(
        "loads.surface_pressure_Pa and rocks do not go together: contact would see only what exceeds it; load the "
        "soil by a boundary or a [[body]] that moves");
  }
  const auto of_table = [](const auto& region) { return !region.grains.empty(); };
  if (scene.rocks->soil.porosity > 0 && !scene.regions.empty() &&
      std::all_of(scene.regions.begin(), scene.regions.end(), of_table)) {
    refuse("rock_soil.porosity is of points that fill a box, and all are balls of a table here; remove it");
  }
  if (scene.water) refuse("[fluid] and rocks do not go together yet; remove one of them");
  if (scene.loads.any()) refuse("loads that change with time and rocks do not go together yet; remove one of them");
  for (const auto& plane : scene.planes) {
    if (!std::isnan(plane.to))
      refuse("boundary." + plane.name + " is periodic, and rocks do not cross it; make it a roller");
  }
}

}  // namespace mpm
