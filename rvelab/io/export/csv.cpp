// A specimen as the files that import_csv reads. Declared in export.hpp.
#include "rvelab/io/export/export.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/keys/parameters.hpp"
#include "rvelab/measure/stored_contact.hpp"
#include "rvelab/solver/assembly/neighbour_list.hpp"

namespace rvelab::io {
namespace {

using Json = nlohmann::ordered_json;

const std::string first_line =
    std::string("# rvelab ") + version + "; SI units (m, N, Pa, kg, s); laboratory frame; at rest\n";

void append(std::string& row, const Vector3& vector, int components) {
  for (int k = 0; k < components; ++k) row += "," + exact(vector[k]);
}

/// The part before the first row: "a,b,c" with the components of a vector that the dimension has.
std::string axes(const std::string& stem, int dimension) {
  std::string text;
  for (int k = 0; k < dimension; ++k) text += "," + stem + "xyz"[k];
  return text;
}

void expect_names(const Specimen& specimen) {
  std::set<std::string> names;
  for (const Material& material : specimen.materials) {
    const std::string& name = material.name;
    const bool plain = !name.empty() && name.find_first_of(",\n\r\t\"") == std::string::npos && name.front() != ' ' &&
                       name.back() != ' ';
    if (!plain || !names.insert(name).second) {
      throw InputError("material.name = \"" + name +
                       "\" cannot stand in a CSV file; allowed: names without commas, each once; rename the material");
    }
  }
}

/// What says how large a grain is: its radius; of one that is not round the lengths of its shape (m) and the angle of
/// the long axis, degrees, in space the quaternion of its axes, scalar first, laboratory frame.
template <class By>
std::string size_names() {
  if constexpr (By::round) return ",r";
  std::string names;
  each_column_of<By>([&](const auto& described) { names += "," + std::string(described.csv); });
  return names + (By::rigid ? ",q0,q1,q2,q3" : ",angle");
}
template <class By>
std::string size_of(const Specimen& specimen, std::size_t g) {
  if constexpr (By::round) return "," + exact(specimen.grains.radius[g]);
  std::string text;
  each_column_of<By>([&](const auto&, const auto& column) { text += "," + exact(column[g]); }, specimen.grains);
  if constexpr (By::rigid) {
    const Turn q = after(turn_of(specimen.cell.rotation), specimen.bodies[g].orientation);
    return text + "," + exact(q.w) + "," + exact(q.v[0]) + "," + exact(q.v[1]) + "," + exact(q.v[2]);
  }
  const Vector3 axis = specimen.cell.rotation * specimen.grains.orientation[g];
  return text + "," + exact(std::atan2(axis[1], axis[0]) * (180 / 3.14159265358979323846));
}

template <class By>
std::string particles_of(const Specimen& specimen) {
  const int dimension = specimen.cell.dimension;
  std::string text = first_line + "id" + axes("", dimension) + size_names<By>() + ",material" +
                     (specimen.bodies.empty() ? "\n" : ",body\n");
  const Grains& grains = specimen.grains;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    text += std::to_string(grains.id[g]);
    append(text, specimen.cell.rotation * grains.position[g], dimension);
    text += size_of<By>(specimen, g) + "," + specimen.materials[std::size_t(grains.material[g])].name;
    if (!specimen.bodies.empty()) {
      const auto next = std::upper_bound(specimen.bodies.begin(), specimen.bodies.end(), std::int32_t(g),
                                         [](std::int32_t row, const Body& body) { return row < body.first; });
      text += "," + std::to_string(std::prev(next)->id);
    }
    text += "\n";
  }
  return text;
}

/// The tangential force as a vector, cell frame; 2D: the file holds its component along t = (-n_y, n_x).
Vector3 tangential_force(const Specimen& specimen, const Contact& contact) {
  if (specimen.cell.dimension == 3) return contact.tangential_force;
  const Vector3 normal = normal_of(specimen, contact);
  return contact.tangential_force[0] * Vector3(-normal[1], normal[0], 0);
}

/// Two members of a body, as far from each other as they are fixed.
bool are_of_one_body(const Specimen& specimen, const Contact& pair) {
  if (specimen.bodies.empty()) return false;
  const auto body_of = [&](std::int32_t g) {
    return std::upper_bound(specimen.bodies.begin(), specimen.bodies.end(), g,
                            [](std::int32_t row, const Body& body) { return row < body.first; });
  };
  if (body_of(pair.i) != body_of(pair.j)) return false;
  const auto i = std::size_t(pair.i), j = std::size_t(pair.j);
  const double fixed = (specimen.members[j].offset - specimen.members[i].offset).norm();
  return std::abs(branch_of(specimen, pair).norm() - fixed) < 1e-6 * specimen.grains.radius[i];
}

/// Contacts of a specimen, and the pairs that touch without a history: without friction, springs or slip that is all of
/// them.
std::vector<Contact> touching_contacts(const Specimen& specimen) {
  const auto key = [](const auto& pair) { return std::tie(pair.i, pair.j, pair.image); };
  std::vector<Contact> contacts = specimen.contacts;
  const std::vector<double> reach = reach_of(specimen.shape, specimen.grains);
  for (const ListedPair& pair : list_pairs(specimen.cell, specimen.grains.position.front().data(), 3, reach, 0)) {
    const auto same = std::lower_bound(specimen.contacts.begin(), specimen.contacts.end(), pair,
                                       [&](const Contact& c, const ListedPair& p) { return key(c) < key(p); });
    const Contact bare{pair.i, pair.j, pair.image};
    if (are_of_one_body(specimen, bare)) continue;
    const bool known = same != specimen.contacts.end() && key(*same) == key(pair);
    if (!known && overlap_of(specimen, bare) > 0) contacts.push_back(bare);
  }
  std::sort(contacts.begin(), contacts.end(), [&](const Contact& a, const Contact& b) { return key(a) < key(b); });
  return contacts;
}

std::string text_of(const Specimen& specimen, const std::vector<Contact>& contacts) {
  const int dimension = specimen.cell.dimension;
  const Law law = specimen.contact.law;
  const bool rolling = specimen.contact.rolling, round = is_round(specimen.shape);
  const bool hertz = with_law(law, [](auto each) { return decltype(each)::Force::Impact::stiffens; });
  std::string text = first_line + "id1,id2" + axes("s", dimension) + ",fn" + axes("fs", dimension);
  text += std::string(dimension == 2 ? ",ft" : "") + (hertz ? ",kno,kso" : ",kn,ks");
  if (!round) text += axes("n", dimension);
  if (rolling) text += (dimension == 3 ? axes("m", 3) : ",mz") + std::string(",kr");
  text += "\n";
  const Matrix3& turn = specimen.cell.rotation;
  for (const Contact& contact : contacts) {
    const PairParameters pair = parameters_of(specimen, contact);
    text += std::to_string(specimen.grains.id[std::size_t(contact.i)]) + "," +
            std::to_string(specimen.grains.id[std::size_t(contact.j)]);
    for (int k = 0; k < dimension; ++k) text += "," + std::to_string(contact.image[std::size_t(k)]);
    text += "," + exact(normal_force_of(specimen, contact));
    append(text, turn * tangential_force(specimen, contact), dimension);
    if (dimension == 2) text += "," + exact(contact.tangential_force[0]);
    text += "," + exact(pair.kn) + "," + exact(pair.kt);
    if (!round) append(text, turn * normal_of(specimen, contact), dimension);
    if (rolling) {
      const Vector3 moment = turn * contact.rolling_moment;
      if (dimension == 3) append(text, moment, 3);
      if (dimension == 2) text += "," + exact(moment[2]);
      text += "," + exact(pair.kr);
    }
    text += "\n";
  }
  return text;
}

/// META.json knows one material and the laws that compute their stiffness.
void add_parameters(Json& meta, const Specimen& specimen) {
  const bool linear = specimen.contact.law == Law::linear, hertz = specimen.contact.law == Law::hertz_mindlin;
  if (specimen.materials.size() != 1 || (!linear && !hertz)) return;
  const Material& material = specimen.materials[0];
  meta["density"] = material.density;
  meta["E_Pa"] = material.young_modulus;
  meta[linear ? "kt_over_kn" : "nu"] = linear ? material.stiffness_ratio : material.poisson_ratio;
  meta["mu"] = material.friction;
  if (specimen.contact.rolling) {
    meta["beta"] = material.rolling_stiffness;
    meta["eta"] = material.rolling_friction;
  }
}

std::string meta_of(const Specimen& specimen, std::size_t contacts) {
  const int dimension = specimen.cell.dimension;
  Json meta;
  meta["dim"] = dimension;
  meta["units"] = "SI";
  meta["n_particles"] = specimen.grains.size();
  meta["n_contacts"] = contacts;
  const Matrix3 vectors = specimen.cell.rotation * specimen.cell.lattice;
  for (int k = 0; k < dimension; ++k) {
    Json row = Json::array();
    for (int l = 0; l < dimension; ++l) row.push_back(vectors(k, l));
    meta["hSize"].push_back(row);
  }
  if (dimension == 2) meta["thickness_m"] = specimen.cell.lattice(2, 2);
  meta["p0_Pa"] = specimen.state.reference.pressure;
  add_parameters(meta, specimen);
  return meta.dump(1) + "\n";
}

}  // namespace

CsvExport csv_files(const std::string& stem) {
  return {stem + ".particles.csv", stem + ".contacts.csv", stem + ".json", stem + ".material.toml"};
}

CsvExport export_csv(const Specimen& specimen, const std::string& stem) {
  expect_names(specimen);
  const CsvExport files = csv_files(stem);
  publish_text(files.particles,
               with_shape(specimen.shape, [&](auto is) { return particles_of<typename decltype(is)::By>(specimen); }));
  const std::vector<Contact> contacts = touching_contacts(specimen);
  publish_text(files.contacts, text_of(specimen, contacts));
  publish_text(files.meta, meta_of(specimen, contacts.size()));
  publish_text(files.material, keys::parameters_text(specimen));
  return files;
}

}  // namespace rvelab::io
