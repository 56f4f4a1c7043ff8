#include "rvelab/io/specimen_file.hpp"

#include <charconv>

#include "rvelab/error.hpp"
#include "rvelab/io/archive.hpp"
#include "rvelab/io/crc32c.hpp"
#include "rvelab/io/schema.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab {
namespace io {
namespace {

constexpr const char* specimen_format = "rvelab specimen";
constexpr const char* records_format = "rvelab records";

template <class Archive, class Value>
void describe_parameters(Archive& archive, Value& specimen) {
  archive.table("materials", specimen.materials,                                                               //
                Column{"name", &Material::name, "-"},                                                          //
                Column{"density_kg_m3", &Material::density, "kg/m^3"},                                         //
                Column<Material, double>{"young_modulus_Pa", &Material::young_modulus, "Pa"},                  //
                Column<Material, double>{"stiffness_ratio", &Material::stiffness_ratio, "1"},                  //
                Column<Material, double>{"poisson_ratio", &Material::poisson_ratio, "1"},                      //
                Column<Material, double>{"normal_stiffness", &Material::normal_stiffness, "N/m or N/m^1.5"},   //
                Column<Material, double>{"tangential_stiffness_N_m", &Material::tangential_stiffness, "N/m"},  //
                Column{"friction", &Material::friction, "1"},                                                  //
                Column{"rolling_stiffness", &Material::rolling_stiffness, "1"},                                //
                Column{"rolling_friction", &Material::rolling_friction, "1"});

  auto& [law, slip, rolling, unload_rescale] = specimen.contact;
  archive.field("contact/law", law, "-");
  archive.field("contact/slip", slip, "-");
  archive.field("contact/rolling", rolling, "1");
  archive.field("contact/unload_rescale", unload_rescale, "1");

  auto& [local, local_quasi_static, local_form, dashpot, normal_coefficient, restitution, tangential_ratio, no_tension,
         global_viscous] = specimen.damping;
  archive.field("damping/local", local, "1");
  archive.field("damping/local_quasi_static", local_quasi_static, "1");
  archive.field("damping/local_form", local_form, "-");
  archive.field("damping/dashpot", dashpot, "-");
  archive.field("damping/normal_coefficient", normal_coefficient, "N s/m or 1/(m s)");
  archive.field("damping/restitution", restitution, "1");
  archive.field("damping/tangential_ratio", tangential_ratio, "1");
  archive.field("damping/no_tension", no_tension, "1");
  archive.field("damping/global_viscous_N_s_m", global_viscous, "N s/m");

  auto& [skin, time_step_factor, fixed_time_step, collision_steps, target_unbalanced, fixed_substeps, max_substeps,
         min_height, max_overlap_ratio, ledger] = specimen.solver;
  archive.field("solver/skin", skin, "1");
  archive.field("solver/time_step_factor", time_step_factor, "1");
  archive.field("solver/fixed_time_step_s", fixed_time_step, "s");
  archive.later_field("solver/collision_steps", collision_steps, "1", SolverOptions{}.collision_steps);
  archive.field("solver/target_unbalanced", target_unbalanced, "1");
  archive.field("solver/fixed_substeps", fixed_substeps, "1");
  archive.field("solver/max_substeps", max_substeps, "1");
  archive.field("solver/min_height_m", min_height, "m");
  archive.field("solver/max_overlap_ratio", max_overlap_ratio, "1");
  archive.field("solver/ledger", ledger, "1");
}

template <class Archive, class Value>
void describe_state(Archive& archive, Value& state) {
  auto& [has_reference, list_lattice, list_positions, list_travel, list_skin, list_steps, strain_per_step, servo_strain,
         servo_rate, reference_contact_force, reference_overlap, reference_pressure, quasi_static, last_rate, last_step,
         mean_velocity, mean_spin, grain_steps, list_builds, memory_order, ledger] = state;
  archive.field("state/has_reference", has_reference, "1");
  archive.field("state/list_lattice_m", list_lattice, "m");
  archive.later_field("state/list_positions_m", list_positions, "m");
  archive.field("state/list_travel_m", list_travel, "m");
  archive.later_field("state/list_skin_m", list_skin, "m");
  archive.later_field("state/list_steps", list_steps, "1");
  archive.field("state/strain_per_step", strain_per_step, "1");
  archive.field("state/servo_strain", servo_strain, "1");
  archive.later_field("state/servo_rate_1_s", servo_rate, "1/s", Matrix3(Matrix3::Zero()));
  archive.field("state/reference_contact_force_N", reference_contact_force, "N");
  archive.field("state/reference_overlap_m", reference_overlap, "m");
  archive.field("state/reference_pressure_Pa", reference_pressure, "Pa");
  archive.field("state/quasi_static", quasi_static, "1");
  archive.field("state/last_rate", last_rate, "1/s or 1/step");
  archive.field("state/last_step", last_step, "s or step");
  archive.field("state/mean_velocity", mean_velocity, "m/s or m/step");
  archive.field("state/mean_spin_rad_s", mean_spin, "rad/s");
  archive.field("state/grain_steps", grain_steps, "1");
  archive.field("state/list_builds", list_builds, "1");
  archive.later_field("state/memory_order", memory_order, "1");

  auto& [boundary_work, friction, rolling, dashpot, local_damping, global_damping, law_loss, zeroing] = ledger;
  archive.field("state/ledger/boundary_work_J", boundary_work, "J");
  archive.field("state/ledger/friction_J", friction, "J");
  archive.field("state/ledger/rolling_J", rolling, "J");
  archive.field("state/ledger/dashpot_J", dashpot, "J");
  archive.field("state/ledger/local_damping_J", local_damping, "J");
  archive.field("state/ledger/global_damping_J", global_damping, "J");
  archive.field("state/ledger/law_loss_J", law_loss, "J");
  archive.field("state/ledger/zeroing_J", zeroing, "J");
}

/// Every field of a specimen, once for both directions. The structs are taken apart by structured bindings, so that a
/// new field does not compile until it has its place in the file.
template <class Archive, class Value>
void describe(Archive& archive, Value& specimen) {
  archive.field("shape", specimen.shape, "-");

  auto& [dimension, lattice, rotation, increments] = specimen.cell;
  archive.field("cell/dimension", dimension, "1");
  archive.field("cell/lattice_m", lattice, "m");
  archive.field("cell/rotation", rotation, "1");
  archive.field("cell/increments", increments, "1");

  auto& [id, radius, material, position, velocity, spin] = specimen.grains;
  archive.field("grains/id", id, "1");
  archive.field("grains/radius_m", radius, "m");
  archive.field("grains/material", material, "1");
  archive.field("grains/position_m", position, "m");
  archive.field("grains/velocity", velocity, "m/s or m/step");
  archive.field("grains/spin", spin, "rad/s or rad/step");

  archive.table("contacts", specimen.contacts,                                  //
                Column{"i", &Contact::i, "1"},                                  //
                Column{"j", &Contact::j, "1"},                                  //
                Column{"image", &Contact::image, "1"},                          //
                Column{"tangential_force_N", &Contact::tangential_force, "N"},  //
                Column{"rolling_moment_N_m", &Contact::rolling_moment, "N m"},  //
                Column{"last_root_overlap_m0_5", &Contact::last_root_overlap, "m^0.5"});

  describe_parameters(archive, specimen);
  describe_state(archive, specimen.state);
}

template <class Archive, class Value>
void describe_origin(Archive& archive, Value& origin) {
  auto& [recipe, seed, draw, preparation_friction] = origin;
  archive.field("provenance/recipe", recipe, "-");
  archive.field("provenance/seed", seed, "1");
  archive.field("provenance/draw", draw, "1");
  archive.field("provenance/preparation_friction", preparation_friction, "1");
}

/// What the datasets must agree on for the indices to point at something.
void check_indices(const Specimen& specimen, const std::string& path) {
  const auto expect = [&](bool condition, const std::string& what) {
    if (!condition) throw InputError(path + ": " + what + "; the file is damaged: write it again");
  };
  const auto& grains = specimen.grains;
  const auto count = grains.size();
  expect(grains.radius.size() == count && grains.material.size() == count && grains.position.size() == count &&
             grains.velocity.size() == count && grains.spin.size() == count,
         "the datasets under /grains have different lengths; allowed: one row a grain in each, " +
             std::to_string(count) + " here");
  expect(specimen.cell.dimension == dimension_of(specimen.shape),
         "/cell/dimension is " + std::to_string(specimen.cell.dimension) + "; allowed: 2 with discs, 3 with spheres");
  for (const auto material : grains.material) {
    expect(material >= 0 && static_cast<std::size_t>(material) < specimen.materials.size(),
           "/grains/material holds the index " + std::to_string(material) + "; allowed: 0 to " +
               std::to_string(specimen.materials.size()) + " - 1");
  }
  for (const auto& contact : specimen.contacts) {
    expect(contact.i >= 0 && contact.i <= contact.j && static_cast<std::size_t>(contact.j) < count,
           "/contacts holds the pair " + std::to_string(contact.i) + ", " + std::to_string(contact.j) +
               "; allowed: 0 <= i <= j < " + std::to_string(count));
  }
}

/// An archive that runs every value through a checksum.
class Digest {
 public:
  std::uint32_t sum() const { return sum_; }

