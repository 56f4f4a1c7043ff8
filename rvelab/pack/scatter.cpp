#include "rvelab/pack/scatter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "rvelab/error.hpp"
#include "rvelab/grains/direction.hpp"
#include "rvelab/pack/drawn_radii.hpp"
#include "rvelab/specimen/clumps.hpp"
#include "rvelab/specimen/solids.hpp"

namespace rvelab::pack {

namespace {

constexpr int most_tries = 2000;

/// Points of a cell in boxes that are at least as wide as the reach of a contact, periodic.
class Boxes {
 public:
  /// For `points` of them.
  Boxes(const Cell& cell, double reach, std::size_t points)
      : cell_(cell), inverse_(cell.lattice.triangularView<Eigen::Upper>().solve(Matrix3::Identity())) {
    const Vector3 height = heights(cell);
    const double many = 8 * double(points),
                 most = std::min(200.0, cell.dimension == 2 ? std::sqrt(many) : std::cbrt(many));
    for (int k = 0; k < cell.dimension; ++k) count_[k] = std::max(1, int(std::min(most, height[k] / reach)));
    content_.resize(std::size_t(count_[0]) * count_[1] * count_[2]);
  }

  void add(const Vector3& place, double radius) {
    const Vector3 at = inside(place);
    content_[index(box_of(at))].push_back({at, radius});
  }

  /// No point of which any image is nearer than the sum of both radii; own images are the caller's.
  bool free(const Vector3& place, double radius) const {
    const Vector3 at = inside(place);
    const std::array<int, 3> centre = box_of(at);
    for (int z = -reach(2); z <= reach(2); ++z)
      for (int y = -reach(1); y <= reach(1); ++y)
        for (int x = -reach(0); x <= reach(0); ++x) {
          const int shift[3] = {x, y, z};
          std::array<int, 3> box;
          Image image{};
          for (int k = 0; k < 3; ++k) {
            const int place = centre[k] + shift[k];
            image[k] = place >= 0 ? place / count_[k] : -((count_[k] - 1 - place) / count_[k]);
            box[k] = place - image[k] * count_[k];
          }
          const Vector3 moved = translation(cell_, image) - at;
          for (const Point& point : content_[index(box)]) {
            const double distance = radius + point.radius;
            if ((point.at + moved).squaredNorm() < distance * distance) return false;
          }
        }
    return true;
  }

 private:
  struct Point {
    Vector3 at;
    double radius;
  };

  int reach(int axis) const { return axis < cell_.dimension ? 1 : 0; }
  std::size_t index(const std::array<int, 3>& box) const {
    return (std::size_t(box[2]) * count_[1] + box[1]) * count_[0] + box[0];
  }
  /// The image with lattice coordinates from 0 to 1, which the boxes count.
  Vector3 inside(const Vector3& place) const {
    Vector3 part = inverse_ * place;
    for (int k = 0; k < cell_.dimension; ++k) part[k] -= std::floor(part[k]);
    return cell_.lattice * part;
  }
  std::array<int, 3> box_of(const Vector3& at) const {
    const Vector3 part = inverse_ * at;
    std::array<int, 3> box{};
    for (int k = 0; k < cell_.dimension; ++k) box[k] = std::clamp(int(part[k] * count_[k]), 0, count_[k] - 1);
    return box;
  }

