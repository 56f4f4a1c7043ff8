// Packs by a recipe, runs a protocol, and prints the checksum of the state that it ends with: which bits a build gives.
//
//   rvelab-end-state RECIPE.toml PROTOCOL.toml [--recipe KEY=value]... [KEY=value]...   (these are the protocol's)
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/snapshot.hpp"

int main(int count, char** words) {
  using namespace rvelab;
  if (count < 3) {
    std::fputs("usage: rvelab-end-state RECIPE.toml PROTOCOL.toml [--recipe KEY=value]... [KEY=value]...\n", stderr);
    return 2;
  }
  std::vector<std::string> of_recipe, of_protocol;
  for (int k = 3; k < count; ++k) {
    const bool recipe = std::strcmp(words[k], "--recipe") == 0 && k + 1 < count;
    (recipe ? of_recipe : of_protocol).push_back(words[recipe ? ++k : k]);
  }
  try {
    Workers alone(1);
    const Specimen packed = pack::pack(pack::read_recipe(words[1], of_recipe).recipe, alone).specimen;
    const auto told = [](const char* what, const Specimen& specimen) {
      std::printf("%s %016llx\n", what, static_cast<unsigned long long>(snapshot_checksum(to_bytes(specimen))));
    };
    told("packed", packed);
    const protocol::TestRun run = protocol::run_protocol(protocol::read_protocol(words[2], of_protocol), packed);
    told("ended", run.end_state);
    std::printf("records %zu\n", run.result.records.size());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rvelab-end-state: %s\n", error.what());
    return 1;
  }
  return 0;
}
