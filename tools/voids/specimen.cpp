#include "tools/voids/specimen.hpp"

#include <rvelab/rvelab.h>

#include <memory>

#include "rvelab/error.hpp"

namespace rvelab::voids {
namespace {

void expect_ok(std::int32_t status) {
  if (status >= RVELAB_OK) return;
  if (status == RVELAB_E_FILE || status == RVELAB_E_INPUT) throw InputError(rvelab_last_error());
  throw Error(rvelab_last_error());
}

/// One RVE in a separate pool.
class Opened {
 public:
  explicit Opened(const std::string& file) {
    rvelab_pool_def def;
    expect_ok(rvelab_pool_def_init(&def, sizeof def));
    def.workers = 1;
    rvelab_pool* pool = nullptr;
    expect_ok(rvelab_pool_create(&def, &pool));
    pool_.reset(pool);
    std::int64_t of_template = 0;
    expect_ok(rvelab_template_load(pool, file.c_str(), &of_template));
    expect_ok(rvelab_spawn(pool, of_template, 1, &id_));
  }
  rvelab_info info() const {
    rvelab_info found;
    expect_ok(rvelab_info_init(&found, sizeof found));
    expect_ok(rvelab_get_info(pool_.get(), id_, &found));
    return found;
  }
  bool has(const char* name) const {
    std::size_t need = 0;
    return rvelab_get_array(pool_.get(), id_, name, nullptr, 0, &need) >= RVELAB_OK;
  }
  template <class Entry>
  std::vector<Entry> array(const char* name) const {
    std::size_t need = 0;
    expect_ok(rvelab_get_array(pool_.get(), id_, name, nullptr, 0, &need));
    std::vector<Entry> entries(need / sizeof(Entry));
    expect_ok(rvelab_get_array(pool_.get(), id_, name, entries.data(), need, &need));
    return entries;
  }

 private:
  struct Destroy {
    void operator()(rvelab_pool* pool) const { rvelab_pool_destroy(pool); }
  };
  std::unique_ptr<rvelab_pool, Destroy> pool_;
  std::int64_t id_ = 0;
};

Matrix3 matrix_of(const double* entries) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries);
}

}  // namespace

PackedGrains read_grains(const std::string& file) {
  const Opened opened(file);
  if (opened.has("grains/semi_major_m"))
    throw InputError(file +
                     ": the grains are ellipses; power cells are those of discs and spheres, and a cell by the "
                     "circle of its area would cut an ellipse. Give a specimen of discs or spheres");
  if (opened.has("grains/half_x_m"))
    throw InputError(file +
                     ": the grains are superellipsoids; power cells are those of discs and spheres, and a cell by the "
                     "sphere of its volume would cut the grain. Give a specimen of discs or spheres");
  if (opened.has("grains/inertia_tensor_kg_m2"))
    throw InputError(file +
                     ": the grains are clumps; power cells are those of discs and spheres, and would cut members that "
                     "overlap. Give a specimen of discs or spheres");
  const rvelab_info info = opened.info();
  PackedGrains grains{{int(info.dimension), matrix_of(info.lattice)},
                      matrix_of(info.rotation),
                      opened.array<std::int64_t>("grains/id"),
                      {}};
  const auto position = opened.array<double>("grains/position_m"), radius = opened.array<double>("grains/radius_m");
  for (std::size_t k = 0; k < radius.size(); ++k)
    grains.balls.push_back({grains.rotation.transpose() * Eigen::Map<const Vector3>(&position[3 * k]), radius[k]});
  return grains;
}

}  // namespace rvelab::voids