  template <class Value>
  void field(const std::string&, const Value& value, const std::string&) {
    add(value);
  }
  template <class Value>
  void field(const std::string&, const std::vector<Value>& values, const std::string&) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const Value& value : values) add(value);
  }
  /// A later field counts only where it says something: the digest of an older file stays what it was.
  template <class Value>
  void later_field(const std::string& name, const Value& value, const std::string& units, const Value& initial = {}) {
    if (value != initial) field(name, value, units);
  }
  template <class Item, class... Columns>
  void table(const std::string&, const std::vector<Item>& items, const Columns&... columns) {
    add(static_cast<std::uint64_t>(items.size()));
    for (const Item& item : items) (add(item.*columns.member), ...);
  }

 private:
  template <class Value>
  void add(const Value& value) {
    if constexpr (Textual<Value>) {
      const std::string text = text_of(value) + '\0';
      sum_ = crc32c(std::as_bytes(std::span(text)), sum_);
    } else {
      typename Layout<Value>::Scalar scalars[Layout<Value>::size];
      Layout<Value>::put(value, scalars);
      sum_ = crc32c(std::as_bytes(std::span(scalars)), sum_);
    }
  }

  std::uint32_t sum_ = 0;
};

}  // namespace

std::uint32_t digest(const Specimen& specimen) {
  Digest archive;
  describe(archive, specimen);
  return archive.sum();
}

