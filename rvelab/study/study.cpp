#include "rvelab/study/study.hpp"

#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/keys/shortened.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/records/quantities.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::study {

namespace {

std::string joined(const std::vector<std::string>& texts) { return texts.empty() ? "none" : keys::listed(texts); }

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

/// Steps of loading at a rate are compared over the same time only.
void expect_same_loading(const protocol::Protocol& point, const protocol::Protocol& reference,
                         const std::string& name) {
  const protocol::LoadingSettings &a = point.loading, &b = reference.loading;
  if (a.at_rate == b.at_rate && a.rate == b.rate && a.inertial_number == b.inertial_number) return;
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

namespace {

/// The parts between the commas that stand in no bracket and no quotation mark.
std::vector<std::string> items_of(const std::string& list) {
  std::vector<std::string> items{""};
  int depth = 0;
  char quotation = 0;
  for (const char letter : list) {
    if (quotation != 0) {
      if (letter == quotation) quotation = 0;
    } else if (letter == '"' || letter == '\'') {
      quotation = letter;
    } else if (letter == '[' || letter == '{') {
      ++depth;
    } else if (letter == ']' || letter == '}') {
      --depth;
    }
    if (letter == ',' && depth == 0 && quotation == 0) {
      items.emplace_back();
    } else {
      items.back() += letter;
    }
  }
  for (std::string& item : items) item = keys::trimmed(item);
  return items;
}

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw InputError("--vary " + text + " " + what +
                   "; allowed: KEY=v1,v2,... with each value once; write for example --vary solver.skin=0.1,0.2");
}

}  // namespace

Variation parsed_variation(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos) refuse(text, "has no values");
  Variation found{keys::trimmed(text.substr(0, equals)), items_of(text.substr(equals + 1))};
  if (found.key.empty()) refuse(text, "names no key");
  for (std::size_t k = 0; k < found.values.size(); ++k) {
    const auto before = found.values.begin() + std::ptrdiff_t(k);
    if (found.values[k].empty()) refuse(text, found.values.size() == 1 ? "has no values" : "has an empty value");
    if (std::find(found.values.begin(), before, found.values[k]) != before) {
      refuse(text, "has the value " + found.values[k] + " twice");
    }
  }
  return found;
}

std::size_t points_in(const std::vector<Variation>& grid) {
  std::size_t points = 1;
  for (const Variation& one : grid) {
    points *= one.values.size();
    if (points > most_points) {
      throw InputError("--vary " + one.key + " makes more than " + std::to_string(most_points) +
                       " grid points; allowed: at most so many; give fewer values");
    }
  }
  return points;
}

std::vector<std::string> values_at(const std::vector<Variation>& grid, std::size_t point) {
  std::vector<std::string> values(grid.size());
  for (std::size_t k = grid.size(); k-- > 0;) {
    values[k] = grid[k].values[point % grid[k].values.size()];
    point /= grid[k].values.size();
  }
  return values;
}

std::vector<std::string> assignments_at(const std::vector<Variation>& grid, std::size_t point) {
  std::vector<std::string> assignments = values_at(grid, point);
  for (std::size_t k = 0; k < grid.size(); ++k) assignments[k] = grid[k].key + "=" + assignments[k];
  return assignments;
}

std::string name_of(const std::vector<std::string>& assignments) {
  return assignments.empty() ? "the protocol as it is" : keys::listed(assignments);
}

protocol::Protocol protocol_with(const std::string& text, const std::string& path,
                                 const std::vector<std::string>& settings, const std::vector<std::string>& assignments,
                                 const std::string& flag) {
  std::vector<std::string> all = settings;
  all.insert(all.end(), assignments.begin(), assignments.end());
  try {
    protocol::Protocol protocol = protocol::parse_protocol(text, path, all);
    protocol.quantities |= records::asked<records::VoidRatio>;
    return protocol;
  } catch (const InputError& error) {
    std::string message = error.what();
    for (const std::string& one : assignments) {
      const std::string said = keys::assignment_prefix + one;
      for (auto at = message.find(said); at != std::string::npos; at = message.find(said, at + flag.size())) {
        message.replace(at, said.size(), flag + " " + one);
      }
    }
    throw InputError(name_of(assignments) + ": " + message);
  }
}

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
