#include "tools/mpm/bodies/terrain.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/mpm/keys/included.hpp"

namespace mpm {
namespace {

/// Four heights along one axis, the first of them number `first`, with their weights and two derivatives of these.
struct Convolution {
  int first;
  double weight[4], slope[4], bend[4];
};

Convolution convolution(double position, int count) {
  const int cell = std::clamp(int(std::floor(std::clamp(position, -1.0, double(count)))), 0, count - 2);
  const double t = position - cell;
  if (t < 0 || t > 1) return {cell - 1, {0, 1 - t, t, 0}, {0, -1, 1, 0}, {}};
  const double t2 = t * t, t3 = t2 * t;
  Convolution c{cell - 1,
                {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1, -1.5 * t3 + 2 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2},
                {-1.5 * t2 + 2 * t - 0.5, 4.5 * t2 - 5 * t, -4.5 * t2 + 4 * t + 0.5, 1.5 * t2 - t},
                {-3 * t + 2, 9 * t - 5, -9 * t + 4, 3 * t - 1}};
  // Beyond an edge the line through the last two goes on.
  const auto fold = [](double* w, int gone, int next, int after) {
    w[next] += 2 * w[gone];
    w[after] -= w[gone];
    w[gone] = 0;
  };
  for (double* w : {c.weight, c.slope, c.bend}) {
    if (cell == 0) fold(w, 0, 1, 2);
    if (cell == count - 2) fold(w, 3, 2, 1);
  }
  return c;
}

/// Of a row of `count` heights: adds the value and two derivatives along it, times the spacing.
void convolve(const Convolution& along, const double* heights, int count, double (&sums)[3]) {
  for (int i = 0; i < 4; ++i) {
    const int k = std::clamp(along.first + i, 0, count - 1);  // beyond an edge the weights are 0
    sums[0] += along.weight[i] * heights[k];
    sums[1] += along.slope[i] * heights[k];
    sums[2] += along.bend[i] * heights[k];
  }
}

}  // namespace

template <int D>
Terrain<D> Terrain<D>::read(Keys& keys) {
  Terrain terrain;
  terrain.spacing = keys.positive("spacing_m");
  const auto along = keys.row_length("heights_m");
  if (keys.has("heights_m") && along == 0)
    keys.wrong("heights_m", "must be rows of heights along x, in the plane one: heights_m = [[0.5, 0.3, 0.2]]");
  const auto rows = keys.rows("heights_m", along);
  keys.known("file_csv");
  terrain.count[0] = int(along);
  if constexpr (D == 3) terrain.count[1] = int(rows.size());
  for (const auto& row : rows) terrain.heights.insert(terrain.heights.end(), row.begin(), row.end());
  if (D == 2 && rows.size() > 1)
    keys.wrong("heights_m", "(or file_csv) has one row in the plane: the heights along x, on one line");
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
  long points = 1;
  for (int i = 0; i < up; ++i) {
    points *= parts * (count[i] - 1) + 1;
    extent = std::max(extent, spacing * (count[i] - 1));
  }
  for (long k = 0; k < points; ++k) {
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
    keys.wrong("heights_m", "has a slope of " + in_words(std::atan(steepest) * 180 / std::numbers::pi) +
                                " degrees; allowed: 80; smooth the heights, or put a [[body]] box or half_space there");
  }
  cosine = 1 / std::hypot(1, 1.1 * steepest);
  far = std::max(4 * spacing, 0.05 * extent);
}

template <int D>
double Terrain<D>::height(const Vec<D>& r, Vec<D>& slope, Mat<D>* curvature) const {
  slope.setZero();
  if (curvature != nullptr) curvature->setZero();
  const auto along = convolution(r[0] / spacing, count[0]);
  const double per_m = 1 / spacing;
  if constexpr (D == 2) {
    double sums[3] = {};
    convolve(along, heights.data(), count[0], sums);
    slope[0] = sums[1] * per_m;
    if (curvature != nullptr) (*curvature)(0, 0) = sums[2] * per_m * per_m;
    return sums[0];
  } else {
    const auto across = convolution(r[1] / spacing, count[1]);
    double sum = 0, mixed = 0, bend[2] = {};
    for (int j = 0; j < 4; ++j) {
      double sums[3] = {};
      convolve(along, heights.data() + long(std::clamp(across.first + j, 0, count[1] - 1)) * count[0], count[0], sums);
      sum += across.weight[j] * sums[0];
      slope[0] += across.weight[j] * sums[1] * per_m;
      slope[1] += across.slope[j] * sums[0] * per_m;
      bend[0] += across.weight[j] * sums[2];
      bend[1] += across.bend[j] * sums[0];
      mixed += across.slope[j] * sums[1];
    }
    if (curvature != nullptr) {
      (*curvature)(0, 0) = bend[0] * per_m * per_m;
      (*curvature)(1, 1) = bend[1] * per_m * per_m;
      (*curvature)(0, 1) = (*curvature)(1, 0) = mixed * per_m * per_m;
    }
    return sum;
  }
}

template <int D>
double Terrain<D>::distance(const Vec<D>& r, Vec<D>& outward, const Vec<D>& unit) const {
  return distance_within(std::min(far, 16 * unit.maxCoeff()), r, outward);
}

template <int D>
double Terrain<D>::distance_within(double reach, const Vec<D>& r, Vec<D>& outward) const {
  Vec<D> foot = r, slope;
  Mat<D> curvature;
  foot[up] = height(r, slope, &curvature);
  const double above = r[up] - foot[up];
  if (above * cosine > reach) {
    outward = Vec<D>::Unit(up);
    return above * cosine;
  }
  // Newton on half the squared distance over the horizontal place of the foot; without the curvature where that bends
  // more than the distance allows, or a step leads away.
  for (int round = 0; round < 50; ++round) {
    Vec<D> pull = r - foot;
    const double vertical = pull[up];
    pull[up] = 0;
    pull += vertical * slope;
    if (pull.norm() < 1e-12 * spacing) break;
    const Vec<D> flat = pull - slope * (slope.dot(pull) / (1 + slope.squaredNorm()));
    const Mat<D> stiff = Mat<D>::Identity() + slope * slope.transpose() - vertical * curvature;
    const Eigen::LLT<Mat<D>> factor(stiff);
    Vec<D> next, there, step = factor.info() == Eigen::Success ? Vec<D>(factor.solve(pull)) : flat;
    Mat<D> bend;
    bool nearer = false;
    for (int half = 0; half < 8 && !nearer; ++half) {
      next = foot + step;
      next[up] = height(next, there, &bend);
      nearer = (r - next).squaredNorm() < (r - foot).squaredNorm();
      step = half == 0 ? flat : Vec<D>(0.5 * step);
    }
    if (!nearer) break;
    foot = next;
    slope = there;
    curvature = bend;
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