void stamp(Hdf5File& file, FileKind kind) {
  file.set_attribute("format", kind == FileKind::specimen ? specimen_format : records_format);
  file.set_attribute("format_version", std::to_string(format_major) + "." + std::to_string(format_minor));
}

namespace {

struct FormatVersion {
  int major = 0, minor = 0;
};

FormatVersion format_version(const Hdf5File& file) {
  const std::string text = file.attribute("format_version");
  FormatVersion found;
  const char* const end = text.data() + text.size();
  const auto [dot, failed] = std::from_chars(text.data(), end, found.major);
  if (failed != std::errc() || dot == end || *dot != '.' || std::from_chars(dot + 1, end, found.minor).ptr != end) {
    throw InputError(file.path() + ": its attribute format_version is \"" + text +
                     "\"; allowed: major.minor; the file is damaged: write it again");
  }
  if (found.major > format_major || (found.major == format_major && found.minor > format_minor)) {
    throw InputError(file.path() + ": has the format version " + text + "; allowed: up to " +
                     std::to_string(format_major) + "." + std::to_string(format_minor) +
                     "; open it with a newer rvelab");
  }
  return found;
}

}  // namespace

bool is_rvelab(const Hdf5File& file) {
  const std::string format = file.attribute("format");
  return format == specimen_format || format == records_format;
}

FileKind kind_without_seal(const Hdf5File& file) {
  const std::string format = file.attribute("format");
  if (!is_rvelab(file)) {
    throw InputError(file.path() + ": its attribute format is \"" + format + "\"; allowed: \"" + specimen_format +
                     "\", \"" + records_format + "\"; give a file that rvelab wrote");
  }
  format_version(file);
  return format == specimen_format ? FileKind::specimen : FileKind::records;
}

FileKind checked_kind(const Hdf5File& file) {
  const FileKind kind = kind_without_seal(file);
  const auto [major, minor] = format_version(file);
  if (!file.sealed() && (major > 1 || minor >= sealed_minor)) {
    throw InputError(file.path() +
                     ": lacks the checksum at its end: it is truncated, or another program has changed it; copy it "
                     "again, or, if the change is meant, take it over with `rvelab seal " +
                     file.path() + " -o NEW.h5`");
  }
  return kind;
}

void put_specimen(Hdf5File& file, const std::string& group, const Specimen& specimen) {
  Writer writer(file, group);
  describe(writer, specimen);
}

Specimen get_specimen(const Hdf5File& file, const std::string& group) {
  Specimen specimen;
  Reader reader(file, group);
  describe(reader, specimen);
  check_indices(specimen, file.path());
  return specimen;
}

}  // namespace io

void write_specimen(const Specimen& specimen, const std::string& path, const SpecimenOrigin* origin) {
  publish(path, [&](Hdf5File& file) {
    io::stamp(file, FileKind::specimen);
    io::put_specimen(file, "", specimen);
    if (origin == nullptr) return;
    io::Writer writer(file, "");
    io::describe_origin(writer, *origin);
    writer.field("provenance/version", std::string(version), "-");
    writer.field("provenance/compiler", compiler(), "-");
  });
}

std::optional<SpecimenOrigin> read_origin(const std::string& path) {
  const auto file = Hdf5File::open(path);
  io::checked_kind(file);
  if (!file.has("/provenance/recipe")) return std::nullopt;
  SpecimenOrigin origin;
  io::Reader reader(file, "");
  io::describe_origin(reader, origin);
  return origin;
}

Specimen read_specimen(const std::string& path) {
  const auto file = Hdf5File::open(path);
  return io::get_specimen(file, io::checked_kind(file) == FileKind::specimen ? "" : "/specimen");
}

FileKind file_kind(const std::string& path) { return io::checked_kind(Hdf5File::open(path)); }

}  // namespace rvelab
