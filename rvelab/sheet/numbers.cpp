#include "rvelab/sheet/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "rvelab/error.hpp"
#include "rvelab/sheet/element_tests.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {

const Number* number_in(const Sheet& sheet, std::string_view key) {
  const auto found = std::find_if(sheet.numbers.begin(), sheet.numbers.end(), [&](const Number& number) {
    return number.key == key && number.density_name.empty() && std::isnan(number.pressure);
  });
  return found == sheet.numbers.end() ? nullptr : &*found;
}

Sheet numbers_of(const std::vector<Test>& tests, const std::string& soil) {
  Sheet sheet;
  sheet.soil = soil;
  std::map<std::size_t, std::set<std::uint64_t>> densities;  // with their specimens
  for (const Test& test : tests) densities[test.density].insert(test.seed);
  const auto is_single = [](const auto& density) { return density.second.size() == 1; };
  if (!densities.empty() && std::all_of(densities.begin(), densities.end(), is_single))
    sheet.remarks.push_back(
        "There is one specimen of each density: standard errors and intervals are not known. Give two seeds or more.");
  if (densities.size() == 1)
    sheet.remarks.push_back("There is one density: how the numbers depend on the density is not known.");
  if (!tests.empty() && tests.front().dimension == 2)
    sheet.remarks.push_back(
        "The grains are discs: M of triaxial compression, F(e) of sands and parameters of continuum models, which are "
        "of "
        "space, are left out, and moduli are those of the plane.");
  add_strength(tests, sheet);
  add_footing(tests, sheet);
  add_stiffness(tests, sheet);
  add_small_strain(tests, sheet);
  add_critical_line(tests, sheet);
  add_cyclic_resistance(tests, sheet);
  add_grains(tests, sheet);
  add_curves(tests, sheet);
  return sheet;
}

std::map<std::string, double> numbers_by_key(const Sheet& sheet, const std::string& density_name) {
  std::map<std::string, double> found;
  std::map<std::string, std::pair<double, int>> sums;
  for (const Number& number : sheet.numbers) {
    if (!number.remark.empty()) continue;
    const bool of_all = number.density_name.empty() && std::isnan(number.pressure);
    if (of_all) found[number.key] = number.mean;
    if (of_all) continue;
    std::string key = number.key;
    if (!number.density_name.empty()) key += "." + number.density_name;
    if (!std::isnan(number.pressure)) key += "." + in_words(std::round(number.pressure / 10) / 100) + "kPa";
    found[key] = number.mean;
    if (!density_name.empty() && number.density_name != density_name) continue;
    sums[number.key].first += number.mean;
    ++sums[number.key].second;
  }
  for (const auto& [key, sum] : sums)
    if (!density_name.empty() || !found.contains(key)) found[key] = sum.first / sum.second;
  return found;
}

}  // namespace rvelab::sheet
