// META.json of a packing: law, parameters, cell and stress level, keys as in csv.hpp. Declared in inputs.hpp.
#include "rvelab/io/import/inputs.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {
namespace {

using Parsed = nlohmann::json;

class MetaFile {
 public:
  explicit MetaFile(const std::string& path) : path_(path) {
    const auto text = keys::whole_file<std::string>(path, "the packing's JSON file", 16 << 20);
    try {
      json_ = Parsed::parse(text);
    } catch (const Parsed::exception& error) {  // a number beyond all doubles is no parse error to the library
      const std::string what = error.what();
      const auto token = what.find("last read: ");
      const std::string begin = what.substr(0, token), rest = token == std::string::npos ? "" : what.substr(token);
      fail("is not JSON (" + begin + keys::shortened(rest) + "); correct the file");
    }
    if (!json_.is_object()) fail("is not a JSON object; allowed: {\"dim\": 2, ...}; give the packing's JSON file");
  }

  [[noreturn]] void fail(const std::string& message) const { throw InputError(path_ + ": " + message); }

  bool has(const char* key) const { return json_.contains(key) && !json_[key].is_null(); }

  double number(const char* key) const {
    if (!has(key)) fail(std::string("the key ") + key + " is missing; allowed: a number; add it");
    return checked(key, json_[key]);
  }
  double number_or_zero(const char* key) const { return has(key) ? number(key) : 0; }

  /// A number of rows; none if the key is not there.
  std::optional<std::size_t> count(const char* key) const {
    if (!has(key)) return std::nullopt;
    const Parsed& value = json_[key];
    if (!value.is_number_unsigned()) {
      fail(std::string(key) + " = " + (value.is_structured() ? "a list or an object" : keys::shortened(value.dump())) +
           " is not a number of rows; allowed: whole numbers from 0; correct it");
    }
    return value.get<std::size_t>();
  }

  Matrix3 matrix(const char* key, int dimension) const {
    const Parsed& rows = json_[key];
    const auto size = std::size_t(dimension);
    Matrix3 matrix = Matrix3::Identity();
    bool square = rows.is_array() && rows.size() == size;
    for (std::size_t i = 0; square && i < size; ++i) {
      square = rows[i].is_array() && rows[i].size() == size;
      for (std::size_t j = 0; square && j < size; ++j) {
        matrix(int(i), int(j)) = checked(key, rows[i][j]);
      }
    }
    if (!square) {
      const std::string found = rows.is_structured() ? "" : " = " + keys::shortened(rows.dump());
      fail(key + found + " is no matrix; allowed: dim rows of dim numbers each; correct it");
    }
    return matrix;
  }

 private:
  double checked(const char* key, const Parsed& value) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      // Lists in lists may go so deep that nobody writes them out.
      const std::string found = value.is_structured() ? "a list or an object" : keys::shortened(value.dump());
      fail(std::string(key) + " = " + found + " is not a finite number; allowed: numbers; correct it");
    }
    return value.get<double>();
  }

  std::string path_;
  Parsed json_;
};

double friction(const MetaFile& file) {
  if (file.has("mu")) return file.number("mu");
  if (!file.has("phi_deg")) file.fail("the key mu or phi_deg is missing; allowed: one of the two; add it");
  constexpr double degree = 3.14159265358979323846 / 180;
  return std::tan(file.number("phi_deg") * degree);
}

void read_parameters(const MetaFile& file, Specimen& specimen) {
  const bool linear = file.has("kt_over_kn");
  if (linear == file.has("nu")) {
    file.fail(std::string(linear ? "both" : "neither") +
              " of kt_over_kn and nu are there; allowed: kt_over_kn (linear law) or nu (Hertz-Mindlin); give one");
  }
  Material material;
  material.density = file.number("density");
  material.young_modulus = file.number("E_Pa");
  (linear ? material.stiffness_ratio : material.poisson_ratio) = file.number(linear ? "kt_over_kn" : "nu");
  material.friction = friction(file);
  const double beta = file.number_or_zero("beta"), eta = file.number_or_zero("eta");
  specimen.contact.rolling = beta > 0 && eta > 0;
  if (specimen.contact.rolling) {
    material.rolling_stiffness = beta;
    material.rolling_friction = eta;
  }
  specimen.contact.law = linear ? Law::linear : Law::hertz_mindlin;
  specimen.contact.unload_rescale = false;  // YADE, which writes these files, lets f_t stand on unloading
  specimen.materials = {material};
  try {
    check_parameters(specimen.contact, specimen.damping, specimen.materials);
  } catch (const InputError& error) {
    file.fail(error.what());
  }
}

}  // namespace

Meta read_meta(const std::string& path, Specimen& specimen, bool parameters) {
  const MetaFile file(path);
  Meta meta{};
  const double dimension = file.number("dim");
  if (dimension != 2 && dimension != 3) {
    file.fail("dim = " + exact(dimension) + "; allowed: 2 (discs), 3 (spheres); correct it");
  }
  meta.dimension = int(dimension);
  if (meta.dimension == 2 && file.has("thickness_m")) meta.thickness = file.number("thickness_m");
  for (const char* key : {"hSize", "hSize_columns_are_cell_vectors"}) {
    if (!file.has(key)) continue;
    if (meta.cell) file.fail("both of hSize and hSize_columns_are_cell_vectors are there; allowed: one; remove one");
    meta.cell = file.matrix(key, meta.dimension);
  }
  if (meta.cell && meta.dimension == 2) {
    if (!meta.thickness) file.fail("the key thickness_m is missing; allowed: the slab's thickness in m; add it");
    (*meta.cell)(2, 2) = *meta.thickness;
  }
  meta.reference_pressure = file.number_or_zero("p0_Pa");
  if (meta.reference_pressure < 0) {
    file.fail("p0_Pa = " + exact(meta.reference_pressure) + "; allowed: >= 0 (compression positive); correct it");
  }
  meta.particles = file.count("n_particles");
  meta.contacts = file.count("n_contacts");
  if (parameters) read_parameters(file, specimen);
  return meta;
}

}  // namespace rvelab::io
