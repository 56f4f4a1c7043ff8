// A law that one file and a word added (soft_coat.hpp) has what all have: reach, a scalar and a vector that turn,
// files, trials, restarts, records, a stage with its keys.
#include <filesystem>

#include "rvelab/interaction/soft_coat.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/probe.hpp"
#include "rvelab/measure/tangent.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/interaction/bonded.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double coat_stiffness = 500, coat_reach = 3e-4;

/// Sheared a little, so that some pairs are apart within their reach, and at rest.
Rve coated(Shape shape) {
  const int side = dimension_of(shape) == 2 ? 9 : 5;  // discs from an even square turn like gears
  Rve rve = at_rest(disordered(shape, side, linear_material(2e4, 1e4, 0.4), Law::linear_stiffness, 0.51, 4), 1e-8);
  set_settings<SoftCoat>(rve, {{coat_stiffness, coat_reach}});
  for (int k = 0; k < 6; ++k) rve.apply(gradient(1e-3, 2e-3, 0, 1e-3), 0);
  REQUIRE(rve.relax(1e-10, 2'000'000).target_held);
  return rve;
}

}  // namespace

TEST_CASE("coats: every pair within reach repels by the law", "[new_law]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Rve rve = coated(shape);
    const Network net = rve.network();
    std::size_t apart = 0;
    for (const InteractionState& pair : net.interactions) {
      CHECK(-pair.overlap < coat_reach);
      CHECK(pair.normal_force == Approx(coat_stiffness * (coat_reach + pair.overlap)).epsilon(1e-9));
      apart += pair.overlap < 0;
    }
    CHECK(apart > 0);
    CHECK(net.interactions.size() > net.contacts.size());
  }
}

TEST_CASE("coats: trials, restarts, files and the tangent are as for all laws", "[new_law]") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    INFO(name(shape));
    const Rve start = coated(shape);
    Rve undisturbed(start), restarted(start), tried(start);
    const Matrix3 move = gradient(1e-3, 5e-2, 5e-3, 1e-3);
    const std::string file = (std::filesystem::temp_directory_path() / "rvelab_coats.h5").string();
    for (int k = 0; k < 40; ++k) {  // the lattice is reduced on the way
      const Matrix3 sigma = undisturbed.apply(move, 0).stress;
      io::write_specimen(restarted.specimen(), file);
      restarted = Rve(io::read_specimen(file));
      REQUIRE(same_bits(restarted.apply(move, 0).stress, sigma));
      tried.attempt(-0.5 * move, 0);
      tried.revert();
      REQUIRE(same_bits(tried.apply(move, 0).stress, sigma));
    }
    std::filesystem::remove(file);
    CHECK(tried.save() == undisturbed.save());
    CHECK(largest(interaction_stress(undisturbed.network(), SoftCoat::family)) > 0);
    Rve resting = coated(shape);
    const Eigen::MatrixXd tangent = elastic_tangent(resting.network()),
                          measured = probe_stiffness(resting, 1e-9).stiffness;
    CHECK((tangent - measured).norm() < 5e-3 * measured.norm());
  }
}

TEST_CASE("coats: the stage of their settings, and its refusals", "[new_law]") {
  const auto with = [](const std::string& keys) {
    return protocol::parse_protocol(
        "[test]\nname = \"coats\"\ndimension = 2\npressure_Pa = 1e3\n[[stage]]\nkind = \"coat\"\n" + keys,
        "coats.toml");
  };
  CHECK_THROWS_WITH(with("reach_m = 1e-5\n"), Catch::Contains("stiffness_N_m and reach_m above 0"));
  const Rve bare =
      at_rest(disordered(Shape::disc, 8, linear_material(2e4, 1e4, 0.4), Law::linear_stiffness, 0.51, 4), 1e-8);
  const auto run = protocol::run_protocol(with("stiffness_N_m = 500\nreach_m = 4e-5\n"), bare.specimen(), {});
  CHECK(static_cast<const ListOf<SoftCoat>&>(run.end_state).settings.size() == 1);
}
