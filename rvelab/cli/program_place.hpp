// Where this program is, and what was installed with it.
#pragma once

#include <filesystem>

namespace rvelab::cli {

/// The file of this program, links followed: as /proc/self/exe has it; where /proc is not mounted (a chroot), the file
/// that the system was asked to execute, as the auxiliary vector keeps it. Empty if neither leads to a file.
std::filesystem::path program_file();

/// A folder of share/rvelab, which stands beside the folder of the program in the build and in every installation.
/// Throws Error, which says what to do, if it is unknown where the program is.
std::filesystem::path shared_folder(const std::filesystem::path& name);

}  // namespace rvelab::cli
