#include "rvelab/study/grid.hpp"

#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/records/quantities.hpp"

namespace rvelab::study {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

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
  for (std::string& item : items) item = trimmed(item);
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
  Variation found{trimmed(text.substr(0, equals)), items_of(text.substr(equals + 1))};
  if (found.key.empty()) refuse(text, "names no key");
  for (std::size_t k = 0; k < found.values.size(); ++k) {
    const auto before = found.values.begin() + static_cast<std::ptrdiff_t>(k);
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
  std::string name;
  for (const std::string& one : assignments) name += (name.empty() ? "" : ", ") + one;
  return name.empty() ? "the protocol as it is" : name;
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

}  // namespace rvelab::study
