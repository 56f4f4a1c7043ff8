// The table of measured quantities: what is in it is measured, and kept, each by itself. (That the manual has each:
// tests/io.)
#include <cmath>
#include <string>

#include "rvelab/measure/measures.hpp"
#include "rvelab/records/record.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;
using namespace rvelab::records;

namespace {

/// Whether a value was measured: none of the reference specimen's is zero.
bool is_there(double value) { return value != 0; }
bool is_there(const Matrix3& value) { return !value.isZero(0); }

}  // namespace

TEST_CASE("a record measures each quantity by itself, by the function of its name") {
  const Rve rve(reference_specimen("dense_p20"));
  const Network network = rve.network();
  for (const QuantityRow& row : quantity_rows) {
    CAPTURE(row.text.name);
    records::Record record;
    record.quantities = row.bit;
    measure_quantities(record, rve);
    Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
      if (bit != row.bit) CHECK(!is_there(record.*Quantity::member));
    });
  }
  records::Record record;
  record.quantities = all_quantities;
  measure_quantities(record, rve);
  CHECK(record.void_ratio == void_ratio(network));
  CHECK(record.coordination_number == coordination_number(network));
  CHECK(record.fabric == fabric(network));
  CHECK(record.fabric_anisotropy == fabric_anisotropy(fabric(network), 2));
  CHECK(record.contact_stress == rve.contact_stress());
  CHECK(record.elastic_energy == elastic_energy(network));
  CHECK(is_there(record.mechanical_void_ratio));
  CHECK(is_there(record.branch_fabric));
  CHECK(!is_there(record.kinetic_energy));  // at rest
}

TEST_CASE("quantities of one relation have the same bits, measured together or each by itself") {
  const Rve rve(reference_specimen("dense_p20"));
  records::Record together;
  together.quantities = all_quantities;
  measure_quantities(together, rve);
  Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
    CAPTURE(Quantity::text.name);
    records::Record alone;
    alone.quantities = bit;
    measure_quantities(alone, rve);
    // NaN: of discs, and without the energy balance.
    if constexpr (std::is_same_v<ValueOf<Quantity>, double>)
      if (std::isnan(alone.*Quantity::member) && std::isnan(together.*Quantity::member)) return;
    if (std::string(Quantity::text.name) != "orientation_fabric")
      CHECK(alone.*Quantity::member == together.*Quantity::member);
  });
  const StressForceFabric relation = stress_force_fabric(rve.network());
  CHECK(together.a_c == relation.a_c);
  CHECK(together.a_n == relation.a_n);
  CHECK(together.a_t == relation.a_t);
  CHECK(together.a_l == relation.a_l);
  CHECK(together.a_lt == relation.a_lt);
  CHECK(together.stress_force_fabric == relation.predicted);
  CHECK(together.strong_deviator == force_networks(rve.network()).strong.deviator_share);
}

TEST_CASE("quantities keep the bits that journals of earlier versions name them by") {
  const char* const names[] = {"void_ratio",
                               "coordination_number",
                               "fabric_anisotropy",
                               "sliding_fraction",
                               "mechanical_void_ratio",
                               "mechanical_coordination_number",
                               "fabric",
                               "branch_fabric",
                               "contact_stress_Pa",
                               "reynolds_stress_Pa",
                               "elastic_energy_J",
                               "kinetic_energy_J",
                               "orientation_fabric"};
  REQUIRE(quantity_rows.size() >= std::size(names));
  for (std::size_t k = 0; k < std::size(names); ++k) {
    CHECK(quantity_rows[k].text.name == std::string(names[k]));
    CHECK(quantity_rows[k].bit == std::uint64_t{1} << k);
  }
  CHECK(usual_quantities == 15);
  CHECK(asked<KineticEnergy> == 2048);
}
