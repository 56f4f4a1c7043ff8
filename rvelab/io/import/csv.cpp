#include "rvelab/io/import/csv.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "rvelab/cell/cell.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/import/inputs.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/stored_contact.hpp"

namespace rvelab::io {
namespace {

std::string cell_in_words(const Matrix3& matrix) {
  std::string text;
  for (int k = 0; k < 9; ++k) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.9g", k == 0 ? "" : k % 3 == 0 ? "; " : " ", matrix(k / 3, k % 3));
    text += number;
  }
  return "[" + text + "]";
}

/// The cell frame of a cell given by its vectors: H = Q L. An upper triangular H with positive diagonal is kept as
/// it is.
void set_cell(Specimen& specimen, int dimension, const Matrix3& vectors, const std::string& source) {
  const auto factors = triangular_factors(vectors);
  specimen.cell.dimension = dimension;
  specimen.cell.lattice = factors.upper;
  specimen.cell.rotation = factors.rotation;
  if (!factors.upper.allFinite() || !(factors.upper.diagonal().array() > 0).all()) {
    throw InputError(source + ": the cell vectors are the columns of " + cell_in_words(vectors) +
                     " m; allowed: a right-handed cell of positive volume (2D: positive thickness); correct the cell");
  }
}

/// Material of each row by its number: `type` of LAMMPS, from 1, or `matId` of YADE, from 0.
std::vector<std::int32_t> materials_by_number(const CsvTable& table, const Specimen& specimen, const char* name,
                                              std::int64_t first) {
  std::vector<std::int32_t> index;
  const auto column = table.column({name});
  const auto last = first + std::int64_t(specimen.materials.size()) - 1;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto type = table.integer(row, column);
    if (type < first || type > last) {
      throw InputError(table.location(row, column) + " is no material; allowed: " + std::to_string(first) + " to " +
                       std::to_string(last) + ", the materials in their order; add the material");
    }
    index.push_back(std::int32_t(type - first));
  }
  return index;
}

/// Material of each row: by name or number where the file has the column, else the only one.
std::vector<std::int32_t> materials_of(const CsvTable& table, const Specimen& specimen) {
  if (table.has("body"))
    throw InputError(table.location(0) +
                     ": the column `body` is of clumps or superellipsoids, which tables cannot bring back: bodies have "
                     "a motion of their own; "
                     "allowed: a table of grains that move by themselves; keep these in HDF5 files");
  std::vector<std::int32_t> index(table.rows(), 0);
  if (!table.has("material")) {
    const bool several = specimen.materials.size() > 1;
    if (several && table.has("type")) return materials_by_number(table, specimen, "type", 1);
    if (several && table.has("matId")) return materials_by_number(table, specimen, "matId", 0);
    if (specimen.materials.size() > 1) {
      throw InputError(table.location(0) + ": there are " + std::to_string(specimen.materials.size()) +
                       " materials and no column `material`; allowed: one material, or the column with a name for "
                       "each grain; add the column");
    }
    return index;
  }
  std::map<std::string, std::int32_t, std::less<>> indices;
  for (const auto& material : specimen.materials) {
    indices.emplace(material.name, std::int32_t(indices.size()));
  }
  const auto column = table.column({"material"});
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto found = indices.find(table.text(row, column));
    if (found == indices.end()) {
      keys::Choices known;
      for (const auto& [name, number] : indices) known.push_back(name);
      throw InputError(
          table.location(row, column) + " names no material; allowed: " + keys::listed(known) +
          "; correct the name, or give a TOML file with a [[material]] of that name by --material (`rvelab "
          "export --format csv` writes one)");
    }
    index[row] = found->second;
  }
  return index;
}

std::vector<Vector3> positions_of(const CsvTable& table, const Cell& cell) {
  const auto x = table.column({"x"}), y = table.column({"y"});
  const auto z = cell.dimension == 3 ? table.column({"z"}) : x;
  std::vector<Vector3> positions;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double height = cell.dimension == 3 ? table.length(row, z) : 0;
    positions.push_back(cell.rotation.transpose() * Vector3(table.length(row, x), table.length(row, y), height));
  }
  return positions;
}

/// Id of each row; without the column, the number of the row from 1.
std::vector<std::int64_t> ids_of(const CsvTable& table) {
  std::vector<std::int64_t> id(table.rows());
  std::iota(id.begin(), id.end(), std::int64_t{1});
  if (!table.has("id")) return id;
  const auto column = table.column({"id"});
  for (std::size_t row = 0; row < table.rows(); ++row) id[row] = table.integer(row, column);
  return id;
}

