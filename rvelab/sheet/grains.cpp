// What no laboratory can give: contacts and fabric at the start, at the peak and at the end of drained tests.
//
//   coordination number 2 N_c/N, anisotropy of the contact normals, share of contacts on the Coulomb cone
//   (rvelab/records/quantities.hpp)
// The peak is the record with the largest sigma_1 - sigma_3.
#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

constexpr const char* grains_group = "Grains";
constexpr const char* packing = "Oda and Iwashita 1999";

struct Quantity {
  double (*of)(const records::Record&);
  std::uint64_t asked;
  About about[3];  ///< at the start, the peak, the end
  const char* axis;
};

const std::vector<Quantity>& grain_quantities() {
  static const std::vector<Quantity> all{
      {[](const records::Record& record) { return record.coordination_number; },
       records::asked<records::CoordinationNumber>,
       {{grains_group, "coordination_number_start", "coordination number, start", "", "2 N_c/N, all grains", packing},
        {grains_group, "coordination_number_peak", "coordination number, peak", "", "at the largest deviator", packing},
        {grains_group, "coordination_number_end", "coordination number, end", "", "at the last record", packing}},
       "coordination number"},
      {[](const records::Record& record) { return record.fabric_anisotropy; },
       records::asked<records::FabricAnisotropy>,
       {{grains_group, "fabric_anisotropy_start", "fabric anisotropy, start", "", "of the contact normals", packing},
        {grains_group, "fabric_anisotropy_peak", "fabric anisotropy, peak", "", "at the largest deviator", packing},
        {grains_group, "fabric_anisotropy_end", "fabric anisotropy, end", "", "at the last record", packing}},
       "fabric anisotropy"},
      {[](const records::Record& record) { return record.sliding_fraction; },
       records::asked<records::SlidingFraction>,
       {{grains_group, "sliding_share_start", "share of contacts that slide, start", "", "on the Coulomb cone",
         packing},
        {grains_group, "sliding_share_peak", "share of contacts that slide, peak", "", "at the largest deviator",
         packing},
        {grains_group, "sliding_share_end", "share of contacts that slide, end", "", "at the last record", packing}},
       "share of contacts that slide"}};
  return all;
}

}  // namespace

void add_grains(const std::vector<Test>& tests, Sheet& sheet) {
  const std::vector<TestGroup> groups = groups_of(tests, Purpose::drained);
  for (const Quantity& quantity : grain_quantities()) {
    Readings found[3];
    for (const TestGroup& own : groups) {
      for (const Test* test : own.tests) {
        const auto records = last_records(*test);
        if ((records.front().quantities & quantity.asked) == 0) continue;
        const records::Record* const at[] = {
            &records.front(), &records[calibrate::peak(records, test->dimension).record], &records.back()};
        for (int k = 0; k < 3; ++k) found[k].push_back({test, quantity.of(*at[k])});
      }
    }
    if (found[0].empty() && !groups.empty())
      sheet.remarks.push_back(std::string("The ") + quantity.axis + " is left out: no test recorded it.");
    for (int k = 0; k < 3; ++k) add_by_pressure(sheet, quantity.about[k], found[k]);
  }
}

}  // namespace rvelab::sheet
