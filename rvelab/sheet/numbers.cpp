#include "rvelab/sheet/numbers.hpp"

#include <cmath>
#include <map>

#include "rvelab/ensemble/measures.hpp"
#include "rvelab/ensemble/statistics.hpp"

namespace rvelab::sheet {

Sheet numbers_of(const std::vector<Test>& tests, const std::string& soil) {
  Sheet sheet;
  sheet.soil = soil;
  std::map<std::pair<std::size_t, double>, std::vector<const Test*>> groups;
  for (const Test& test : tests)
    if (test.purpose == Purpose::drained) groups[{test.density, test.pressure}].push_back(&test);
  for (const auto& [group, members] : groups) {
    Number number;
    number.key = "phi_peak_deg";
    number.label = "peak friction angle";
    number.unit = "degrees";
    number.density_name = members.front()->density_name;
    number.relative_density = members.front()->relative_density;
    number.pressure = group.second;
    std::vector<double> values;
    for (const Test* test : members) {
      values.push_back(
          calibrate::friction_angle_deg(ensemble::strength_of(test->protocol, test->result, test->dimension)));
      number.tests.push_back(test->name);
    }
    double sum = 0;
    for (const double value : values) sum += value;
    number.mean = sum / double(values.size());
    sheet.numbers.push_back(number);
  }
  return sheet;
}

}  // namespace rvelab::sheet
