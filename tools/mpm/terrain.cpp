#include "tools/mpm/terrain.hpp"

#include <algorithm>
#include <cmath>

#include "tools/mpm/included.hpp"

namespace mpm {
namespace {

/// Four heights along one axis, the first of them number `first`, with their weights and the derivatives of these.
struct Convolution {
  int first;
  double weight[4], slope[4];
};

Convolution convolution(double place, int count) {
  const int cell = std::clamp(int(std::floor(std::clamp(place, -1.0, double(count)))), 0, count - 2);
  const double t = place - cell;
  if (t < 0 || t > 1) return {cell - 1, {0, 1 - t, t, 0}, {0, -1, 1, 0}};
  const double t2 = t * t, t3 = t2 * t;
  Convolution c{cell - 1,
                {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2},
                {-1.5 * t2 + 2 * t - 0.5, 4.5 * t2 - 5 * t, -4.5 * t2 + 4 * t + 0.5, 1.5 * t2 - t}};
  // Beyond an edge the line through the last two goes on.
  const auto fold = [](double* w, int gone, int next, int after) {
    w[next] += 2 * w[gone];
    w[after] -= w[gone];
    w[gone] = 0;
  };
  for (double* w : {c.weight, c.slope}) {
    if (cell == 0) fold(w, 0, 1, 2);
    if (cell == count - 2) fold(w, 3, 2, 1);
  }
  return c;
}

}  // namespace

template <int D>
Terrain<D> Terrain<D>::read(Keys& keys) {
  Terrain terrain;
  terrain.spacing = keys.positive("spacing_m");
  const auto along = keys.row_length("heights_m");
  const auto rows = keys.rows("heights_m", along);
  keys.known("file_csv");
  terrain.count[0] = int(along);
  if constexpr (D == 3) terrain.count[1] = int(rows.size());
  for (const auto& row : rows) terrain.heights.insert(terrain.heights.end(), row.begin(), row.end());
  if (D == 2 && rows.size() > 1) keys.wrong("heights_m", "has one row in the plane: the heights along x");
  return terrain;
}

template <int D>
void Terrain<D>::settle(const Keys& keys) {
  if (heights.empty())
    keys.wrong("kind", "is terrain, which needs heights_m (rows along x) or file_csv with such rows");
  if (*std::min_element(count.begin(), count.end()) < 2)
    keys.wrong("heights_m", "needs two heights or more along each horizontal axis");
  double steepest = 0, extent = 0;
  constexpr int parts = 4;  // of a cell of the map
  long places = 1;
  for (int i = 0; i < up; ++i) {
    places *= parts * (count[i] - 1) + 1;
    extent = std::max(extent, spacing * (count[i] - 1));
  }
  for (long k = 0; k < places; ++k) {
    Vec<D> r = Vec<D>::Zero(), slope;
    long rest = k;
    for (int i = 0; i < up; ++i) {
      r[i] = spacing / parts * double(rest % (parts * (count[i] - 1) + 1));
      rest /= parts * (count[i] - 1) + 1;
    }
    height(r, slope);
    steepest = std::max(steepest, slope.norm());
  }
  constexpr double most = 5.7;  // 80 degrees
  if (!(steepest < most)) {
    keys.wrong("heights_m", "has a slope of " + text_of(std::atan(steepest) * 180 / 3.14159265358979323846) +
                                " degrees; allowed: 80; smooth the heights, or put a [[body]] box or half_space there");
  }
  cosine = 1 / std::hypot(1, 1.1 * steepest);
  far = std::max(4 * spacing, 0.05 * extent);
}

template <int D>
double Terrain<D>::height(const Vec<D>& r, Vec<D>& slope) const {
  slope.setZero();
  const auto along = convolution(r[0] / spacing, count[0]);
  const auto row = [&](const double* first, double& steep) {
    double sum = 0;
    steep = 0;
    for (int i = 0; i < 4; ++i) {
      if (along.weight[i] == 0 && along.slope[i] == 0) continue;
      sum += along.weight[i] * first[along.first + i];
      steep += along.slope[i] * first[along.first + i];
    }
    return sum;
  };
  double steep = 0;
  if constexpr (D == 2) {
    const double sum = row(heights.data(), steep);
    slope[0] = steep / spacing;
    return sum;
  } else {
    const auto across = convolution(r[1] / spacing, count[1]);
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
      if (across.weight[j] == 0 && across.slope[j] == 0) continue;
      const double here = row(heights.data() + long(across.first + j) * count[0], steep);
      sum += across.weight[j] * here;
      slope[0] += across.weight[j] * steep / spacing;
      slope[1] += across.slope[j] * here / spacing;
    }
    return sum;
  }
}

template <int D>
double Terrain<D>::distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>&) const {
  Vec<D> foot = r, slope;
  foot[up] = height(r, slope);
  const double above = r[up] - foot[up];
  if (above * cosine > far) {
    outward = Vec<D>::Unit(up);
    return above * cosine;
  }
  // Gauss and Newton on half the squared distance over the horizontal place of the foot.
  for (int round = 0; round < 50; ++round) {
    Vec<D> step = r - foot;
    const double vertical = step[up];
    step[up] = 0;
    step += vertical * slope;
    step -= slope * (slope.dot(step) / (1 + slope.squaredNorm()));
    if (step.norm() < 1e-11 * spacing) break;
    Vec<D> next, there;
    bool nearer = false;
    for (int half = 0; half < 8 && !nearer; ++half, step *= 0.5) {
      next = foot + step;
      next[up] = height(next, there);
      nearer = (r - next).squaredNorm() < (r - foot).squaredNorm();
    }
    if (!nearer) break;
    foot = next;
    slope = there;
  }
  outward = upward(slope);
  return outward.dot(r - foot);
}

void include_terrain(toml::table& file, const std::string& scene_path) {
  const auto* bodies = file["body"].as_array();
  for (std::size_t k = 0; bodies != nullptr && k < bodies->size(); ++k) {
    const auto* body = bodies->get(k)->as_table();
    if (body == nullptr || !body->contains("file_csv")) continue;
    const bool terrain = (*body)["kind"].value_or(std::string()) == Terrain<3>::kind;
    if (terrain && !body->contains("heights_m")) continue;
    throw InputError(scene_path + ": body." + (*body)["name"].value_or(std::to_string(k)) + ".file_csv: " +
                     (terrain ? "and heights_m are both given; remove one of them"
                              : "is of kind = \"terrain\"; remove it, or set that kind"));
  }
  include_rows(file, "body", "file_csv", "heights_m", scene_path);
}

template struct Terrain<2>;
template struct Terrain<3>;

}  // namespace mpm
