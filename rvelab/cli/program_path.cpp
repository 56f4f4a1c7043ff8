#include "rvelab/cli/program_path.hpp"

#include <sys/auxv.h>

#include <system_error>

#include "rvelab/error.hpp"

namespace rvelab::cli {

namespace fs = std::filesystem;

fs::path program_file() {
  std::error_code unknown;
  if (fs::path program = fs::read_symlink("/proc/self/exe", unknown); !unknown) return program;
  const auto* executed = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  if (executed == nullptr) return {};
  fs::path program = fs::canonical(executed, unknown);
  return unknown ? fs::path() : program;
}

fs::path shared_folder(const fs::path& name) {
  const fs::path program = program_file();
  if (program.empty())
    throw Error(
        "/proc is not mounted and the path of this program is unknown, so the files installed with it "
        "(../share/rvelab) cannot be found; mount /proc, or give files instead of names");
  return program.parent_path().parent_path() / "share/rvelab" / name;
}

}  // namespace rvelab::cli
