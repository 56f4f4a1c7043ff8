#include "tests/fuzz/formats.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "rvelab/error.hpp"
#include "rvelab/fit/curve.hpp"
#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/import/csv.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/snapshot.hpp"
#include "tests/fuzz/hdf5_edits.hpp"
#include "tests/fuzz/journals.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/gzipped.hpp"
#include "tests/io/nine_discs.hpp"
#include "tests/io/random_specimen.hpp"

namespace rvelab::fuzz {
namespace {

void promise(bool kept, const char* broken) {
  if (!kept) throw std::logic_error(broken);
}

template <class Read>
Answer answer(Read read) {
  try {
    read();
    return Answer::taken;
  } catch (const Error& error) {
    promise(*error.what() != '\0', "an error says nothing");
    return Answer::refused;
  }
}

std::string text_of(View bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Where inputs that are read by name stand: in memory where there is such a place.
std::string scratch(const std::string& name) {
  static const test::Folder folder = [] {
    if (std::filesystem::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 0);
    return test::Folder();
  }();
  return folder / name;
}

std::string file_of(const std::string& name, const std::string& content) {
  const std::string path = scratch(name);
  test::write_bytes(path, content);
  return path;
}

std::string file_of(const std::string& name, View content) { return file_of(name, text_of(content)); }

/// What every command does with a specimen that it has read. Looking at the grains makes the strain that is deferred,
/// in as many sub-steps as are asked for; here a damaged number of them is cut.
void open_state(Specimen specimen) {
  specimen.solver.fixed_substeps = std::min(specimen.solver.fixed_substeps, 1000L);
  const Rve rve(specimen);
  const Network network = rve.network();
  promise(rve.stress().allFinite(), "the stress of an opened state is not finite");
  promise(std::isfinite(void_ratio(network)), "the void ratio of an opened state is not finite");
  promise(std::isfinite(rve.unbalanced_ratio()), "the unbalanced ratio of an opened state is not finite");
  Rve other(rve);
  other.restore(rve.save());
  promise(other.save() == rve.save(), "a state that was saved and restored is another");
}

/// What a resolved file says, without its notes on unusual values, which name a key as it stands in each file.
std::string_view without_notes(std::string_view resolved) {
  while (resolved.starts_with("#")) resolved.remove_prefix(resolved.find('\n') + 1);
  return resolved;
}

Answer check_protocol(View input) {
  const std::string text = text_of(input);
  return answer([&] {
    const protocol::Protocol protocol = protocol::parse_protocol(text, "fuzz.toml");
    const std::string again = protocol::parse_protocol(protocol.resolved, "fuzz.toml").resolved;
    promise(without_notes(again) == without_notes(protocol.resolved), "a resolved protocol, read again, is another");
    static const Specimen specimen = test::nine_discs();
    protocol::with_overrides(protocol, specimen);
  });
}

Answer check_recipe(View input) {
  const std::string text = text_of(input);
  return answer([&] {
    const pack::RecipeFile recipe = pack::parse_recipe(text, "fuzz.toml");
    const auto is_kept = [](const std::string& resolved) {
      const std::string again = pack::parse_recipe(resolved, "fuzz.toml").resolved;
      return without_notes(again) == without_notes(resolved);
    };
    promise(is_kept(recipe.resolved), "a resolved recipe, read again, is another");
    const pack::RecipeFile member =
        recipe.member(7, recipe.pressures.empty() ? std::nullopt : std::optional(recipe.pressures[0]));
    promise(is_kept(member.resolved), "a member of a family, read again, is another");
  });
}

Answer check_material(View input) {
  const std::string path = file_of("material.toml", input);
  return answer([&] {
    Specimen specimen;
    specimen.shape = Shape::disc;
    keys::read_material_file(path, specimen);
    check_parameters(specimen.contact, specimen.damping, specimen.materials);
  });
}

Answer check_csv(View input) {
  const std::vector<std::string> parts = csv_parts(text_of(input));
  const auto part = [&](std::size_t k, const char* name) {
    return k < parts.size() ? std::optional(file_of(name, parts[k])) : std::nullopt;
  };
  const auto particles = part(0, "p.csv"), contacts = part(1, "c.csv"), meta = part(2, "m.json");
  io::ImportOptions options;
  if (!meta) options.material_path = data_file("nine_discs/soil.toml");
  if (!meta && !parts[0].starts_with("ITEM:")) options.cell = Vector3(0.04, 0.04, 0.1);
  return answer([&] { open_state(io::import_csv(*particles, contacts, meta, options)); });
}

/// The specimen of a file of another program.
Specimen import_other(const std::string& path, const std::string& text) {
  io::ImportOptions options;
  options.material_path = data_file("nine_discs/soil.toml");
  const bool has_cell = text.starts_with("ITEM:") || text.find("xlo") != std::string::npos ||
                        text.find("avec") != std::string::npos || text.find("PERIODIC::") != std::string::npos;
  if (!has_cell) options.cell = Vector3(0.04, 0.05, 0.1);
  options.tell = [&](const std::string& line) { promise(!line.empty(), "nothing is told"); };
  return io::import_csv(path, std::nullopt, std::nullopt, options);
}

/// Whole or not at all: what is taken ends in a line break and has as many grains as it says.
Answer check_dump(View input) {
  const std::string text = text_of(input), path = file_of("p.dump", text);
  return answer([&] {
    const Specimen specimen = import_other(path, text);
    if (text.starts_with("ITEM:")) {
      const auto last = text.find_last_not_of(" \t\r\f\v");
      promise(last != std::string::npos && text[last] == '\n', "a dump was taken whose last line may be cut");
      const auto at = text.rfind("NUMBER OF ATOMS");
      promise(at != std::string::npos, "a dump was taken without a number of atoms");
      std::int64_t stated = -1;
      const auto digit = text.find_first_of("+-0123456789", text.find('\n', at));
      std::from_chars(text.data() + digit + (text[digit] == '+'), text.data() + text.size(), stated);
      promise(stated == std::int64_t(specimen.grains.size()), "a dump was taken with another number of grains");
    }
    open_state(specimen);
  });
}

Answer check_data(View input) {
  const std::string text = text_of(input), path = file_of("p.data", text);
  return answer([&] { open_state(import_other(path, text)); });
}

/// A table has no count: each row that is no comment is a grain, but for those before the first and empty ones.
Answer check_text(View input) {
  const std::string text = text_of(input), path = file_of("p.txt", text);
  return answer([&] {
    const Specimen specimen = import_other(path, text);
    promise(std::int64_t(specimen.grains.size()) <= std::count(text.begin(), text.end(), '\n') + 1,
            "a table was taken with more grains than lines");
    open_state(specimen);
  });
}

/// The packed file is what it holds; and changed in a byte or cut it is refused, or holds the same.
Answer check_gz(View input) {
  const std::string text = text_of(input), path = file_of("p", text);
  std::size_t grains = 0, grains_packed = 0;
  const auto count = [&](std::size_t& number) {
    return answer([&] { number = import_other(path, text).grains.size(); });
  };
  const Answer plain = count(grains);
  const std::string packed = test::gzipped(text);
  file_of("p", packed);
  const bool packed_itself = text.starts_with("\x1f\x8b");
  promise(packed_itself || (count(grains_packed) == plain && grains_packed == grains),
          "a file and the same packed are not the same");
  const std::size_t chosen = snapshot_checksum(input);
  std::string damaged = packed;
  damaged[chosen % packed.size()] ^= char(1 << chosen / 7 % 8);
  if (chosen % 3 == 0) damaged.resize(chosen % packed.size());
  file_of("p", damaged);
  std::size_t grains_damaged = 0;
  // A changed magic number makes it a text, which names no columns.
  if (count(grains_damaged) == Answer::taken)
    promise(plain == Answer::taken && grains_damaged == grains, "a damaged gzip file is taken as something else");
  return plain;
}

Answer check_curve(View input) {
  const std::string text = text_of(input);
  return answer([&] {
    for (const fit::Curve& curve : fit::parsed_curves(text, "fuzz.csv")) {
      promise(curve.x.size() == curve.y.size() && curve.x.size() == curve.error.size(), "a curve has a ragged table");
      for (std::size_t k = 0; k < curve.x.size(); ++k)
        promise(!std::isnan(curve.y[k]), "a measured curve is no number");
    }
  });
}

Answer check_specimen_file(const std::string& path) {
  return answer([&] {
    io::file_kind(path);
    io::read_origin(path);
    open_state(io::read_specimen(path));
  });
}

/// Whatever was taken is sealed, and then taken; or refused there, where a part that nothing else reads is damaged.
Answer check_specimen(View input) {
  const std::string path = file_of("s.h5", input), sealed = scratch("sealed.h5");
  const Answer answered = check_specimen_file(path);
  if (answered == Answer::refused) return answered;
  if (answer([&] { io::seal_file(path, sealed); }) == Answer::refused) return answered;
  promise(check_specimen_file(sealed) == Answer::taken, "a file that was taken is refused once it is sealed");
  return answered;
}

Answer check_test(const std::string& path) {
  return answer([&] {
    const io::RecordedTest test = io::read_recorded_test(path);
    for (const io::StoredState& state : io::read_states(path)) open_state(state.specimen);
    io::write_recorded_test(test, scratch("again.h5"));
    promise(io::read_recorded_test(scratch("again.h5")).result.records.size() == test.result.records.size(),
            "records that were read and written are fewer");
  });
}

Answer check_records(View input) { return check_test(file_of("r.h5", input)); }

std::string sealed_file(const std::string& name, Bytes image) {
  const auto seal = io::seal_of(image);
  image.insert(image.end(), seal.begin(), seal.end());
  return file_of(name, View(image));
}

/// The seed with changes through HDF5's own writer, and with a seal that fits them.
std::string sealed_edit(const Bytes& seed, View input, const std::string& name) {
  Choices choices(input);
  return sealed_file(name, edited(View(seed).first(seed.size() - io::seal_bytes), choices));
}

Answer check_specimen_values(View input) { return check_specimen_file(sealed_edit(cemented_seed(), input, "s.h5")); }

Answer check_record_values(View input) { return check_test(sealed_edit(record_seed(), input, "r.h5")); }

/// Any bytes, with a seal that fits. What the library takes for a want of memory is a size that lies.
Answer check_crafted(View input) {
  try {
    return check_specimen_file(sealed_file("s.h5", {input.begin(), input.end()}));
  } catch (const std::bad_alloc&) {
    return Answer::refused;
  }
}

Answer check_journal_file(View bytes) {
  file_of("run.h5.journal", bytes);
  return check_test(scratch("run.h5"));
}

/// As it is, and with checksums that fit where that does not show HDF5 what no checksum vouches for.
Answer check_journal(View input) {
  const Answer answered = check_journal_file(input);
  const Bytes fitting = with_checksums(input);
  if (text_of(fitting) != text_of(input)) check_journal_file(fitting);
  return answered;
}

Answer check_journal_values(View input) {
  Choices choices(input);
  return check_journal_file(edited_journal(choices));
}

Answer check_snapshot_bytes(View bytes) {
  static Rve rve(test::nine_discs());
  static const Bytes before = rve.save();
  const Answer answered = answer([&] {
    rve.restore(bytes);
    open_state(rve.specimen());
  });
  if (answered == Answer::refused && rve.save() == before) return answered;
  promise(answered == Answer::taken, "a snapshot that is refused has changed the state");
  rve.restore(before);
  return answered;
}

/// As it is, and with a head that fits what stands behind it.
Answer check_snapshot(View input) {
  const Answer answered = check_snapshot_bytes(input);
  SnapshotHead head;
  if (input.size() < sizeof head) return answered;
  const View fields = input.subspan(sizeof head);
  static const Bytes whole = snapshot_seeds().at(0);
  std::memcpy(&head, whole.data(), sizeof head);
  head.length = fields.size();
  head.checksum = snapshot_checksum(fields);
  Bytes fitting(input.begin(), input.end());
  std::memcpy(fitting.data(), &head, sizeof head);
  return check_snapshot_bytes(fitting);
}

}  // namespace

const std::vector<Format>& formats() {
  static const std::vector<Format> all{
      {"protocol", true, check_protocol, protocol_seeds},
      {"recipe", true, check_recipe, recipe_seeds},
      {"material", true, check_material, material_seeds},
      {"csv", true, check_csv, csv_seeds},
      {"dump", true, check_dump, dump_seeds},
      {"data", true, check_data, data_seeds},
      {"text", true, check_text, text_seeds},
      {"gz", true, check_gz, gz_seeds},
      {"curve", true, check_curve, curve_seeds},
      {"specimen", false, check_specimen, specimen_seeds},
      {"specimen_values", false, check_specimen_values, choice_seeds},
      {"records", false, check_records, record_seeds},
      {"records_values", false, check_record_values, choice_seeds},
      {"journal", false, check_journal, journal_seeds},
      {"journal_values", false, check_journal_values, choice_seeds},
      {"snapshot", false, check_snapshot, snapshot_seeds},
      {"crafted", false, check_crafted, crafted_seeds},
  };
  return all;
}

}  // namespace rvelab::fuzz
