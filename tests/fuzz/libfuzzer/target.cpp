// One format as a target of libFuzzer, built with -D RVELAB_FORMAT="name". If the first folder that is given for its
// corpus is empty, it is filled with the seeds.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>

#include "tests/fuzz/formats.hpp"
#include "tests/fuzz/mutate.hpp"

using namespace rvelab::fuzz;

namespace {

const Format& target() {
  static const Format& found = []() -> const Format& {
    for (const Format& format : formats()) {
      if (format.name == RVELAB_FORMAT) return format;
    }
    std::abort();
  }();
  return found;
}

const std::vector<Bytes>& seeds() {
  static const std::vector<Bytes> all = target().seeds();
  return all;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int k = 1; k < *argc; ++k) {
    const std::string folder = (*argv)[k];
    if (folder.starts_with("-")) continue;
    if (!std::filesystem::is_directory(folder) || !std::filesystem::is_empty(folder)) break;
    for (std::size_t seed = 0; seed < seeds().size(); ++seed) {
      std::ofstream(folder + "/seed_" + std::to_string(seed), std::ios::binary)
          .write(reinterpret_cast<const char*>(seeds()[seed].data()),
                 static_cast<std::streamsize>(seeds()[seed].size()));
    }
    break;
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target().check(std::as_bytes(std::span(data, size)));
  return 0;
}

/// Half of the changes are those of the plain driver, which knows lines and numbers.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  std::mt19937_64 random(seed);
  if (random() % 2 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const View given = std::as_bytes(std::span(data, size));
  Bytes input(given.begin(), given.end());
  change(input, seeds(), target().is_text, random);
  if (input.size() > max_size) input.resize(max_size);
  std::copy(input.begin(), input.end(), reinterpret_cast<std::byte*>(data));
  return input.size();
}
