// What `run` and `calibrate` share: the specimens that a protocol runs on, and the folder that results go to.
#pragma once

#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"

namespace rvelab::cli {

/// Reads the specimens named on the command line; without any, the protocol's own ([specimen] file, relative to the
/// protocol's folder). InputError if there is none.
std::vector<Specimen> specimens_for(const Protocol& protocol, const std::vector<std::string>& files);

/// InputError unless the folder that a file is to be written to is there: said before the work, not after it.
void expect_folder_of(const std::string& file);

}  // namespace rvelab::cli
