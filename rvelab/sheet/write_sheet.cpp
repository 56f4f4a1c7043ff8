#include "rvelab/sheet/write_sheet.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "rvelab/io/publish.hpp"

namespace rvelab::sheet {

void write_sheet(const Sheet& sheet, const std::vector<models::Fit>&, const std::string& folder) {
  nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
  std::string csv = "key,density,pressure_Pa,mean\n";
  for (const Number& number : sheet.numbers) {
    numbers.push_back({{"key", number.key},
                       {"density", number.density_name},
                       {"pressure_Pa", number.pressure},
                       {"mean", number.mean},
                       {"tests", number.tests}});
    csv +=
        number.key + "," + number.density_name + "," + io::exact(number.pressure) + "," + io::exact(number.mean) + "\n";
  }
  const nlohmann::ordered_json all{{"soil", sheet.soil}, {"numbers", numbers}, {"remarks", sheet.remarks}};
  const std::filesystem::path place = folder;
  io::publish_text((place / "summary.json").string(), all.dump(2) + "\n");
  io::publish_text((place / "summary.csv").string(), csv);
}

}  // namespace rvelab::sheet
