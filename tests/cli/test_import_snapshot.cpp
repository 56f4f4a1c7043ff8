// rvelab import of a snapshot: what goes on from the imported file is what goes on from the state that was saved.
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/program.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A pure shear of the plane.
Matrix3 sheared(double strain) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 0) = strain;
  gradient(1, 1) = -strain;
  return gradient;
}

}  // namespace

TEST_CASE("import of a snapshot goes on to the same bits as the state that was saved") {
  const Workplace here;
  here.import_packing("dense_p20");
  Rve saved(io::read_specimen(here / "S.h5"));
  saved.apply(sheared(1e-3), 0);
  here.write("sheared.rvesnap", text_of(saved.save()));
  here.succeeds("import sheared.rvesnap -o sheared.h5");
  Rve imported(io::read_specimen(here / "sheared.h5"));
  CHECK(imported.save() == saved.save());
  saved.apply(sheared(1e-3), 0);
  imported.apply(sheared(1e-3), 0);
  CHECK(imported.save() == saved.save());
}

TEST_CASE("import refuses a damaged snapshot, and what a snapshot says itself") {
  const Workplace here;
  here.import_packing("dense_p20");
  const std::string whole = text_of(Rve(io::read_specimen(here / "S.h5")).save());
  here.write("cut.rvesnap", whole.substr(0, whole.size() - 1));
  here.refuses("import cut.rvesnap -o X.h5", "cut.rvesnap: snapshot: it has");
  std::string turned = whole;
  turned[whole.size() / 2] = char(turned[whole.size() / 2] ^ 1);
  here.write("turned.rvesnap", turned);
  here.refuses("import turned.rvesnap -o X.h5", "its checksum does not fit its bytes");
  here.write("whole.rvesnap", whole);
  here.refuses("import whole.rvesnap --cell 1,1,1 -o X.h5", "was given with --cell");
  here.refuses("import whole.rvesnap contacts.csv -o X.h5", "was given with contacts.csv");
  here.refuses("import none.rvesnap -o X.h5", "none.rvesnap: no such file");
  CHECK(here.run("import whole.rvesnap -o X.h5").code == 0);
}
