// Inputs to begin with: files of tests/data, the protocols that are shipped, and tests/fuzz/corpus, where what was once
// a finding stays.
#pragma once

#include <string>
#include <vector>

#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/fuzz/formats.hpp"

namespace rvelab::fuzz {

/// Path of a file in tests/data.
std::string data_file(const std::string& name);

/// Files of nine discs, sealed.
Bytes specimen_seed();
/// The same with bonds, some of them broken, and bridges of water.
Bytes cemented_seed();
Bytes record_seed();
io::RecordedTest seed_records();  ///< its checkpoint is of cemented, moist discs

/// Particles, contacts and META.json of one text; at least one part.
std::vector<std::string> csv_parts(const std::string& text);

std::vector<Bytes> protocol_seeds();
std::vector<Bytes> recipe_seeds();
std::vector<Bytes> material_seeds();
std::vector<Bytes> csv_seeds();
std::vector<Bytes> dump_seeds();
std::vector<Bytes> data_seeds();
std::vector<Bytes> text_seeds();
/// Those of the three before, which the check packs.
std::vector<Bytes> gz_seeds();
std::vector<Bytes> curve_seeds();
std::vector<Bytes> specimen_seeds();
/// The bytes of a specimen file before its seal.
std::vector<Bytes> crafted_seeds();
std::vector<Bytes> record_seeds();
std::vector<Bytes> journal_seeds();
std::vector<Bytes> snapshot_seeds();
/// For formats that are choices: none, and each first choice.
std::vector<Bytes> choice_seeds();

}  // namespace rvelab::fuzz
