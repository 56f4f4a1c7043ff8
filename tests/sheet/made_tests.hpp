// Tests of a sheet that follow known relations: made by formulas, with no grain.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/sheet/sheet.hpp"

namespace rvelab::test {

using sheet::Purpose;
using sheet::Test;

inline protocol::Protocol shipped(const std::string& name, const std::vector<std::string>& settings = {}) {
  return protocol::read_protocol(RVELAB_SOURCE_DIR "/protocols/" + name + ".toml", settings);
}

/// State of a compression: q, eps_v, e over the axial strain.
struct Point {
  double q = 0, eps_v = 0, void_ratio = 0, lateral = 0;
};
using Path = std::function<Point(double)>;

/// Axial strain along z, compression positive; stresses tension positive, as records have them.
inline records::Record compression_record(int stage, double strain, const Point& point) {
  records::Record record;
  record.stage = stage;
  record.strain = strain;
  const double side = std::sqrt((1 - point.eps_v) / (1 - strain));
  record.deformation_gradient = Eigen::Vector3d(side, side, 1 - strain).asDiagonal();
  record.stress = Eigen::Vector3d(-point.lateral, -point.lateral, -point.lateral - point.q).asDiagonal();
  record.void_ratio = point.void_ratio;
  return record;
}

struct Place {
  const char* density_name;
  std::size_t density;
  double relative_density;
  std::uint64_t seed;
  double pressure;
};

inline Test made_test(Purpose purpose, const Place& place, const std::string& protocol,
                      const std::vector<std::string>& settings = {}) {
  Test test;
  test.purpose = purpose;
  test.density = place.density;
  test.density_name = place.density_name;
  test.relative_density = place.relative_density;
  test.seed = place.seed;
  test.pressure = place.pressure;
  test.protocol = shipped(protocol, settings);
  test.result.axis = "z";
  test.result.pressure = place.pressure;
  test.name = protocol + "_" + place.density_name + "_" + in_words(place.pressure / 1000) + "kPa_s" +
              std::to_string(place.seed);
  for (const protocol::Stage& stage : test.protocol.stages) test.result.stages.push_back(stage.name);
  return test;
}

/// Compression in the second stage to `end` with a record every 0.0005.
inline Test compression(Purpose purpose, const Place& place, const Path& path, double end = 0.2) {
  Test test = made_test(purpose, place, purpose == Purpose::drained ? "triaxial" : "triaxial_undrained");
  for (int k = 0; k <= int(std::lround(end / 5e-4)); ++k)
    test.result.records.push_back(compression_record(1, 5e-4 * k, path(5e-4 * k)));
  test.void_ratio = test.result.records.front().void_ratio;
  return test;
}

/// sigma_1 - sigma_3 at which a friction angle is mobilised.
inline double deviator_at(double angle_deg, double lateral) {
  const double sine = std::sin(angle_deg * std::numbers::pi / 180);
  return 2 * lateral * sine / (1 - sine);
}

/// Degrees; of the line e = e_G - lambda (p/p_a)^0.7.
inline constexpr double critical = 31, e_G = 0.934, lambda = 0.019;
inline double line(double p) { return e_G - lambda * std::pow(p / 101325, 0.7); }

/// Drained tests of a sand with Bolton's relation (A, Q, R = 1), which end on the critical state line.
inline std::vector<Test> bolton_tests(double A, double Q, int seeds, double scatter = 0) {
  std::vector<Test> tests;
  const double relative[] = {0.3, 0.6, 0.9};
  const char* const names[] = {"loose", "medium", "dense"};
  for (std::size_t density = 0; density < 3; ++density)
    for (const double p : {50e3, 100e3, 200e3})
      for (int seed = 1; seed <= seeds; ++seed) {
        const double D = relative[density], own_Q = Q + scatter * (seed - 0.5 * (seeds + 1));
        double peak = critical;
        for (int round = 0; round < 60; ++round)
          peak = critical + A * (D * (own_Q - std::log((p + deviator_at(peak, p) / 3) / 1000)) - 1);
        const double largest = deviator_at(peak, p), last = deviator_at(critical, p);
        const double end = line(p + last / 3), start = end - 0.05 - 0.2 * D;
        tests.push_back(
            compression(Purpose::drained, {names[density], density, D, std::uint64_t(seed), p}, [=](double strain) {
              // Up to the peak at 4 %, down to the critical state at 10 %.
              const double q = strain < 0.04 ? largest * std::sin(strain / 0.04 * std::numbers::pi / 2)
                                             : largest + (last - largest) * std::min(1.0, (strain - 0.04) / 0.06);
              const double e = start + (end - start) * std::min(1.0, strain / 0.1);
              return Point{q, -(e - start) / (1 + start), e, p};
            }));
      }
  return tests;
}

}  // namespace rvelab::test
