// rvelab critical: the critical-state line through the ends of several tests. Declared in command.hpp.
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/cli/columns.hpp"
#include "rvelab/cli/command.hpp"
#include "rvelab/cli/report.hpp"
#include "rvelab/ensemble/critical_state.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/records/quantities.hpp"

namespace rvelab::cli {
namespace {

using ensemble::CriticalLine;
using ensemble::CriticalState;
using ensemble::LineForm;

struct CriticalArguments {
  std::vector<std::string> files;
  std::optional<double> from;
  bool json = false;
};

CriticalState end_of(const std::string& file, const std::optional<double>& from) {
  const io::RecordedTest test = io::read_recorded_test(file);
  const auto stage = calibrate::last_stage(test.result);
  if (stage.empty()) throw InputError(file + ": holds no record; give tests to large strain");
  if ((stage.back().quantities & records::asked<records::VoidRatio>) == 0)
    throw InputError(file + ": its records have no void_ratio; run the test with it in [output] quantities");
  const double end = std::abs(stage.back().strain);
  if (from && *from > end)
    throw InputError("--from " + in_words(*from) + " is beyond the end of " + file + ", " + in_words(end) +
                     "; give a smaller strain, or a test that goes further");
  return ensemble::critical_state_of(stage, test.checkpoint.specimen.cell.dimension, from.value_or(0.6 * end));
}

void add_critical_line(Listing& listing, const std::string& name, const CriticalLine& line) {
  if (std::isnan(line.lambda)) {
    listing.add_or_why(name + "_lambda", line.lambda, "", "the tests are of one pressure");
    return;
  }
  listing.add(name + "_Gamma", line.Gamma);
  listing.add(name + "_lambda", line.lambda);
  listing.add(name + "_deviation", line.deviation);
}

void run_critical(const CriticalArguments& arguments) {
  std::vector<CriticalState> states;
  for (const std::string& file : arguments.files) states.push_back(end_of(file, arguments.from));
  const CriticalLine logarithmic = fitted_line(states, LineForm::logarithmic),
                     power = fitted_line(states, LineForm::power);
  Listing listing;
  Json rows = Json::array();
  std::vector<std::vector<std::string>> table{
      {"file", "p, Pa", "void ratio", "its change", "q/p", "start p, Pa", "start void ratio", "state parameter"}};
  for (std::size_t k = 0; k < states.size(); ++k) {
    const CriticalState& state = states[k];
    const CriticalLine& nearer = power.deviation < logarithmic.deviation ? power : logarithmic;
    rows.push_back({{"file", arguments.files[k]},
                    {"p_Pa", state.p},
                    {"void_ratio", state.void_ratio},
                    {"void_ratio_change", state.void_ratio_change},
                    {"q_over_p", state.stress_ratio},
                    {"start_p_Pa", state.start_p},
                    {"start_void_ratio", state.start_void_ratio},
                    {"state_parameter", state.start_void_ratio - nearer.void_ratio(state.start_p)}});
    const double parameter = rows.back()["state_parameter"].get<double>();
    table.push_back({arguments.files[k], in_digits(state.p, 4), in_digits(state.void_ratio, 4),
                     in_digits(state.void_ratio_change, 2), in_digits(state.stress_ratio, 3),
                     in_digits(state.start_p, 4), in_digits(state.start_void_ratio, 4), in_digits(parameter, 3)});
  }
  listing.add_to_json("states", std::move(rows));
  add_critical_line(listing, "logarithmic", logarithmic);
  add_critical_line(listing, "power", power);
  if (!std::isnan(power.lambda))
    listing.add("state_parameter_of", power.deviation < logarithmic.deviation ? "power" : "logarithmic");
  if (!arguments.json) std::cout << aligned(table) << "\n";
  listing.print(arguments.json);
}

}  // namespace

void add_critical(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("critical", "Fit the critical-state line to the ends of several tests");
  const auto arguments = std::make_shared<CriticalArguments>();
  command.add_option("files", arguments->files, "record files of tests to large strain, at two pressures or more")
      ->required();
  command.add_option("--from", arguments->from,
                     "driving strain from which records count; without: the last 40 % of each test");
  add_json(command, arguments->json);
  command.footer(
      "logarithmic: e_c = Gamma - lambda ln(p/1 kPa); power: e_c = Gamma - lambda (p/101.325 kPa)^0.7 (Li and Wang\n"
      "1998); deviation: root mean square of e minus e_c. state_parameter: void ratio at the start minus e_c there "
      "(Been\n"
      "and Jefferies 1985), by the line with the smaller deviation. void_ratio_change, from the first half of those\n"
      "records to the second, should be near zero.\n\n"
      "Example:\n  rvelab critical R_*.h5 --from 2");
  command.callback([arguments] { run_critical(*arguments); });
}

}  // namespace rvelab::cli
