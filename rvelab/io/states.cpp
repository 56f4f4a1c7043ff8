#include "rvelab/io/states.hpp"

#include <algorithm>
#include <charconv>

#include "rvelab/error.hpp"
#include "rvelab/io/record_file.hpp"
#include "rvelab/io/schema.hpp"

namespace rvelab {
namespace {

constexpr const char* snapshots_group = "/snapshots/";

/// Numbers of the groups /snapshots/<number>.
std::vector<long> numbers_of(const Hdf5File& file) {
  std::vector<long> numbers;
  for (const auto& object : file.objects()) {
    if (object.is_dataset || !object.name.starts_with(snapshots_group)) continue;
    const std::string name = object.name.substr(std::string(snapshots_group).size());
    if (name.find('/') != std::string::npos) continue;
    long number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size()) {
      throw InputError(file.path() + ": the group " + object.name +
                       " is not named by the number of a record; the file is damaged: write it again");
    }
    numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

/// Groups are named with or without leading zeros.
std::string group_of(const Hdf5File& file, long number) {
  std::string digits = std::to_string(number);
  while (!file.has(snapshots_group + digits) && digits.size() < 20) digits.insert(digits.begin(), '0');
  return snapshots_group + digits;
}

}  // namespace

std::vector<StoredState> read_states(const std::string& path) {
  if (file_kind(path) == FileKind::specimen) return {{0, 0, read_specimen(path)}};
  const auto records = read_records(path).records;
  const auto strain_of = [&](std::size_t record) {
    return records.empty() ? 0.0 : records[std::min(record, records.size() - 1)].strain;
  };
  std::vector<StoredState> states;
  const auto file = Hdf5File::open(path);
  for (const long number : numbers_of(file)) {
    states.push_back({number, strain_of(std::size_t(number)), io::get_specimen(file, group_of(file, number))});
  }
  const auto end = static_cast<long>(records.size());
  states.push_back({end, strain_of(records.size()), io::get_specimen(file, "/specimen")});
  return states;
}

}  // namespace rvelab
