// Places of rocks as [[rocks]] table reads them. Declared in rocks.hpp.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <stdexcept>

#include "rvelab/io/publish.hpp"
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"

namespace mpm {
namespace {

std::vector<double> numbers_of(double angle) { return {angle * 180 / std::numbers::pi}; }
std::vector<double> numbers_of(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

template <int D>
std::string header_of(bool round) {
  const std::string place = D == 2 ? "x_m,y_m," : "x_m,y_m,z_m,";
  if (round) return place + "radius_m\n";
  return place + (D == 2 ? "a_m,b_m,angle_deg\n" : "a_m,b_m,c_m,w,x,y,z\n");
}

template <int D>
std::vector<double> row_of(const RockShape<D>& shape, const Rigid<D>& body, bool round) {
  std::vector<double> row(body.centre.data(), body.centre.data() + D);
  if (round) {
    row.push_back(shape.bounding_radius());
    return row;
  }
  for (int i = 0; i < D; ++i) row.push_back(shape.height(Vec<D>::Unit(i)));
  for (const double each : numbers_of(body.orientation)) row.push_back(each);
  return row;
}

}  // namespace

template <int D>
void write_rock_tables(const Solver<D>& solver, const std::string& folder) {
  const auto& shapes = solver.rocks->shapes;
  std::map<std::string, bool> round;  // all of a group
  for (const auto& rock : solver.rocks->all) {
    if (!rock.single) round.try_emplace(rock.name, true).first->second &= shapes[std::size_t(rock.shape)].is_sphere();
  }
  std::map<std::string, std::string> tables;
  for (const auto& rock : solver.rocks->all) {
    if (rock.single) continue;
    auto& table = tables[rock.name];
    if (table.empty()) table = header_of<D>(round[rock.name]);
    const char* before = "";
    for (const double each : row_of<D>(shapes[std::size_t(rock.shape)], rock.body, round[rock.name])) {
      if (!std::isfinite(each))
        throw std::runtime_error("a rock of rocks." + rock.name + " stands nowhere at " + std::to_string(solver.time) +
                                 " s; take a smaller time.cfl");
      char text[40];
      std::snprintf(text, sizeof text, "%s%.17g", before, each);
      table += text;
      before = ",";
    }
    table += "\n";
  }
  for (const auto& [name, table] : tables) {
    rvelab::io::publish_text((std::filesystem::path(folder) / ("rocks_" + name + ".csv")).string(), table,
                             rvelab::io::Sync::later);
  }
}

template void write_rock_tables<2>(const Solver<2>&, const std::string&);
template void write_rock_tables<3>(const Solver<3>&, const std::string&);

}  // namespace mpm
