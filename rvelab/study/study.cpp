#include "rvelab/study/study.hpp"

#include <sstream>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::study {
namespace {

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
  return all.empty() ? "none" : all;
}

/// What two studies are compared by, by its name.
using Rows = std::vector<std::pair<std::string, std::string>>;

Rows rows_of(const Study& study) {
  Rows rows{{"made_with", study.made_with},
            {"specimens", joined(study.digests.empty() ? study.specimens : study.digests)},
            {"settings", joined(study.settings)},
            {"reference", joined(study.reference)},
            {"repeats", std::to_string(study.repeats)},
            {"increments", std::to_string(study.increments)},
            {"relax_unbalanced", in_words(study.relaxation.unbalanced)},
            {"relax_max_steps", std::to_string(study.relaxation.max_steps)}};
  std::vector<std::string> grid;
  for (const Variation& one : study.grid) grid.push_back(one.key + " = " + joined(one.values));
  rows.emplace_back("vary", joined(grid));
  return rows;
}

/// Steps of a physical loading are compared over the same time only.
void expect_same_loading(const protocol::Protocol& point, const protocol::Protocol& reference,
                         const std::string& name) {
  const protocol::LoadingSettings &a = point.loading, &b = reference.loading;
  if (a.physical == b.physical && a.rate == b.rate && a.inertial_number == b.inertial_number) return;
  throw InputError(name +
                   ": the loading ([loading] mode, rate_1_s, inertial_number) is not that of the reference, and "
                   "increments are compared at one rate; allowed: the same loading; give it to --reference too, or "
                   "--increments 0 for whole paths alone");
}

/// Opens the specimens as the point asks for.
void expect_opens(const protocol::Protocol& protocol, const std::vector<Specimen>& specimens, const std::string& name) {
  for (const Specimen& specimen : specimens) {
    try {
      const Rve opened(protocol::with_overrides(protocol, specimen));
    } catch (const InputError& error) {
      throw InputError(name + ": " + error.what());
    }
  }
}

}  // namespace

std::string difference(const Study& there, const Study& here) {
  if (there.protocol_text != here.protocol_text) return "another protocol there";
  const Rows first = rows_of(there), second = rows_of(here);
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k].second != second[k].second) {
      return first[k].first + " = " + first[k].second + " there and " + second[k].second + " here";
    }
  }
  return "";
}

Prepared prepared(const Study& study, const std::string& path, std::vector<Specimen> specimens) {
  if (study.reference.empty()) {
    throw InputError(path +
                     ": no reference is given; allowed: settings that resolve the test best, by which the others are "
                     "judged; write for example --reference solver.fixed_substeps=4000");
  }
  if (study.repeats == 0 && study.increments == 0) {
    throw InputError(path + ": repeat = 0 and increments = 0 leave nothing to run; allowed: one of them at least 1");
  }
  Prepared all;
  all.specimens = std::move(specimens);
  all.reference = protocol_with(study.protocol_text, path, study.settings, study.reference, "--reference");
  expect_opens(all.reference, all.specimens, "reference " + name_of(study.reference));
  const std::size_t points = points_in(study.grid);
  for (std::size_t point = 0; point < points; ++point) {
    const auto assignments = assignments_at(study.grid, point);
    all.points.push_back(protocol_with(study.protocol_text, path, study.settings, assignments, "--vary"));
    if (study.increments > 0) expect_same_loading(all.points.back(), all.reference, name_of(assignments));
    expect_opens(all.points.back(), all.specimens, name_of(assignments));
  }
  return all;
}

}  // namespace rvelab::study