  Cell cell_;
  Matrix3 inverse_;
  std::array<int, 3> count_{1, 1, 1};
  std::vector<std::vector<Point>> content_;
};

}  // namespace

namespace {

/// Half axes and exponents of the grain that was added last: of the volume of the sphere of its radius.
void form_solid(const GrainFraction& fraction, Grains& grains) {
  const Vector3& half = fraction.half_axes;
  const double scale = grains.radius.back() /
                       equivalent_radius_of({half[0], half[1], half[2], fraction.exponent_xy, fraction.exponent_z});
  grains.half_x.push_back(scale * half[0]);
  grains.half_y.push_back(scale * half[1]);
  grains.half_z.push_back(scale * half[2]);
  grains.exponent_xy.push_back(fraction.exponent_xy);
  grains.exponent_z.push_back(fraction.exponent_z);
}

/// Lengths and orientation of the grain that was added last.
template <class By>
void lay_outline(const GrainFraction& fraction, Uniform& uniform, Grains& grains) {
  const double range = fraction.largest_aspect_ratio - fraction.smallest_aspect_ratio;
  const auto own = By::of_aspect(grains.radius.back(), fraction.smallest_aspect_ratio + range * uniform());
  each_column_of<By>([](const auto&, auto& column, double value) { column.push_back(value); }, grains, own);
  const auto [x, y] = direction_of(fraction.bedding_angle + fraction.bedding_spread * (2 * uniform() - 1));
  grains.orientation.emplace_back(x, y, 0);
}

}  // namespace

std::vector<double> parts_of(const Recipe& recipe, const std::vector<NumberCurve>& curves) {
  const int d = dimension_of(recipe.shape);
  std::vector<double> parts;
  for (std::size_t f = 0; f < curves.size(); ++f) {
    const GrainFraction& fraction = recipe.fractions[f];
    const double mass = recipe.materials[fraction.material].density * curves[f].mean_power(d);
    parts.push_back(recipe.share_by_mass ? fraction.share / mass : fraction.share);
  }
  return parts;
}

std::vector<std::size_t> numbers_of(const Recipe& recipe, const std::vector<NumberCurve>& curves) {
  std::vector<double> parts = parts_of(recipe, curves);
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0);
  std::vector<std::size_t> numbers;
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::size_t given = 0;
  for (double& part : parts) {
    part *= double(recipe.number) / sum;
    numbers.push_back(std::size_t(part));
    given += numbers.back();
    part -= double(numbers.back());
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return parts[a] > parts[b]; });
  for (std::size_t k = 0; given < recipe.number; k = (k + 1) % order.size(), ++given) ++numbers[order[k]];
  return numbers;
}

Grains graded_grains(const Recipe& recipe) {
  const int d = dimension_of(recipe.shape);
  std::vector<NumberCurve> curves;
  for (const auto& fraction : recipe.fractions) curves.push_back(number_curve(fraction.grading, d));
  const auto numbers = numbers_of(recipe, curves);
  Uniform uniform(recipe.seed);
  Grains grains;
  for (std::size_t f = 0; f < curves.size(); ++f) {
    if (numbers[f] == 0) {
      throw InputError(recipe.fractions[f].table() + " gets no grain of " + std::to_string(recipe.number) +
                       "; allowed: at least one for each fraction; raise pack.number or the fraction's share");
    }
    for (const double radius : drawn_radii(recipe, f, curves, numbers, uniform)) {
      grains.id.push_back(std::int64_t(grains.id.size()));
      grains.radius.push_back(radius);
      grains.material.push_back(std::int32_t(recipe.fractions[f].material));
      with_shape(recipe.shape, [&](auto is) {
        using By = typename decltype(is)::By;
        if constexpr (By::rigid)
          form_solid(recipe.fractions[f], grains);
        else if constexpr (!By::round)
          lay_outline<By>(recipe.fractions[f], uniform, grains);
      });
    }
  }
  grains.position.assign(recipe.number, Vector3::Zero());
  grains.velocity.assign(recipe.number, Vector3::Zero());
  grains.spin.assign(recipe.number, Vector3::Zero());
  return grains;
}

std::vector<const Clump*> clumps_of(const Recipe& recipe, const Grains& grains) {
  const int d = dimension_of(recipe.shape);
  std::vector<NumberCurve> curves;
  for (const auto& fraction : recipe.fractions) curves.push_back(number_curve(fraction.grading, d));
  const auto numbers = numbers_of(recipe, curves);
  std::vector<const Clump*> clumps;
  for (std::size_t f = 0; f < numbers.size(); ++f) clumps.insert(clumps.end(), numbers[f], &*recipe.fractions[f].clump);
  clumps.resize(grains.size(), clumps.back());
  return clumps;
}

Grains around_clumps(const std::vector<const Clump*>& clumps, const Grains& grains) {
  Grains around = grains;
  for (std::size_t k = 0; k < clumps.size(); ++k) around.radius[k] *= clumps[k]->outer_radius;
  return around;
}

namespace {

/// Every turn equally likely (Shoemake 1992, by points of a ball); in the plane every angle.
Turn random_turn(int dimension, Uniform& uniform) {
  if (dimension == 2) {
    const auto [c, s] = direction_of(180 * (2 * uniform() - 1));  // of half the angle
    return {c, {0, 0, s}};
  }
  while (true) {
    double q[4], squared = 0;
    for (double& value : q) {
      value = 2 * uniform() - 1;
      squared += value * value;
    }
    if (squared > 1 || squared < 1e-4) continue;
    return normalised(Turn{q[0], {q[1], q[2], q[3]}});
  }
}

}  // namespace