/// Rows of a particle table in the order of their ids.
std::vector<std::size_t> order_by_id(const CsvTable& table, const std::vector<std::int64_t>& id) {
  std::vector<std::size_t> order(table.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return id[a] < id[b]; });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (id[order[k]] == id[order[k - 1]]) {
      throw InputError(table.location(order[k], table.column({"id"})) + " is there twice (first at " +
                       table.location(order[k - 1]) + "); allowed: an id of its own for each grain; renumber one");
    }
  }
  return order;
}

/// Members of a clump move as one grain, which spheres do not. Single spheres have the clump -1, or one of their own.
void refuse_clumps(const CsvTable& table) {
  if (!table.has("clumpId")) return;
  const auto column = table.column({"clumpId"});
  std::map<std::int64_t, std::size_t> first;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto clump = table.integer(row, column);
    const auto [found, fresh] = first.emplace(clump, row);
    if (fresh || clump < 0) continue;
    throw InputError(table.location(row, column) + " is the clump of " + table.location(found->second) +
                     " too; allowed: spheres that are in no clump; replace the clumps by spheres");
  }
}

void read_radius(const CsvTable& table, std::size_t row, Grains& grains) {
  const auto radius = table.column({"r", "radius", "diameter"});
  const bool whole = !table.has("r") && !table.has("radius");
  grains.radius.push_back(table.length(row, radius) / (whole ? 2 : 1));
  if (!(grains.radius.back() > 0)) {
    throw InputError(table.location(row, radius) + " m is not positive; allowed: > 0; correct the " +
                     (whole ? "diameter" : "radius"));
  }
}

/// Takes one grain's lengths (m) and the angle of the long axis (degrees, laboratory frame) from its row.
template <class By>
void read_outline(const CsvTable& table, std::size_t row, Specimen& specimen) {
  if constexpr (By::rigid)
    throw InputError(table.location(row) + ": " + By::name +
                     "s are not read from tables, whose contacts would be another state; allowed: HDF5 files; keep the "
                     "specimen in one");
  Grains& grains = specimen.grains;
  typename By::Own own;
  std::size_t last = 0;
  each_column_of<By>(
      [&](const auto& described, double& value, auto& column) {
        last = table.column({described.csv});
        value = table.length(row, last);
        column.push_back(value);
      },
      own, grains);
  if (!By::allowed(own))
    throw InputError(table.location(row, last) + " m makes no " + By::name +
                     " with the lengths before it; allowed: " + By::allowed_in_tables + "; correct them");
  const double radians = table.number(row, table.column({"angle"})) * (3.14159265358979323846 / 180);
  grains.radius.push_back(By::radius(own));
  grains.orientation.push_back(specimen.cell.rotation.transpose() * Vector3(std::cos(radians), std::sin(radians), 0));
}

/// The shape whose columns are there: of two the one that has more; else the round one.
Shape shape_of(const CsvTable& table, int dimension) {
  Shape found = round_shape(dimension);
  std::size_t most = 0;
  for (int number = 0; number < shape_count; ++number)
    with_shape(Shape(number), [&](auto is) {
      std::size_t columns = 0, there = 0;
      each_column_of<typename decltype(is)::By>([&](const auto& described) {
        ++columns;
        there += table.has(described.csv);
      });
      if (there < columns || columns <= most || decltype(is)::By::dimension != dimension) return;
      most = columns;
      found = Shape(number);
    });
  return found;
}

/// Fills the grains; returns each grain's wrapping translation w, x_new = x_old + L w.
std::vector<Image> read_grains(const CsvTable& table, Specimen& specimen) {
  if (table.rows() == 0) {
    throw InputError(table.path() + ": has no rows; allowed: one row a grain, one at least; give the right file");
  }
  const auto positions = positions_of(table, specimen.cell);
  const auto materials = materials_of(table, specimen);
  refuse_clumps(table);
  const auto id = ids_of(table);
  std::vector<Image> wraps;
  Grains& grains = specimen.grains;
  for (const auto row : order_by_id(table, id)) {
    grains.id.push_back(id[row]);
    with_shape(specimen.shape, [&](auto is) {
      if constexpr (decltype(is)::By::round)
        read_radius(table, row, grains);
      else
        read_outline<typename decltype(is)::By>(table, row, specimen);
    });
    grains.material.push_back(materials[row]);
    grains.position.push_back(positions[row]);
    wraps.push_back(wrap(specimen.cell, grains.position.back()));
  }
  grains.velocity.assign(grains.size(), Vector3::Zero());
  grains.spin.assign(grains.size(), Vector3::Zero());
  return wraps;
}

