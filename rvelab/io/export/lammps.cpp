// Dumps and data files of LAMMPS. Declared in export.hpp.
#include "rvelab/io/export/export.hpp"

#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab::io {
namespace {

std::string spaced(const Vector3& vector) { return exact(vector[0]) + " " + exact(vector[1]) + " " + exact(vector[2]); }

/// Fluctuation velocity or spin; those of a quasi-static state are per sub-step and mean nothing elsewhere.
Vector3 physical(const ExportState& state, const Vector3& velocity) {
  return state.network.loading == Loading::quasi_static ? Vector3(Vector3::Zero()) : velocity;
}

/// LAMMPS counts atoms from 1: ids are moved up where the smallest is below.
std::string id_of(const ExportState& state, std::size_t grain) {
  const auto& id = state.specimen.grains.id;  // ascending
  return std::to_string(id[grain] + std::max<std::int64_t>(0, 1 - id.front()));
}

std::string type_of(const ExportState& state, std::size_t grain) {
  return std::to_string(state.specimen.grains.material[grain] + 1);
}

void refuse_outlines(const ExportState& state) {
  if (!is_round(state.network.shape))
    throw InputError("LAMMPS files of this form (atom_style sphere) know round grains only; the specimen has " +
                     std::string(name(state.network.shape)) + "s; export it as xdmf");
}

void refuse_bodies(const ExportState& state) {
  if (!state.network.has_bodies()) return;
  throw InputError(
      "the specimen has clumps, which files of LAMMPS do not hold here; allowed: specimens of discs or spheres; export "
      "XDMF or CSV instead");
}

void append_dump(std::string& text, const ExportState& state) {
  refuse_outlines(state);
  refuse_bodies(state);
  const Box box(within_tilt_limits(state.network.cell.lattice));
  const Matrix3& l = box.lattice();
  const double xy = l(0, 1), xz = l(0, 2), yz = l(1, 2);
  const Vector3 low = box.corner(), high = low + l.diagonal();
  // A dump states the cuboid around the tilted box.
  const double low_x = low[0] + std::min({0.0, xy, xz, xy + xz}), high_x = high[0] + std::max({0.0, xy, xz, xy + xz});
  const double low_y = low[1] + std::min(0.0, yz), high_y = high[1] + std::max(0.0, yz);
  text += "ITEM: TIMESTEP\n" + std::to_string(state.record) + "\nITEM: NUMBER OF ATOMS\n" +
          std::to_string(state.network.grains.size()) + "\nITEM: BOX BOUNDS xy xz yz pp pp pp\n";
  text += exact(low_x) + " " + exact(high_x) + " " + exact(xy) + "\n";
  text += exact(low_y) + " " + exact(high_y) + " " + exact(xz) + "\n";
  text += exact(low[2]) + " " + exact(high[2]) + " " + exact(yz) + "\n";
  text += "ITEM: ATOMS id type x y z radius vx vy vz\n";
  for (std::size_t g = 0; g < state.network.grains.size(); ++g) {
    const GrainState& grain = state.network.grains[g];
    text += id_of(state, g) + " " + type_of(state, g) + " " + spaced(box.wrapped(grain.position)) + " " +
            exact(grain.radius) + " " + spaced(physical(state, grain.velocity)) + "\n";
  }
}

}  // namespace

void export_lammps_dump(const std::vector<ExportState>& states, const std::string& path) {
  std::string text;
  for (const ExportState& state : states) append_dump(text, state);
  publish_text(path, text);
}

void export_lammps_data(const ExportState& state, const std::string& path) {
  refuse_outlines(state);
  refuse_bodies(state);
  const Box box(within_tilt_limits(state.network.cell.lattice));
  const Matrix3& l = box.lattice();
  const Vector3 low = box.corner(), high = low + l.diagonal();
  const auto& grains = state.network.grains;
  std::string text =
      std::string("rvelab ") + version + ", SI units, cell frame; read with units si, atom_style sphere\n\n";
  text +=
      std::to_string(grains.size()) + " atoms\n" + std::to_string(state.specimen.materials.size()) + " atom types\n\n";
  text += exact(low[0]) + " " + exact(high[0]) + " xlo xhi\n" + exact(low[1]) + " " + exact(high[1]) + " ylo yhi\n" +
          exact(low[2]) + " " + exact(high[2]) + " zlo zhi\n";
  text += spaced({l(0, 1), l(0, 2), l(1, 2)}) + " xy xz yz\n\nAtoms # sphere\n\n";
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Material& material = state.specimen.materials[std::size_t(state.specimen.grains.material[g])];
    text += id_of(state, g) + " " + type_of(state, g) + " " + exact(2 * grains[g].radius) + " " +
            exact(material.density) + " " + spaced(box.wrapped(grains[g].position)) + "\n";
  }
  text += "\nVelocities\n\n";
  for (std::size_t g = 0; g < grains.size(); ++g) {
    text += id_of(state, g) + " " + spaced(physical(state, grains[g].velocity)) + " " +
            spaced(physical(state, grains[g].spin)) + "\n";
  }
  publish_text(path, text);
}

}  // namespace rvelab::io
