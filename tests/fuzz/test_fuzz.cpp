// Damaged and odd inputs of every format that rvelab reads: each is taken or refused, and nothing else happens.
//
// RVELAB_FUZZ_SECONDS=3600 build/release/bin/test_fuzz spends so many seconds on each format; without it each gets a
// fixed number of inputs. Findings are kept in RVELAB_FUZZ_FINDINGS, or in the folder for temporary files.
// RVELAB_FUZZ_INPUT=FILE build/release/bin/test_fuzz "damaged snapshots*" shows one of them to its format, in this
// process.
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>

#include "tests/catch.hpp"
#include "tests/fuzz/driver.hpp"
#include "tests/io/random_specimen.hpp"

using namespace rvelab::fuzz;

namespace {

std::string folder_of_findings() {
  const char* const given = std::getenv("RVELAB_FUZZ_FINDINGS");
  const std::string folder =
      given != nullptr ? given : (std::filesystem::temp_directory_path() / "rvelab-fuzz").string();
  std::filesystem::create_directories(folder);
  return folder;
}

const Format& format_named(const std::string& name) {
  for (const Format& format : formats()) {
    if (format.name == name) return format;
  }
  throw std::runtime_error("no format " + name);
}

/// `mutations`: some two seconds' worth.
void expect_no_finding(const std::string& name, std::uint64_t mutations) {
  const Format& format = format_named(name);
  if (const char* const input = std::getenv("RVELAB_FUZZ_INPUT")) {
    const std::string text = rvelab::test::bytes_of(input);
    CHECK_NOTHROW(format.check(std::as_bytes(std::span(text))));
    return;
  }
  const char* const given = std::getenv("RVELAB_FUZZ_SECONDS");
  const Tally tally = run(format, mutations, given != nullptr ? std::atof(given) : 0, folder_of_findings());
  if (given != nullptr) {
    std::cout << std::left << std::setw(16) << name << std::right << std::setw(10) << tally.executions << " inputs in "
              << std::setw(6) << std::lround(tally.seconds) << " s, " << std::setw(9) << tally.taken << " taken, "
              << std::setw(9) << tally.refused << " refused, " << tally.findings.size() << " findings" << std::endl;
    for (const Finding& finding : tally.findings)
      std::cout << "  " << finding.file << ": " << finding.what << std::endl;
  }
  for (const Finding& finding : tally.findings) {
    UNSCOPED_INFO(finding.file << ": " << finding.what);
  }
  CHECK(tally.findings.empty());
  CHECK(tally.taken > 0);
  CHECK(tally.refused > 0);
  CHECK(tally.executions == tally.taken + tally.refused + tally.findings.size());
}

}  // namespace

TEST_CASE("damaged protocols are taken or refused") { expect_no_finding("protocol", 5000); }
TEST_CASE("damaged recipes are taken or refused") { expect_no_finding("recipe", 4000); }
TEST_CASE("damaged material files are taken or refused") { expect_no_finding("material", 5000); }
TEST_CASE("damaged tables of grains and contacts are taken or refused") { expect_no_finding("csv", 5000); }
TEST_CASE("damaged dumps are taken whole or refused") { expect_no_finding("dump", 4000); }
TEST_CASE("damaged data files of LAMMPS are taken whole or refused") { expect_no_finding("data", 4000); }
TEST_CASE("damaged tables of YADE and spreadsheets are taken or refused") { expect_no_finding("text", 4000); }
TEST_CASE("damaged files packed by gzip are taken or refused") { expect_no_finding("gz", 3000); }
TEST_CASE("damaged measured curves are taken or refused") { expect_no_finding("curve", 20000); }
TEST_CASE("damaged specimen files are taken or refused") { expect_no_finding("specimen", 100); }
TEST_CASE("specimens with other values and a seal are taken or refused") { expect_no_finding("specimen_values", 200); }
TEST_CASE("damaged record files are taken or refused") { expect_no_finding("records", 100); }
TEST_CASE("records with other values and a seal are taken or refused") { expect_no_finding("records_values", 60); }
TEST_CASE("damaged journals are taken or refused") { expect_no_finding("journal", 100); }
TEST_CASE("journals with other values and checksums are taken or refused") { expect_no_finding("journal_values", 50); }
TEST_CASE("damaged snapshots are taken or refused") { expect_no_finding("snapshot", 8000); }
TEST_CASE("damaged specimen files with a seal that fits are taken or refused") { expect_no_finding("crafted", 400); }
