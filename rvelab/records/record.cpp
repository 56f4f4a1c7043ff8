#include "rvelab/records/record.hpp"

namespace rvelab::records {

void measure_quantities(Record& record, const Rve& rve) {
  if (record.quantities == 0) return;
  const Network network = rve.network();
  Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
    if ((record.quantities & bit) != 0) record.*Quantity::member = Quantity::measure(rve, network);
  });
}

}  // namespace rvelab::records
