// Arrays of a state by name, and the stress in rvelab_info: against each other and against what their definitions say.
#include <map>

#include "tests/abi/host.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::vector<rvelab_array> arrays_of(const Host& host, std::int64_t id) {
  std::int64_t n = 0;
  REQUIRE_OK(rvelab_list_arrays(host.pool, id, 0, nullptr, &n));
  std::vector<rvelab_array> arrays(static_cast<std::size_t>(n));
  for (auto& array : arrays) REQUIRE_OK(rvelab_array_init(&array, sizeof array));
  std::int64_t again = 0;
  REQUIRE_OK(rvelab_list_arrays(host.pool, id, n, arrays.data(), &again));
  REQUIRE(again == n);
  return arrays;
}

/// Entries of an array of doubles, or of integers.
template <class Entry>
std::vector<Entry> read(const Host& host, std::int64_t id, const char* name) {
  std::size_t need = 0;
  REQUIRE_OK(rvelab_get_array(host.pool, id, name, nullptr, 0, &need));
  std::vector<Entry> entries(need / sizeof(Entry));
  REQUIRE_OK(rvelab_get_array(host.pool, id, name, entries.data(), need, &need));
  return entries;
}
std::vector<Vector3> vectors(const Host& host, std::int64_t id, const char* name) {
  const auto entries = read<double>(host, id, name);
  std::vector<Vector3> rows;
  for (std::size_t k = 0; k < entries.size(); k += 3) rows.emplace_back(entries[k], entries[k + 1], entries[k + 2]);
  return rows;
}

Matrix3 tensor(const double* entries) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(entries);
}

/// Sheared, so that its frame is turned against the laboratory.
std::int64_t sheared(Host& host, Shape shape) {
  const auto ids = host.spawn(packed(shape, shape == Shape::sphere ? 4 : 6));
  for (int k = 0; k < 5; ++k) host.apply(ids[0], Nine{0, 2e-3, 0, -1e-3});
  return ids[0];
}

}  // namespace

TEST_CASE("info tells the stress of the committed state and its parts as trials return them") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Host host;
    const auto ids = host.spawn(packed(shape, shape == Shape::sphere ? 4 : 6));
    CHECK(host.info(ids[0]).error_estimate == 0);
    for (const double dt : {0.0, 1e-3}) {
      Trials trials(ids);
      trials.ask_for_all();
      trials.dH[0] = Nine{-1e-3, 2e-4};
      trials.batch.dt = dt;
      const rvelab_info before = host.info(ids[0]);
      REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
      CHECK(std::memcmp(host.info(ids[0]).sigma, before.sigma, sizeof before.sigma) == 0);  // of the committed state
      REQUIRE_OK(rvelab_commit(host.pool, 1, ids.data()));
      const rvelab_info after = host.info(ids[0]);
      CHECK(std::memcmp(after.sigma, trials.sigma[0].data(), sizeof after.sigma) == 0);
      CHECK(std::memcmp(after.contact, trials.contact[0].data(), sizeof after.contact) == 0);
      CHECK(std::memcmp(after.reynolds, trials.reynolds[0].data(), sizeof after.reynolds) == 0);
      CHECK(after.error_estimate == trials.error_estimate[0]);
      CHECK((after.error_estimate > 0) == (dt == 0));
      CHECK((tensor(after.reynolds).norm() > 0) == (dt > 0));
      CHECK((tensor(after.contact) + tensor(after.reynolds) - tensor(after.sigma)).norm() < 1e-12 * after.p);
    }
  }
}

TEST_CASE("the error estimate of the committed state comes with its snapshot, its clone and a pool file") {
  const Folder folder;
  Host host;
  const std::int64_t id = sheared(host, Shape::disc);
  const double estimate = host.info(id).error_estimate;
  REQUIRE(estimate > 0);
  std::int64_t clone = 0;
  REQUIRE_OK(rvelab_clone(host.pool, id, &clone));
  CHECK(host.info(clone).error_estimate == estimate);
  const auto bytes = host.snapshot(id);
  host.apply(clone, Nine{1e-3});
  REQUIRE_OK(rvelab_snapshot_load(host.pool, clone, bytes.data(), bytes.size()));
  CHECK(host.info(clone).error_estimate == estimate);
  REQUIRE_OK(rvelab_pool_write(host.pool, (folder / "pool.h5").c_str()));
  Host other;
  REQUIRE_OK(rvelab_pool_read(other.pool, (folder / "pool.h5").c_str()));
  CHECK(other.info(id).error_estimate == estimate);
}