void put_clumps(const std::vector<const Clump*>& clumps, const Grains& graded, const Grains& around, Uniform& uniform,
                Specimen& specimen) {
  specimen.grains = Grains{};
  for (std::size_t k = 0; k < clumps.size(); ++k)
    add_clump(specimen, *clumps[k], graded.radius[k], around.position[k],
              random_turn(dimension_of(specimen.shape), uniform), graded.material[k]);
}

namespace {

/// z of the body within `spread` degrees of the vertical, directions equally frequent, and turned about it by any
/// angle.
Turn bedded_turn(double spread, Uniform& uniform) {
  const auto half_angle = [](double degrees) { return direction_of(0.5 * degrees); };
  const double least = direction_of(spread)[0], cosine = least + (1 - least) * uniform();
  const double c = std::sqrt(0.5 * (1 + cosine)), s = std::sqrt(0.5 * (1 - cosine));
  const auto [towards_x, towards_y] = direction_of(180 * (2 * uniform() - 1));
  const auto [about_c, about_s] = half_angle(180 * (2 * uniform() - 1));
  return normalised(after(Turn{c, {s * towards_x, s * towards_y, 0}}, Turn{about_c, {0, 0, about_s}}));
}

}  // namespace

void put_solids(const Recipe& recipe, const Grains& graded, Uniform& uniform, Specimen& specimen) {
  std::vector<NumberCurve> curves;
  for (const auto& fraction : recipe.fractions) curves.push_back(number_curve(fraction.grading, 3));
  const auto numbers = numbers_of(recipe, curves);
  std::size_t g = 0;
  for (std::size_t f = 0; f < numbers.size(); ++f)
    for (std::size_t k = 0; k < numbers[f]; ++k, ++g) {
      const double spread = recipe.fractions[f].bedding_spread;
      const Turn turn = spread == 90 ? random_turn(3, uniform) : bedded_turn(spread, uniform);
      add_superellipsoid(specimen, superellipsoid_of(graded, g), graded.position[g],
                         normalised(after(inverse(turn_of(specimen.cell.rotation)), turn)), graded.material[g]);
    }
}

double solid_volume(const Recipe& recipe, const Grains& grains) {
  double volume = 0;
  for (const double radius : grains.radius) volume += grain_volume(recipe.shape, radius, recipe.thickness);
  return volume;
}

Cell cell_of(const Recipe& recipe, double volume) {
  const int d = dimension_of(recipe.shape);
  if (!recipe.oriented) return cubic_cell(d, volume, recipe.thickness);
  return d == 2 ? kraynik_reinelt_cell(volume, recipe.thickness) : cubic_field_cell(volume);
}

bool scatter(Shape shape, const Cell& cell, double size, Grains& grains, Uniform& uniform, const DrawWatch& watch) {
  const std::vector<double> reach = reach_of(shape, grains);
  const double largest = size * *std::max_element(reach.begin(), reach.end());
  if (shortest_vector(cell) < 2 * largest) return false;
  // Boxes of their own for each halving of the radius: in those of the largest grains, the smallest of a wide grading
  // would all lie together.
  const auto level_of = [&](double radius) { return std::size_t(std::max(0, std::ilogb(largest / radius))); };
  std::vector<std::size_t> of_level;
  for (const double each : reach) {
    const std::size_t level = level_of(size * each);
    if (of_level.size() <= level) of_level.resize(level + 1);
    ++of_level[level];
  }
  std::vector<Boxes> levels;
  for (std::size_t level = 0; level < of_level.size(); ++level)
    levels.emplace_back(cell, 2 * std::ldexp(largest, -int(level)), of_level[level]);
  std::vector<std::size_t> order(grains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return reach[a] > reach[b]; });
  std::size_t done = 0;
  for (const std::size_t g : order) {
    const double radius = size * reach[g];
    const std::size_t level = level_of(radius);
    if (done++ % 64 == 0) watch.at("scattering the grains", double(done) / double(order.size()));
    bool placed = false;
    for (int k = 0; k < most_tries && !placed; ++k) {
      Vector3 part = Vector3::Zero();
      for (int axis = 0; axis < cell.dimension; ++axis) part[axis] = uniform() - 0.5;
      Vector3 at = cell.lattice * part;
      wrap(cell, at);
      placed = std::all_of(levels.begin(), levels.begin() + std::ptrdiff_t(level) + 1,
                           [&](const Boxes& boxes) { return boxes.free(at, radius); });
      if (placed) {
        levels[level].add(at, radius);
        grains.position[g] = at;
      }
    }
    if (!placed) return false;
  }
  return true;
}

}  // namespace rvelab::pack
