// The path of this program, and of the files installed with it.
#pragma once

#include <filesystem>

namespace rvelab::cli {

/// The file of this program, with links resolved: from /proc/self/exe; if /proc is not mounted (a chroot), from the
/// executed path in the auxiliary vector. Empty if neither leads to a file.
std::filesystem::path program_file();

/// A folder of share/rvelab, which is beside the folder of the program in the build and in every installation. Throws
/// Error with a remedy if the path of the program is unknown.
std::filesystem::path shared_folder(const std::filesystem::path& name);

}  // namespace rvelab::cli