/// Densities of a file are reported where they are not those of the materials, which hold.
void tell_of_densities(const CsvTable& table, const Specimen& specimen, const ImportOptions& options) {
  if (!table.has("density") || table.metres() != 1) return;
  const auto column = table.column({"density"});
  const auto materials = materials_of(table, specimen);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double held = specimen.materials[std::size_t(materials[row])].density;
    double given = 0;
    if (!parsed(table.text(row, column), given) || std::abs(given - held) <= 1e-6 * held) continue;
    options.tell(table.location(row, column) + " kg/m3, and that of the material is " + exact(held) +
                 " kg/m3; the material's density is taken");
    return;
  }
}

/// Takes the cell of one more source; only one source may give a cell.
void take_cell(std::optional<Matrix3>& cell, std::string& source, const Matrix3& further, const std::string& from,
               const std::string& what) {
  if (cell) {
    throw InputError(from + " gives a cell and " + source + " has a cell too; allowed: one of the two; leave " + what +
                     " out");
  }
  cell = further;
  source = from;
}

/// The table has the number of rows that META.json states: a table that was cut may end with a whole line.
void expect_rows(const CsvTable& table, const std::optional<std::size_t>& stated, const char* key,
                 const std::optional<std::string>& meta) {
  if (!stated || *stated == table.rows()) return;
  throw InputError(table.path() + ": has " + std::to_string(table.rows()) +
                   " rows; allowed: " + std::to_string(*stated) + ", which is " + key + " in " + *meta +
                   "; the file is cut, or of another state: give the files that belong together");
}

}  // namespace

Specimen import_csv(const std::string& particles_path, const std::optional<std::string>& contacts_path,
                    const std::optional<std::string>& meta_json_path, const ImportOptions& options) {
  Specimen specimen;
  std::optional<Meta> meta;
  if (meta_json_path) meta = read_meta(*meta_json_path, specimen, !options.material_path);
  const auto stated = meta ? std::optional(meta->dimension) : std::nullopt;
  const Particles particles = read_particles(particles_path, stated, options);
  const CsvTable& table = *particles.table;
  std::optional<Matrix3> vectors = particles.cell;
  std::string source = particles_path;
  if (meta) {
    expect_rows(table, meta->particles, "n_particles", meta_json_path);
    if (meta->cell) take_cell(vectors, source, *meta->cell, *meta_json_path, "its hSize");
    specimen.state.reference.pressure = meta->reference_pressure;
  }
  if (options.material_path) {
    keys::read_material_file(*options.material_path, specimen);
    check_parameters(specimen.contact, specimen.damping, specimen.materials);
  }
  if (specimen.materials.empty()) {
    throw InputError(particles_path +
                     ": comes without contact parameters; allowed: META.json or --material M.toml; give one of them");
  }
  if (options.cell) {
    if (!(options.cell->array() > 0).all()) {
      const Matrix3 given = options.cell->asDiagonal();
      throw InputError("--cell gives the cell vectors " + cell_in_words(given) +
                       " m; allowed: lengths > 0; correct them");
    }
    take_cell(vectors, source, options.cell->asDiagonal(), "--cell", "--cell");
  }
  if (!vectors) {
    throw InputError(particles_path +
                     ": comes without a cell; allowed: META.json with hSize, or --cell Lxx,Lyy,Lzz in m (2D: Lzz is "
                     "the thickness); give one of them");
  }
  set_cell(specimen, particles.dimension, *vectors, source);

  specimen.shape = shape_of(table, particles.dimension);
  const auto wraps = read_grains(table, specimen);
  if (!table.has("id")) {
    if (contacts_path)
      throw InputError(particles_path + ": has no column id, and " + *contacts_path +
                       " names grains by it; allowed: contacts of particles with ids; add the column");
    options.tell(particles_path + " has no column id: grains are numbered from 1 in its order");
  }
  if (contacts_path) {
    const CsvTable contacts(*contacts_path);
    expect_rows(contacts, meta ? meta->contacts : std::nullopt, "n_contacts", meta_json_path);
    read_contacts(contacts, wraps, specimen);
  }
  keys::set_keys(specimen, options.settings);
  check_parameters(specimen.contact, specimen.damping, specimen.materials);
  set_root_overlaps(specimen);
  tell_of_densities(table, specimen, options);
  return specimen;
}

}  // namespace rvelab::io
