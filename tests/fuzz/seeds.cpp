#include "tests/fuzz/seeds.hpp"

#include <algorithm>
#include <filesystem>

#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/protocol/cementation.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/fuzz/journals.hpp"
#include "tests/interaction/settings.hpp"
#include "tests/io/nine_discs.hpp"
#include "tests/io/random_specimen.hpp"

namespace rvelab::fuzz {
namespace {

Bytes bytes_in(const std::string& path) {
  const std::string text = test::bytes_of(path);
  const View bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Files of a folder in the order of their names; with `word`, those that hold it.
std::vector<Bytes> files_in(const std::string& folder, const std::string& word = "", bool holding = true) {
  std::vector<std::string> paths;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.is_regular_file()) paths.push_back(file.path().string());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> found;
  for (const auto& path : paths) {
    const bool holds = test::bytes_of(path).find(word) != std::string::npos;
    if (holds == holding) found.push_back(bytes_in(path));
  }
  return found;
}

const std::string corpus = RVELAB_SOURCE_DIR "/tests/fuzz/corpus/";
const std::string shipped = RVELAB_SOURCE_DIR "/protocols";

std::vector<Bytes> joined(std::vector<Bytes> first, const std::vector<Bytes>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

std::string data_file(const std::string& name) { return RVELAB_TEST_DATA "/" + name; }

Specimen cemented_and_moist() {
  Rve rve(test::nine_discs());
  protocol::Cementation cement;
  cement.gap = 0.5;
  cement.young_modulus = 50e6;
  cement.tensile_strength = cement.cohesion = 1e3;
  rve.set_interactions(protocol::cemented(rve, cement));
  Water water;
  water.suction = 50;
  test::set_settings<CapillaryBridge>(rve, {water});
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 0) = -5e-3;  // some break
  gradient(1, 1) = 5e-3;
  rve.apply(gradient, 0);
  return rve.specimen();
}

io::RecordedTest seed_records() {
  io::RecordedTest test;
  test.checkpoint.specimen = cemented_and_moist();
  test.provenance = io::provenance_of("[test]\n", test.checkpoint.specimen);
  test.result = test::random_result(1, 3);
  return test;
}

Bytes specimen_seed() {
  static const Bytes made = [] {
    const test::Folder folder;
    io::write_specimen(test::nine_discs(), folder / "s.h5");
    return bytes_in(folder / "s.h5");
  }();
  return made;
}

Bytes record_seed() {
  static const Bytes made = [] {
    const test::Folder folder;
    io::write_recorded_test(seed_records(), folder / "r.h5");
    return bytes_in(folder / "r.h5");
  }();
  return made;
}

Bytes cemented_seed() {
  static const Bytes made = [] {
    const test::Folder folder;
    io::write_specimen(cemented_and_moist(), folder / "s.h5");
    return bytes_in(folder / "s.h5");
  }();
  return made;
}

std::vector<std::string> csv_parts(const std::string& text) {
  const std::string line = "====\n";
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(line, begin);
    parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
    if (end == std::string::npos) return parts;
    begin = end + line.size();
  }
}

std::vector<Bytes> protocol_seeds() {
  return joined(joined({bytes_in(data_file("nine_discs/test.toml"))}, files_in(shipped, "[pack]", false)),
                files_in(corpus + "protocol"));
}
std::vector<Bytes> recipe_seeds() { return joined(files_in(shipped, "[pack]"), files_in(corpus + "recipe")); }
std::vector<Bytes> material_seeds() {
  return joined({bytes_in(data_file("nine_discs/soil.toml"))}, files_in(corpus + "material"));
}
std::vector<Bytes> csv_seeds() {
  return joined({bytes_in(data_file("nine_discs/grains.csv"))}, files_in(corpus + "csv"));
}
std::vector<Bytes> dump_seeds() { return joined(files_in(corpus + "csv", "ITEM:"), files_in(corpus + "dump")); }
std::vector<Bytes> data_seeds() { return files_in(corpus + "data"); }
std::vector<Bytes> text_seeds() { return files_in(corpus + "text"); }
std::vector<Bytes> gz_seeds() { return joined(joined(dump_seeds(), data_seeds()), text_seeds()); }
std::vector<Bytes> curve_seeds() { return files_in(corpus + "curve"); }

std::vector<Bytes> specimen_seeds() { return {specimen_seed(), cemented_seed()}; }
std::vector<Bytes> crafted_seeds() {
  std::vector<Bytes> seeds = specimen_seeds();
  for (Bytes& seed : seeds) seed.resize(seed.size() - io::seal_bytes);
  return seeds;
}
std::vector<Bytes> record_seeds() { return {record_seed()}; }
std::vector<Bytes> journal_seeds() { return {whole_journal()}; }
std::vector<Bytes> snapshot_seeds() { return {Rve(test::nine_discs()).save(), Rve(cemented_and_moist()).save()}; }

std::vector<Bytes> choice_seeds() {
  std::vector<Bytes> seeds{{}};
  for (int first = 0; first < 64; first += 3) {
    seeds.push_back({});
    for (int k = 0; k < 12; ++k) seeds.back().push_back(std::byte((first + 7 * k * first) % 251));
  }
  return seeds;
}

}  // namespace rvelab::fuzz
