// Contacts of an imported packing: their history, and the check that file and parameters belong together. Declared in
// inputs.hpp.
#include "rvelab/io/import/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "rvelab/error.hpp"
#include "rvelab/measure/stored_contact.hpp"

namespace rvelab::io {
namespace {

constexpr double agreement = 1e-6;  ///< of the largest normal force; of a stiffness

std::string text(double value) {
  char number[32];
  std::snprintf(number, sizeof number, "%.9g", value);
  return number;
}

/// Columns of a contact table, as far as the specimen needs them.
class ContactColumns {
 public:
  ContactColumns(const CsvTable& table, const Specimen& specimen)
      : table_(table), three_(specimen.cell.dimension == 3) {
    id1 = table.column({"id1"});
    id2 = table.column({"id2"});
    fn = table.column({"fn"});
    for (const char* name : {"sx", "sy", "sz"}) add(shift_, name);
    for (const char* name : {"fsx", "fsy", "fsz"}) add(shear_, name);
    if (three_ && specimen.contact.rolling) {
      for (const char* name : {"mx", "my"}) moment_.push_back(table.column({name}));
    }
    if (specimen.contact.rolling || table.has("mz")) moment_.push_back(table.column({"mz"}));
  }

  Image image(std::size_t row) const {
    Image image{};
    for (std::size_t k = 0; k < shift_.size(); ++k) {
      const auto shift = table_.integer(row, shift_[k]);
      if (shift < -largest_shift || shift > largest_shift) {
        throw InputError(table_.location(row, shift_[k]) +
                         " is out of range; allowed: " + std::to_string(-largest_shift) + " to " +
                         std::to_string(largest_shift) + " cells; correct the shift");
      }
      image[k] = int(shift);
    }
    return image;
  }
  Vector3 tangential_force(std::size_t row) const {
    Vector3 force = Vector3::Zero();
    for (std::size_t k = 0; k < shear_.size(); ++k) force[int(k)] = table_.number(row, shear_[k]);
    return force;
  }
  /// 2D: about z; 3D: all three, or z alone where the table has no others.
  Vector3 rolling_moment(std::size_t row) const {
    Vector3 moment = Vector3::Zero();
    for (std::size_t k = 0; k < moment_.size(); ++k) {
      moment[int(3 - moment_.size() + k)] = table_.number(row, moment_[k]);
    }
    return moment;
  }

  std::size_t id1, id2, fn;

 private:
  static constexpr std::int64_t largest_shift = 1 << 20;
  void add(std::vector<std::size_t>& columns, const char* name) const {
    if (three_ || columns.size() < 2) columns.push_back(table_.column({name}));
  }
  const CsvTable& table_;
  bool three_;
  std::vector<std::size_t> shift_, shear_, moment_;
};

std::string pair_of(const CsvTable& table, const ContactColumns& columns, std::size_t row) {
  return "contact " + std::string(table.text(row, columns.id1)) + "-" + std::string(table.text(row, columns.id2));
}

/// i <= j; a grain and its own image: the first non-zero entry of the image positive.
void turn_round_if_needed(Contact& contact) {
  const bool backwards = contact.i > contact.j || (contact.i == contact.j && contact.image < Image{});
  if (!backwards) return;
  std::swap(contact.i, contact.j);
  for (int& shift : contact.image) shift = -shift;
  contact.tangential_force = -contact.tangential_force;
  contact.rolling_moment = -contact.rolling_moment;
}

/// 2D: the in-plane force vector as its component along t = (-n_y, n_x), the form that a specimen stores.
Vector3 along_tangent(const Specimen& specimen, const Contact& contact) {
  const Vector3& f = contact.tangential_force;
  if (!is_round(specimen.shape)) {
    const Vector3 n = normal_of(specimen, contact);
    return {n[0] * f[1] - n[1] * f[0], 0, 0};
  }
  const Vector3 b = branch_of(specimen, contact);
  return {(b[0] * f[1] - b[1] * f[0]) / std::sqrt(b[0] * b[0] + b[1] * b[1]), 0, 0};
}

/// 2D: the tangential force of a row. Where the file has the component itself, `ft`, that one: neither a turned frame
/// nor a division has touched it. It must be that of the vector beside it.
Vector3 tangential_component(const CsvTable& table, std::size_t row, const Specimen& specimen, const Contact& contact) {
  const Vector3 computed = along_tangent(specimen, contact);
  if (!table.has("ft")) return computed;
  const auto column = table.column({"ft"});
  const double given = table.number(row, column);
  if (std::abs(given - computed[0]) > agreement * contact.tangential_force.stableNorm()) {
    throw InputError(table.location(row, column) + " N: fsx and fsy give " + text(computed[0]) +
                     " N along (-n_y, n_x); allowed: equal within 1e-6; correct one or leave the column out");
  }
  return {given, 0, 0};
}

/// The stiffnesses in the file must be those that the parameters give.
void check_stiffnesses(const CsvTable& table, const std::vector<Contact>& contacts, const Specimen& specimen,
                       const ContactColumns& columns) {
  const auto expect = [&](const std::vector<std::string>& names, double PairParameters::*stiffness) {
    if (std::none_of(names.begin(), names.end(), [&](const auto& name) { return table.has(name); })) return;
    const auto column = table.column(names);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double computed = parameters_of(specimen, contacts[row]).*stiffness;
      if (std::abs(table.number(row, column) - computed) <= agreement * std::abs(computed)) continue;
      throw InputError(table.location(row, column) + ", " + pair_of(table, columns, row) + ": the parameters give " +
                       text(computed) + "; allowed: equal within 1e-6; " +
                       "the contacts are of other parameters: give those that belong to this file");
    }
  };
  expect({"kn", "kno"}, &PairParameters::kn);
  expect({"ks", "kso"}, &PairParameters::kt);
  if (specimen.contact.rolling) expect({"kr"}, &PairParameters::kr);
}

/// The normal forces in the file must be those that the law makes of the overlaps.
void check_normal_forces(const CsvTable& table, const std::vector<Contact>& contacts, const Specimen& specimen,
                         const ContactColumns& columns, double largest) {
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double overlap = overlap_of(specimen, contacts[row]);
    const double computed = normal_force_of(specimen, contacts[row]);
    if (std::abs(table.number(row, columns.fn) - computed) <= agreement * largest) continue;
    throw InputError(table.location(row, columns.fn) + " N, " + pair_of(table, columns, row) + ": contact.law = " +
                     name(specimen.contact.law) + " gives " + text(computed) + " N at an overlap of " + text(overlap) +
                     " m; allowed: equal within 1e-6 of the largest, " + text(largest) +
                     " N; the file is of other parameters, another cell or other particles: give those that belong "
                     "together");
  }
}

