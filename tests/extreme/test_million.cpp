// A million spheres, once: memory, and time that grows as their number does.
#include <sys/resource.h>

#include <Eigen/QR>
#include <cmath>
#include <ctime>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Processor time without that of the kernel, which hands out pages: of small cells they are in use already.
double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

/// Opens a crystal, applies one increment, compares; returns processor time, s.
double seconds_for(int n) {
  Specimen s = cubic_crystal(n);
  s.solver.fixed_substeps = 5;
  const double start = user_seconds();
  Rve rve(s);
  CHECK(largest(rve.stress() - cubic_crystal_stress(Vector3::Zero())) <= 1e-9 * largest(rve.stress()));
  const Vector3 strain(1e-4, 0, -1e-3);
  const Response response = rve.apply(strain.asDiagonal(), 0);
  const double seconds = user_seconds() - start;
  CHECK(response.report.substeps == 5);
  CHECK(largest(response.stress - cubic_crystal_stress(strain)) <= 1e-9 * largest(response.stress));
  CHECK(rve.size() == std::size_t(n) * n * n);
  CHECK(response.report.unbalanced_ratio < 1e-9);
  return seconds;
}

/// The exponent b of time = a number^b, by least squares in the logarithms.
double exponent(const std::vector<double>& number, const std::vector<double>& seconds) {
  Eigen::MatrixXd of(number.size(), 2);
  Eigen::VectorXd logarithm(number.size());
  for (std::size_t k = 0; k < number.size(); ++k) {
    of.row(Eigen::Index(k)) << 1, std::log(number[k]);
    logarithm[Eigen::Index(k)] = std::log(seconds[k]);
  }
  return of.colPivHouseholderQr().solve(logarithm)[1];
}

}  // namespace

TEST_CASE("A million spheres open and deform in memory and time proportional to their number", "[extreme][slow]") {
  std::vector<double> number, seconds;
  std::ostringstream table;
  for (const int n : {63, 80, 100}) {  // all beyond the caches
    number.push_back(std::pow(n, 3));
    seconds.push_back(seconds_for(n));
    table << number.back() << ": " << 1e6 * seconds.back() / number.back() << "; ";
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double gibibytes = double(usage.ru_maxrss) / (1024.0 * 1024.0), power = exponent(number, seconds);
  WARN("us per grain at a number of spheres: " << table.str() << "time ~ number^" << power << "; peak memory "
                                               << gibibytes << " GiB");
  CHECK(gibibytes < 8);
  // A search of all pairs has an exponent of 2, one over a grid of a fixed number of boxes of 1.5 and more. N log N
  // gives 1.07 here.
  CHECK(power > 0.8);
  CHECK(power < 1.25);
}
