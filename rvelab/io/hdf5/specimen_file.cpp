#include "rvelab/io/hdf5/specimen_file.hpp"

#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/archive.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/specimen/specimen_check.hpp"
#include "rvelab/specimen/specimen_fields.hpp"

namespace rvelab::io {
namespace {

constexpr const char* specimen_format = "rvelab specimen";
constexpr const char* records_format = "rvelab records";

/// Every field of a specimen, once for every archive.
template <class Archive, class Value>
void describe(Archive& archive, Value& specimen) {
  Described<Archive> described{archive};
  fields::visit(described, specimen);
}

template <class Archive, class Value>
void describe_origin(Archive& archive, Value& origin) {
  auto& [recipe, seed, draw, preparation_friction, expansion, strain_difference] = origin;
  archive.field("provenance/recipe", recipe, "-");
  archive.field("provenance/seed", seed, "1");
  archive.field("provenance/draw", draw, "1");
  archive.field("provenance/preparation_friction", preparation_friction, "1");
}

/// What a file without agitated grains, or made before these were stored, does not have.
constexpr std::pair<const char*, std::optional<double> SpecimenOrigin::*> of_agitation[] = {
    {"provenance/expansion", &SpecimenOrigin::expansion},
    {"provenance/strain_difference", &SpecimenOrigin::strain_difference}};

}  // namespace

std::uint32_t digest(const Specimen& specimen) {
  Digest archive;
  describe(archive, specimen);
  return archive.sum();
}

void stamp(Hdf5File& file, FileKind kind) {
  stamp(file, kind == FileKind::specimen ? specimen_format : records_format);
}

void stamp(Hdf5File& file, const std::string& format) {
  file.set_attribute("format", format);
  file.set_attribute("format_version", format_version);
}

void expect_version(const Hdf5File& file) {
  const std::string found = file.attribute("format_version");
  if (found == format_version) return;
  throw InputError(file.path() + ": has the format version \"" + found + "\"; this program reads " + format_version +
                   "; make the file again, a specimen of `rvelab pack` by the recipe in its /provenance");
}

bool is_rvelab(const Hdf5File& file) {
  const std::string format = file.attribute("format");
  return format == specimen_format || format == records_format || format == pool_format;
}

FileKind checked_kind(const Hdf5File& file) {
  const std::string format = file.attribute("format");
  if (!is_rvelab(file)) {
    throw InputError(file.path() + ": its attribute format is \"" + format + "\"; allowed: \"" + specimen_format +
                     "\", \"" + records_format + "\", \"" + pool_format + "\"; give a file that rvelab wrote");
  }
  expect_version(file);
  return format == records_format ? FileKind::records : FileKind::specimen;
}

void check_format(const Hdf5File& file, const std::string& format) {
  const std::string found = file.attribute("format");
  if (found != format)
    throw InputError(file.path() + ": its attribute format is \"" + found + "\"; allowed: \"" + format + "\"");
  expect_version(file);
}

void put_specimen(Hdf5File& file, const std::string& group, const Specimen& specimen) {
  Writer writer(file, group);
  describe(writer, specimen);
}

Specimen stored_specimen(const Hdf5File& file, const std::string& group) {
  Specimen specimen;
  Reader reader(file, group);
  describe(reader, specimen);
  return specimen;
}

Specimen get_specimen(const Hdf5File& file, const std::string& group) {
  Specimen specimen = stored_specimen(file, group);
  check_specimen(specimen, file.path() + ": " + group + "/");
  return specimen;
}

std::string specimen_group(const Hdf5File& file) {
  if (checked_kind(file) == FileKind::records) return "/specimen";
  if (file.attribute("format") != pool_format) return "";
  const std::vector<std::string> rves = file.groups(pool_rves);
  if (rves.size() == 1) return std::string(pool_rves) + "/" + rves.front();
  throw InputError(file.path() + ": is a pool of " + std::to_string(rves.size()) +
                   " RVEs; allowed: one; write the one that is meant into a pool of its own "
                   "(rvelab_template_from_snapshot, rvelab_spawn, rvelab_pool_write)");
}

void write_specimen(const Specimen& specimen, const std::string& path, const SpecimenOrigin* origin) {
  publish(path, [&](Hdf5File& file) {
    stamp(file, FileKind::specimen);
    put_specimen(file, "", specimen);
    if (origin == nullptr) return;
    Writer writer(file, "");
    describe_origin(writer, *origin);
    for (const auto& [name, value] : of_agitation)
      if (const auto& given = origin->*value) writer.field(name, *given, "1");
    writer.field("provenance/version", std::string(version), "-");
    writer.field("provenance/compiler", compiler(), "-");
  });
}

std::optional<SpecimenOrigin> get_origin(const Hdf5File& file) {
  if (checked_kind(file) != FileKind::specimen || !file.has("/provenance")) return std::nullopt;
  SpecimenOrigin origin;
  Reader reader(file, "");
  describe_origin(reader, origin);
  for (const auto& [name, value] : of_agitation)
    if (file.has(std::string("/") + name)) reader.field(name, (origin.*value).emplace(), "1");
  std::string by;  // said, and read by people
  for (const char* name : {"provenance/version", "provenance/compiler"}) reader.field(name, by, "-");
  return origin;
}

std::optional<SpecimenOrigin> read_origin(const std::string& path) { return get_origin(Hdf5File::open(path)); }

Specimen read_specimen(const std::string& path) {
  const auto file = Hdf5File::open(path);
  return get_specimen(file, specimen_group(file));
}

FileKind file_kind(const std::string& path) { return checked_kind(Hdf5File::open(path)); }

}  // namespace rvelab::io
