// Memory that runs out at any request, of `new` and of malloc, in a host of its own (memory_host.cpp).
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/abi/host.hpp"
#include "tests/abi/shell.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their runtimes allocate themselves

namespace {

/// What the host prints of these calls on RVEs of `start`. RVELAB_MEMORY_STRIDE=1: without any one request.
std::string told(const Specimen& start, int workers, int stride, const std::string& calls) {
  const Folder folder;
  const char* const given = std::getenv("RVELAB_MEMORY_STRIDE");
  io::write_specimen(start, folder / "s.h5");
  return output_of("LD_PRELOAD=" RVELAB_MEMORY_SHIM " '" RVELAB_MEMORY_HOST "' '" + folder.path() + "' '" +
                   (folder / "s.h5") + "' " + std::to_string(workers) + " " +
                   (given != nullptr ? given : std::to_string(stride)) + " " + calls);
}

/// Hertz-Mindlin, whose last root overlaps are a state too.
Specimen hertzian(Shape shape, int side) {
  Material material;
  material.friction = 0.4;
  material.young_modulus = 1e8;
  material.poisson_ratio = 0.2;
  Rve rve(disordered(shape, side, material, Law::hertz_mindlin, 0.515, 2));
  rve.relax(1e-4, 100'000);
  rve.take_as_reference();
  return rve.specimen();
}

}  // namespace

TEST_CASE("Without memory at any one request, or from it on, every call is refused and leaves all bits as they were") {
  struct Case {
    Specimen start;
    int workers, stride;
  };
  for (const Case& each : {Case{packed(Shape::disc, 4), 1, 31}, Case{packed(Shape::disc, 4), 2, 97},
                           Case{hertzian(Shape::sphere, 3), 1, 199}, Case{hertzian(Shape::ellipse, 4), 1, 97}}) {
    const std::string found = told(each.start, each.workers, each.stride, "all");
    CAPTURE(found);
    CHECK_THAT(found, !Contains("WRONG") && Contains("trial from tokens: ") && Contains("snapshot_load: "));
    CHECK(found.substr(found.size() - 2) == "\n0");
  }
}

TEST_CASE("Mixed targets, relaxation and arrays are refused whole without each single request for memory") {
  for (const char* call : {"apply_mixed", "relax", "list_arrays", "get_array"}) {
    const std::string found = told(packed(Shape::disc, 4), 1, 1, call);
    CAPTURE(found);
    CHECK_THAT(found, !Contains("WRONG") && Contains(std::string(call) + ": "));
    CHECK(found.substr(found.size() - 2) == "\n0");
  }
}

TEST_CASE("Without memory at any one request, or from it on, files are read and written whole or not at all") {
  const std::string found = told(packed(Shape::disc, 4), 1, 61, "file");
  CAPTURE(found);
  CHECK_THAT(found, !Contains("WRONG") && Contains("template_load: ") && Contains("set_parameters: ") &&
                        Contains("pool_read: "));
  CHECK(found.substr(found.size() - 2) == "\n0");
}

#endif
