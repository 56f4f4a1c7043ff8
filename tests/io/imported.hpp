// Specimens that tests import.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "random_specimen.hpp"
#include "rvelab/io/import/csv.hpp"
#include "tests/catch.hpp"

namespace rvelab::test {

inline const std::string packings = std::string(RVELAB_TEST_DATA) + "/yade/";

inline Specimen imported_packing(const std::string& name, const io::ImportOptions& options = {}) {
  return io::import_csv(packings + name + ".particles.csv", packings + name + ".contacts.csv",
                        packings + name + ".json", options);
}

inline nlohmann::json meta(const std::string& name) {
  return nlohmann::json::parse(bytes_of(packings + name + ".json"));
}

inline const std::string sand =
    "[contact]\nlaw = \"hertz_stiffness\"\n[[material]]\nname = \"sand\"\nnormal_stiffness_N_m1_5 = 2e7\n"
    "tangential_stiffness_N_m = 2e6\nfriction = 0.3\n";

struct LooseSpheres {
  Folder folder;
  io::ImportOptions options;
  explicit LooseSpheres(const std::string& particles, const std::string& material = sand) {
    write_bytes(folder / "p.csv", particles);
    write_bytes(folder / "m.toml", material);
    options.material_path = folder / "m.toml";
    options.cell = Vector3(2, 3, 4);
  }
  Specimen specimen() const { return io::import_csv(folder / "p.csv", std::nullopt, std::nullopt, options); }
  std::string error() const {
    return input_error([&] { specimen(); });
  }
};

}  // namespace rvelab::test
