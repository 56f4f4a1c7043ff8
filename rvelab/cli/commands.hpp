// The subcommands of the program `rvelab`, each in a file of its own. A new one is its file, a line here and a line in
// main.cpp.
#pragma once

#include "rvelab/cli/command.hpp"

namespace rvelab::cli {

Command import_command();
Command pack_command();
Command inspect_command();
Command probe_command();
Command run_command();
Command recover_command();
Command seal_command();
Command calibrate_command();
Command study_command();
Command report_command();
Command compare_command();
Command export_command();
Command keys_command();
Command protocols_command();
Command bench_command();

}  // namespace rvelab::cli
