// The critical-state line and the states that it goes through.
#include "rvelab/ensemble/critical_state.hpp"

#include <cmath>

#include "rvelab/ensemble/statistics.hpp"
#include "tests/catch.hpp"
#include "tests/ensemble/made_records.hpp"

using namespace rvelab;
using namespace rvelab::ensemble;
using namespace rvelab::test;

TEST_CASE("a critical state is the mean over the end of a test, with its start and how steady it is") {
  std::vector<records::Record> records;
  for (int k = 0; k <= 100; ++k) {
    records.push_back(shear_record(0.05 * k, k < 20 ? 0 : 3e4 + 1e3 * (k % 2)));
    records.back().void_ratio = 0.2 + 0.0001 * k;
  }
  const CriticalState state = critical_state_of(records, 2, 2.0);
  CHECK(state.p == Approx(1e5));
  CHECK(state.stress_ratio == Approx(0.305).epsilon(0.01));
  CHECK(state.void_ratio == Approx(0.207));
  CHECK(state.void_ratio_change == Approx(0.003).epsilon(0.03));
  CHECK(state.start_void_ratio == 0.2);
  CHECK(std::isnan(critical_state_of(records, 2, 6.0).p));
  for (records::Record& record : records) record.quantities = 0;  // no void ratio was recorded
  CHECK(std::isnan(critical_state_of(records, 2, 2.0).void_ratio));
}

TEST_CASE("states on a critical-state line give the line back, in either form") {
  for (const LineForm form : {LineForm::logarithmic, LineForm::power}) {
    const CriticalLine line{form, 0.93, form == LineForm::power ? 0.019 : 0.03, 0};
    std::vector<CriticalState> states;
    for (const double p : {2e4, 1e5, 3e5, 1e6}) states.push_back({p, line.void_ratio(p), 0.5, p, 0.7, 0});
    states.push_back({ensemble::nan, 0.9, 0, 0, 0, 0});  // of a test that did not reach it
    const CriticalLine found = fitted_line(states, form);
    CHECK(found.Gamma == Approx(0.93).epsilon(1e-12));
    CHECK(found.lambda == Approx(line.lambda).epsilon(1e-12));
    CHECK(found.deviation < 1e-14);
    CHECK(fitted_line(states, form == LineForm::power ? LineForm::logarithmic : LineForm::power).deviation > 1e-4);
  }
  // e_c = Gamma at p = 1 kPa (ln) and, less lambda, at one atmosphere (power).
  CHECK(CriticalLine{LineForm::logarithmic, 0.9, 0.03, 0}.void_ratio(1e3) == Approx(0.9));
  CHECK(CriticalLine{LineForm::power, 0.9, 0.03, 0}.void_ratio(101325) == Approx(0.87));
}

TEST_CASE("one pressure makes no line") {
  const std::vector<CriticalState> same{{1e5, 0.6, 0.5, 1e5, 0.7, 0}, {1e5, 0.61, 0.5, 1e5, 0.7, 0}};
  CHECK(std::isnan(fitted_line(same, LineForm::logarithmic).lambda));
  CHECK(std::isnan(fitted_line({}, LineForm::power).Gamma));
}