/// Force and moment must be within friction and the rolling cap: else the first step would cut them silently.
void check_caps(const CsvTable& table, const std::vector<Contact>& contacts, const Specimen& specimen,
                const ContactColumns& columns, double largest) {
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const PairParameters pair = parameters_of(specimen, contacts[row]);
    const double pressing = with_law(specimen.contact.law, [&](auto law) {
      return decltype(law)::Force::pressing_force(normal_force_of(specimen, contacts[row]), pair.law_constant);
    });
    const auto expect = [&](double value, double factor, const char* what, const char* unit, const char* cap) {
      if (value <= factor * pressing + agreement * std::max(factor, 1e-3) * largest) return;
      throw InputError(table.location(row) + ": " + pair_of(table, columns, row) + " has a " + what + " of " +
                       text(value) + " " + unit + "; allowed: up to " + text(factor * pressing) + " " + unit + ", " +
                       cap +
                       " times the normal force; give the parameters that belong to this file (others are put "
                       "over them by --set)");
    };
    expect(contacts[row].tangential_force.stableNorm(), pair.friction, "tangential force", "N", "friction");
    if (specimen.contact.rolling) {
      expect(contacts[row].rolling_moment.stableNorm(), pair.moment_cap, "rolling moment", "N m", "eta and the radius");
    }
  }
}

}  // namespace

void read_contacts(const CsvTable& table, const std::vector<Image>& wraps, Specimen& specimen) {
  const ContactColumns columns(table, specimen);
  std::unordered_map<std::int64_t, std::int32_t> index;
  for (std::size_t k = 0; k < specimen.grains.size(); ++k) {
    index.emplace(specimen.grains.id[k], std::int32_t(k));
  }
  const auto grain = [&](std::size_t row, std::size_t column) {
    const auto found = index.find(table.integer(row, column));
    if (found == index.end()) {
      throw InputError(table.location(row, column) +
                       " is no grain of the particle file; allowed: its ids; give the files that belong together");
    }
    return found->second;
  };

  std::vector<Contact> contacts(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Contact& contact = contacts[row];
    contact.i = grain(row, columns.id1);
    contact.j = grain(row, columns.id2);
    const Image &wi = wraps[std::size_t(contact.i)], &wj = wraps[std::size_t(contact.j)];
    const Image shift = columns.image(row);
    for (std::size_t k = 0; k < 3; ++k) contact.image[k] = shift[k] - wj[k] + wi[k];
    contact.tangential_force = specimen.cell.rotation.transpose() * columns.tangential_force(row);
    contact.rolling_moment = specimen.cell.rotation.transpose() * columns.rolling_moment(row);
    if (!specimen.contact.rolling && contact.rolling_moment != Vector3::Zero()) {
      throw InputError(table.location(row) + ": " + pair_of(table, columns, row) +
                       " has a rolling moment; allowed: none where contact.rolling is false; give rolling parameters "
                       "(beta and eta above 0)");
    }
    if (contact.i == contact.j && contact.image == Image{}) {
      throw InputError(table.location(row) + ": " + pair_of(table, columns, row) +
                       " is of a grain with itself; allowed: with another grain or a shifted image; remove the row");
    }
    turn_round_if_needed(contact);
    if (specimen.cell.dimension == 2) contact.tangential_force = tangential_component(table, row, specimen, contact);
  }
  check_stiffnesses(table, contacts, specimen, columns);
  double largest = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) largest = std::max(largest, table.number(row, columns.fn));
  check_normal_forces(table, contacts, specimen, columns, largest);
  check_caps(table, contacts, specimen, columns, largest);

  std::vector<std::size_t> order(table.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t row) { return std::tie(contacts[row].i, contacts[row].j, contacts[row].image); };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (key(order[k]) == key(order[k - 1])) {
      throw InputError(table.location(order[k]) + ": " + pair_of(table, columns, order[k]) +
                       " is there twice (first at " + table.location(order[k - 1]) +
                       "); allowed: once for each pair and shift; remove one");
    }
  }
  specimen.contacts.clear();
  for (const auto row : order) {
    if (overlap_of(specimen, contacts[row]) > 0)
      specimen.contacts.push_back(contacts[row]);  // others touch at zero force
  }
}

}  // namespace rvelab::io
