// Errors of the stresses as a table and in words. Declared in tables.hpp.
#include <algorithm>
#include <cmath>

#include "rvelab/report/tables.hpp"
#include "rvelab/report/words.hpp"

namespace rvelab::report {
namespace {

struct Estimates {
  std::size_t judged = 0;
  double sum = 0, largest = 0;
  const Test* test = nullptr;  ///< test with the largest error
  std::size_t record = 0;
  double mean() const { return sum / double(judged); }
};

void add(Estimates& found, const Test& test) {
  for (std::size_t k = 0; k < test.records().size(); ++k) {
    const double estimate = test.records()[k].error_estimate;
    if (!(estimate > 0)) continue;
    ++found.judged;
    found.sum += estimate;
    if (estimate > found.largest) found.largest = estimate, found.test = &test, found.record = k;
  }
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

std::string in_percent(double part) { return in_three_digits(100 * part) + " %"; }

}  // namespace

Table errors_of(const std::vector<Test>& tests) {
  Table rows{{"file", "records", "held stress missed", "no equilibrium", "largest error of the held stress",
              "unbalanced ratio, median", "error estimate over p: mean", "largest", "cell thin", "run time (s)",
              "grain-steps", "complete"}};
  double seconds = 0, steps = 0;
  std::size_t records = 0;
  for (const Test& test : tests) {
    long missed = 0, restless = 0, thin = 0;
    double held = 0;
    std::vector<double> unbalanced;
    for (const records::Record& record : test.records()) {
      missed += record.target_held ? 0 : 1;
      restless += record.quasi_static ? 0 : 1;
      thin += record.cell_thin ? 1 : 0;
      if (std::isfinite(record.held_error)) held = std::max(held, record.held_error);
      unbalanced.push_back(record.unbalanced_force_ratio);
    }
    Estimates estimates;
    add(estimates, test);
    const bool judged = estimates.judged > 0;
    rows.push_back({test.file, std::to_string(test.records().size()), std::to_string(missed), std::to_string(restless),
                    in_percent(held), in_three_digits(median(unbalanced)), judged ? in_percent(estimates.mean()) : "-",
                    judged ? in_percent(estimates.largest) : "-", std::to_string(thin),
                    in_three_digits(test.recorded.result.wall_seconds),
                    in_three_digits(double(test.recorded.result.grain_steps)), test.recorded.complete ? "yes" : "no"});
    seconds += test.recorded.result.wall_seconds, steps += double(test.recorded.result.grain_steps);
    records += test.records().size();
  }
  if (tests.size() > 1)
    rows.push_back({"all", std::to_string(records), "", "", "", "", "", "", "", in_three_digits(seconds),
                    in_three_digits(steps), ""});
  return rows;
}

std::string errors_in_words(const std::vector<Test>& tests) {
  Estimates all;
  for (const Test& test : tests) add(all, test);
  if (all.judged == 0)
    return "No record has an error estimate: loading at a rate is not judged, and a state without pressure has no "
           "scale.";
  const records::Record& worst = all.test->records()[all.record];
  std::string text = "Stresses may be off those of infinitely slow loading by " + in_percent(all.mean()) +
                     " of the mean stress p in the mean over the records, and by " + in_percent(all.largest) +
                     " at most (" + (tests.size() > 1 ? all.test->file + ", " : "") + "driving strain " +
                     in_percent(worst.strain) +
                     "). These are the estimates of the program, drawn as a band; some 19 of 20 errors are smaller.";
  const double p = mean_pressure(worst.stress, all.test->dimension),
               first = mean_pressure(all.test->records().front().stress, all.test->dimension);
  if (all.largest > 0.1 && p < 0.2 * first)
    text += " The largest is a share of a p that has fallen to " + in_percent(p / first) +
            " of its start: in pascals it is " + in_three_digits(all.largest * p / 1e3) + " kPa.";
  else if (all.largest > 0.1)
    text +=
        " Where it is above a tenth of p the specimen rearranges within one record; lower solver.relative_tolerance, "
        "or "
        "take the stress from a mean over records there.";
  return text;
}

}  // namespace rvelab::report
