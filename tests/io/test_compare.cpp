// "Bitwise the same" has one meaning: what compare_files finds no difference in.
#include "rvelab/io/hdf5/specimen_file.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// What compare_files says of two files of one dataset /d each; "" if they are equal.
std::string between(const std::vector<double>& a, const std::vector<double>& b, const io::Shape64& shape) {
  const Folder folder;
  io::publish(folder / "a.h5", [&](io::Hdf5File& file) { file.write<double>("/d", a, shape, "m"); });
  io::publish(folder / "b.h5", [&](io::Hdf5File& file) { file.write<double>("/d", b, shape, "m"); });
  return test::first_difference(folder / "a.h5", folder / "b.h5").value_or("");
}

}  // namespace

TEST_CASE("files of the same content are equal, whatever their provenance says") {
  const Folder folder;
  records::TestResult result = random_result(1);
  test::write_records(result, random_specimen(1), "one", folder / "a.h5");
  result.wall_seconds = 3;
  test::write_records(result, random_specimen(1), "another", folder / "b.h5");
  const auto same = io::compare_files(folder / "a.h5", folder / "b.h5");
  CHECK(!same.difference);
  std::size_t datasets = 0;
  for (const auto& entry : io::Hdf5File::open(folder / "a.h5").entries()) {
    datasets += entry.name.starts_with("/provenance/") ? 0 : 1;
  }
  CHECK(same.datasets == datasets);
  CHECK(datasets > 80);
}

TEST_CASE("every field of a specimen counts, down to its last bit") {
  const Folder folder;
  const Specimen specimen = random_specimen(2);
  io::write_specimen(specimen, folder / "a.h5");
  const auto difference = [&](const Specimen& changed) {
    io::write_specimen(changed, folder / "b.h5");
    return test::first_difference(folder / "a.h5", folder / "b.h5").value_or("");
  };
  CHECK(difference(specimen).empty());
  const auto one_bit = [](double& value) { value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1); };
  Specimen changed = specimen;
  one_bit(changed.grains.position[3][1]);
  CHECK_THAT(difference(changed), Contains("/grains/position_m[3, 1] differs"));
  changed = specimen;
  one_bit(changed.state.last_step.length);
  CHECK_THAT(difference(changed), Contains("/state/last_step/length differs"));
  changed = specimen;
  changed.materials[1].name += "x";
  CHECK_THAT(difference(changed), Contains("/materials/name[1] differs"));
  changed = specimen;
  changed.contacts.pop_back();
  CHECK_THAT(difference(changed), Contains("/contacts/") && Contains("another shape") && Contains("(30"));
}

TEST_CASE("the first difference is named with its index and both values") {
  CHECK(between({1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}, {2, 3}).empty());
  CHECK_THAT(between({1, 2, 3, 4, 0.1, 6}, {1, 2, 3, 4, 0.25, 7}, {2, 3}),
             Contains("/d[1, 1] differs: 0.1 in ") && Contains("a.h5, 0.25 in "));
  CHECK_THAT(between({1}, {2}, {}), Contains("/d differs: 1 in"));
  CHECK_THAT(between({0.0}, {-0.0}, {1}), Contains("/d[0] differs: 0 in ") && Contains("-0 in "));
}

TEST_CASE("NaNs of the same bits are equal, others are told apart by their bits") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double other = std::bit_cast<double>(std::bit_cast<std::uint64_t>(nan) | 5);
  CHECK(between({1, nan}, {1, nan}, {2}).empty());
  CHECK_THAT(between({1, nan}, {1, other}, {2}),
             Contains("/d[1] differs: nan (0x7ff8000000000000)") && Contains("nan (0x7ff8000000000005)"));
}

TEST_CASE("names, kinds, types, shapes and attributes count too") {
  const Folder folder;
  const double number = 1;
  const std::int32_t whole = 1;
  const auto difference = [&](auto fill_a, auto fill_b) {
    io::publish(folder / "a.h5", fill_a);
    io::publish(folder / "b.h5", fill_b);
    const auto forth = test::first_difference(folder / "a.h5", folder / "b.h5");
    CHECK(forth.has_value() == test::first_difference(folder / "b.h5", folder / "a.h5").has_value());
    return forth.value_or("");
  };
  const auto plain = [&](io::Hdf5File& file) { file.write<double>("/g/d", {&number, 1}, {}, "m"); };
  CHECK(difference(plain, plain).empty());
  CHECK_THAT(difference(plain,
                        [&](io::Hdf5File& file) {
                          plain(file);
                          file.write<double>("/g/e", {&number, 1}, {}, "m");
                        }),
             Contains("/g/e is in") && Contains("b.h5 only"));
  CHECK_THAT(difference(plain,
                        [&](io::Hdf5File& file) {
                          file.write<double>("/g", {&number, 1}, {}, "m");
                        }),
             Contains("/g is a group in") && Contains("a dataset in"));
  CHECK_THAT(difference(plain,
                        [&](io::Hdf5File& file) {
                          file.write<double>("/g/d", {&number, 1}, {}, "mm");
                        }),
             Contains("attribute units of /g/d differs: \"m\" in"));
  CHECK_THAT(difference(plain,
                        [&](io::Hdf5File& file) {
                          file.write<double>("/g/d", {&number, 1}, {1}, "m");
                        }),
             Contains("another shape: () in") && Contains("(1) in"));
  CHECK_THAT(difference(plain,
                        [&](io::Hdf5File& file) {
                          file.write<std::int32_t>("/g/d", {&whole, 1}, {}, "m");
                        }),
             Contains("another type: float64 in") && Contains("int32 in"));
  CHECK_THAT(difference(plain,
                        [&](io::Hdf5File& file) {
                          plain(file);
                          file.set_attribute("complete", "1");
                        }),
             Contains("attribute complete of / is in") && Contains("b.h5 only"));
}

TEST_CASE("what is no HDF5 file cannot be compared") {
  const Folder folder;
  write_bytes(folder / "a.h5", "text");
  CHECK_THAT(input_error([&] { test::first_difference(folder / "a.h5", folder / "b.h5"); }),
             Contains("not an HDF5 file"));
}