TEST_CASE("contacts and grains read by name make the stress, the fabric and the coordination of the cell") {
  for (const Shape shape : {Shape::disc, Shape::sphere, Shape::ellipse}) {
    CAPTURE(int(shape));
    Host host;
    const std::int64_t id = sheared(host, shape);
    const rvelab_info info = host.info(id);
    const auto branch = vectors(host, id, "contacts/branch_m"), force = vectors(host, id, "contacts/force_N"),
               normal = vectors(host, id, "contacts/normal"),
               tangential = vectors(host, id, "contacts/tangential_force_N"),
               position = vectors(host, id, "grains/position_m");
    const auto i = read<std::int64_t>(host, id, "contacts/i"), j = read<std::int64_t>(host, id, "contacts/j"),
               image = read<std::int64_t>(host, id, "contacts/image");
    const auto pressing = read<double>(host, id, "contacts/normal_force_N"),
               overlap = read<double>(host, id, "contacts/overlap_m"),
               stiffness = read<double>(host, id, "contacts/normal_stiffness_N_m");
    REQUIRE(force.size() == std::size_t(info.contacts));
    REQUIRE(position.size() == std::size_t(info.grains));
    const Matrix3 lattice = tensor(info.rotation) * tensor(info.lattice);
    Matrix3 stress = Matrix3::Zero(), fabric = Matrix3::Zero();
    std::vector<Vector3> resultant(position.size(), Vector3::Zero());
    for (std::size_t k = 0; k < force.size(); ++k) {
      stress -= force[k] * branch[k].transpose() / info.volume;  // Love and Weber; tension positive
      fabric += normal[k] * normal[k].transpose() / double(force.size());
      resultant[std::size_t(j[k])] += force[k];
      resultant[std::size_t(i[k])] -= force[k];
      const Vector3 shift(double(image[3 * k]), double(image[3 * k + 1]), double(image[3 * k + 2]));
      const Vector3 apart = position[std::size_t(j[k])] + lattice * shift - position[std::size_t(i[k])];
      CHECK((apart - branch[k]).norm() < 1e-12 * branch[k].norm());
      CHECK((pressing[k] * normal[k] + tangential[k] - force[k]).norm() < 1e-12 * force[k].norm());
      CHECK(std::abs(tangential[k].dot(normal[k])) < 1e-9 * force[k].norm());
      CHECK(pressing[k] == Approx(stiffness[k] * overlap[k]));  // linear springs, no damping at rest
      CHECK(i[k] <= j[k]);
    }
    CHECK((stress - tensor(info.contact)).norm() < 1e-10 * info.p);
    CHECK((fabric - tensor(info.fabric)).norm() < 1e-12);
    CHECK((fabric - tensor(read<double>(host, id, "fabric").data())).norm() < 1e-12);
    const auto told = vectors(host, id, "grains/resultant_N");
    double largest = 0;
    for (const auto& each : force) largest = std::max(largest, each.norm());
    for (std::size_t k = 0; k < told.size(); ++k) CHECK((told[k] - resultant[k]).norm() < 1e-9 * largest);
    CHECK(read<double>(host, id, "coordination_number").at(0) == 2.0 * double(info.contacts) / double(info.grains));
    double solids = 0;
    const double pi = 3.14159265358979323846;
    for (const double r : read<double>(host, id, "grains/radius_m"))
      solids += info.dimension == 2 ? pi * r * r : 4 * pi / 3 * r * r * r;
    if (info.dimension == 3) CHECK(read<double>(host, id, "void_ratio").at(0) == Approx(info.volume / solids - 1));
    for (const double mass : read<double>(host, id, "grains/mass_kg")) CHECK(mass > 0);
    for (const auto& each : vectors(host, id, "grains/velocity_m_s")) CHECK(each.isZero(0));  // dt = 0: scaled masses
    std::vector<std::int64_t> ids = read<std::int64_t>(host, id, "grains/id");
    CHECK(std::is_sorted(ids.begin(), ids.end()));
  }
}

