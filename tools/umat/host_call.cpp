#include "tools/umat/host_call.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <stdexcept>

#include "rvelab/io/utf8.hpp"

namespace umat {

std::string in_words(double value) {
  std::string words = std::to_string(value);
  if (std::nearbyint(value) == value && std::abs(value) < 1e15) words.resize(words.find_first_of(".,"));
  return words;
}

Properties properties_of(const double* props, int n) {
  if (props == nullptr || n < 1)
    throw std::runtime_error("NPROPS is " + std::to_string(n) + "; give PROPS(1), the number of the material");
  const auto option = [&](int k, int most, const std::string& meaning) {
    const double value = n > k ? props[k] : 0;
    if (!(value >= 0 && value <= most && std::nearbyint(value) == value))
      throw std::runtime_error("PROPS(" + std::to_string(k + 1) + ") is " + in_words(value) + "; allowed: " + meaning);
    return int(value);
  };
  if (!(props[0] >= 1 && props[0] < 1e9 && std::nearbyint(props[0]) == props[0]))
    throw std::runtime_error("PROPS(1) is " + in_words(props[0]) + "; give the whole number of a material");
  return {int(props[0]),
          Axes(option(1, 2,
                      "0 (global Cauchy stress, as Abaqus has it), 1 (R^T sigma R, as CalculiX has it) or 2 (the host "
                      "turns what is returned, as MOOSE does)")),
          option(2, 1, "0 (quasi-static) or 1 (DTIME is physical time)") == 1};
}

std::int64_t whole_state(double value, const char* name) {
  if (std::nearbyint(value) == value && std::abs(value) <= 9007199254740992.0) return std::int64_t(value);
  throw std::runtime_error(std::string(name) + " is " + in_words(value) +
                           ", no whole number; keep state variables in double precision, unchanged between calls");
}

Points& points() {
  static Points& made = *[] {
    const char* const named = std::getenv("RVELAB_UMAT");
    return new Points(read_settings(named == nullptr ? "rvelab_umat.toml" : named));
  }();
  return made;
}

void expect_first_stress(int material, const double* given, const Components& components, const Matrix3& R0,
                         const char* name) {
  const Matrix3 own = R0.transpose() * points().first_stress(material) * R0;
  if (components.direct == 2 && own(2, 2) != 0)
    throw std::runtime_error("NDI is 2 and the specimen is 3D; allowed: NDI = 3; use plane strain or solid elements");
  const bool zero = std::all_of(given, given + components.size(), [](double value) { return value == 0; });
  if (zero && points().material(material).from_zero) return;
  double expected[6];
  write_stress(own, components, expected);
  if ((stress_of(given, components) - stress_of(expected, components)).norm() <= 0.01 * own.norm()) return;
  std::string found, wanted;
  for (int k = 0; k < components.size(); ++k) {
    found += " " + in_words(given[k]);
    wanted += " " + in_words(expected[k]);
  }
  throw std::runtime_error(name + std::string(" of the first call is") + found + " Pa; the specimen has" + wanted +
                           " Pa; give that as initial stress (allowed: within 1 %), or a specimen packed to yours" +
                           (zero ? "; for a host that always begins without stress write initial_stress = "
                                   "\"specimen\" under its [[material]] in " +
                                       points().file()
                                 : ""));
}

namespace {

std::string path_of_log() {
  constexpr const char* name = "rvelab_umat.log";
  std::error_code missing;
  const std::filesystem::path path = std::filesystem::absolute(name, missing);
  return missing ? name : path.string();
}

const std::string& log_path() {
  static const std::string path = path_of_log();
  return path;
}

}  // namespace

void remember_folder() { log_path(); }

void log_failure(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> written;
  const std::string line = rvelab::io::message_line(text);  // paths and keys may be long, and of any bytes
  const std::lock_guard lock(mutex);
  if (written.size() >= 100 || !written.insert(line).second) return;
  std::ofstream log(log_path(), std::ios::app);
  if (log << line << '\n' << std::flush) return;
  std::fprintf(stderr, "%s cannot be written; it would say: %s\n", log_path().c_str(), line.c_str());
}

}  // namespace umat