TEST_CASE("the list of arrays tells type, extent, unit and owner of each, and only lengths that a shape has") {
  for (const Shape shape : {Shape::disc, Shape::ellipse}) {
    Host host;
    const std::int64_t id = sheared(host, shape);
    const rvelab_info info = host.info(id);
    std::map<std::string, rvelab_array> by_name;
    for (const auto& array : arrays_of(host, id)) {
      by_name[array.name] = array;
      CAPTURE(array.name);
      const std::int64_t rows = array.of == RVELAB_OF_CELL       ? 1
                                : array.of == RVELAB_OF_GRAINS   ? info.grains
                                : array.of == RVELAB_OF_CONTACTS ? info.contacts
                                                                 : 0;  // without bonds and water
      CHECK(array.rows == rows);
      CHECK((array.columns == 1 || array.columns == 3 || array.columns == 9));
      CHECK(std::string(array.unit).size() > 0);
      CHECK(read<double>(host, id, array.name).size() == std::size_t(array.rows * array.columns));
    }
    CHECK(by_name.at("contacts/image").type == RVELAB_INT64);
    CHECK(by_name.at("grains/position_m").type == RVELAB_DOUBLE);
    CHECK(std::string(by_name.at("contacts/force_N").unit) == "N");
    CHECK(by_name.count("grains/orientation") == (shape == Shape::ellipse));
    CHECK(by_name.count("semi_major_m") == 0);
    CHECK(by_name.count("grains/semi_major_m") == (shape == Shape::ellipse));
  }
}

TEST_CASE("arrays that there are not, buffers that are small and structs of other sizes are refused") {
  Host host;
  const std::int64_t id = sheared(host, Shape::disc);
  std::size_t need = 0;
  CHECK_STATUS(rvelab_get_array(host.pool, id, "grains/radius", nullptr, 0, &need), RVELAB_E_INPUT);
  CHECK_THAT(rvelab_last_error(), Contains("\"grains/radius\"") && Contains("grains/radius_m"));
  CHECK_STATUS(rvelab_get_array(host.pool, id, "grains/semi_major_m", nullptr, 0, &need), RVELAB_E_INPUT);
  CHECK_STATUS(rvelab_get_array(host.pool, id, nullptr, nullptr, 0, &need), RVELAB_E_NULL);
  CHECK_STATUS(rvelab_get_array(host.pool, id, "grains/radius_m", nullptr, 0, nullptr), RVELAB_E_NULL);
  CHECK_STATUS(rvelab_get_array(host.pool, 0, "grains/radius_m", nullptr, 0, &need), RVELAB_E_ID);
  double few[2] = {7, 7};
  CHECK_STATUS(rvelab_get_array(host.pool, id, "grains/radius_m", few, sizeof few, &need), RVELAB_E_BUFFER);
  CHECK(need == 8 * std::size_t(host.info(id).grains));
  CHECK((few[0] == 7 && few[1] == 7));
  std::int64_t n = -1;
  rvelab_array two[2];
  REQUIRE_OK(rvelab_array_init(&two[0], sizeof two[0]));
  two[1].struct_size = 8;
  two[1].flags = 0;
  CHECK_STATUS(rvelab_list_arrays(host.pool, id, 2, two, &n), RVELAB_E_INPUT);
  CHECK_STATUS(rvelab_list_arrays(host.pool, id, -1, two, &n), RVELAB_E_INPUT);
  CHECK(n == -1);
  REQUIRE_OK(rvelab_array_init(&two[1], sizeof two[1]));
  REQUIRE_OK(rvelab_list_arrays(host.pool, id, 2, two, &n));
  CHECK(n > 2);
  CHECK(std::string(two[1].name) != two[0].name);
}
