// librvelab.so as a host finds it: what it exports and needs, a host of an older version, installation and the example.
#include <regex>
#include <set>
#include <sstream>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/abi/host.hpp"
#include "tests/abi/shell.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

TEST_CASE("librvelab.so exports the functions that its header declares, and one for librvelab-mpi.so") {
  std::set<std::string> names, declared{"rvelab_rank_calls"};
  std::istringstream lines(output_of("nm -D --defined-only --format=posix " RVELAB_LIBRARY));
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find_first_of(" @"));
    if (line.find(" A ") == std::string::npos && line != "0" && !name.empty()) names.insert(name);
  }
  const std::string header = bytes_of(RVELAB_SOURCE_DIR "/include/rvelab/rvelab.h");
  const std::regex function("\n(?:int32_t|int64_t|const char\\*) (rvelab_[a-z_]+)\\(");
  for (std::sregex_iterator at(header.begin(), header.end(), function), end; at != end; ++at) declared.insert((*at)[1]);
  CHECK(declared.size() > 20);
  CHECK(names == declared);
  const std::string files = output_of("nm -D --defined-only --format=posix " RVELAB_H5_LIBRARY);
  CHECK_THAT(files, Contains("rvelab_h5_file_calls T"));
  std::istringstream exported(files);
  for (std::string name; exported >> name && name != "0"; std::getline(exported, name))  // operator new and delete
    CHECK((name == "rvelab_h5_file_calls" || name.starts_with("_Znwm") || name.starts_with("_ZdlPv")));
}

TEST_CASE("librvelab.so needs no CGAL, MPI or HDF5, and has the name of version 1") {
  const std::string needs = output_of("ldd " RVELAB_LIBRARY), head = output_of("readelf -d " RVELAB_LIBRARY);
  CHECK_THAT(needs, Contains("libc.so") && EndsWith("\n0"));
  for (const char* name : {"hdf5", "mpi", "CGAL", "gmp", "mpfr", "toml", "not found"})
    CHECK_THAT(needs, !Contains(name, Catch::CaseSensitive::No));
  CHECK_THAT(head, Contains("Library soname: [librvelab.so.1]"));
  CHECK_THAT(output_of("readelf -d " RVELAB_H5_LIBRARY), Contains("[libhdf5") && Contains("[librvelab-h5.so.1]"));
}

TEST_CASE("A host compiled with the header of any earlier version runs with the library of today") {
  const Folder folder;
  io::write_specimen(packed(Shape::disc, 5), folder / "s.h5");
  for (const std::string host : {RVELAB_CONSUMERS}) {
    CAPTURE(host);
    CHECK(output_of("'" + host + "' " + (folder / "s.h5")) == "ok\n\n0");
  }
}

TEST_CASE("library, program, build and citation tell one version") {
  const std::string version = rvelab_version();
  CHECK(version == RVELAB_VERSION);  // of the project, as CMake has it
  CHECK(output_of("'" RVELAB_PROGRAM "' --version") == "rvelab " + version + "\n\n0");
  CHECK_THAT(bytes_of(RVELAB_SOURCE_DIR "/CITATION.cff"), Contains("\nversion: " + version + "\n"));
}

TEST_CASE("Installed and moved, the library is found by cmake and by pkg-config, and the example runs") {
  const Folder folder;
  const std::string prefix = folder / "moved here", source = RVELAB_SOURCE_DIR "/tools/examples";
  io::write_specimen(packed(Shape::disc, 5), folder / "s.h5");
  const auto done = [](const std::string& command) {
    const std::string output = output_of(command);
    INFO(command << "\n" << output);
    REQUIRE_THAT(output, EndsWith("\n0"));
    return output;
  };
  done(RVELAB_CMAKE " --install " RVELAB_BUILD " --component library --prefix '" + (folder / "first") + "'");
  std::filesystem::rename(folder / "first", prefix);
  const std::string run = " '" + (folder / "s.h5") + "' 0.004";
  done(RVELAB_CMAKE " -G '" RVELAB_GENERATOR "' -S " + source + " -B '" + (folder / "cmake") +
       "' -D CMAKE_PREFIX_PATH='" + prefix + "' -D CMAKE_C_COMPILER=" RVELAB_C_COMPILER);
  done(RVELAB_CMAKE " --build '" + (folder / "cmake") + "'");
  const std::string by_cmake = done("'" + (folder / "cmake/element_test") + "'" + run);
  const std::string library = std::filesystem::exists(prefix + "/lib/librvelab.so")
                                  ? prefix + "/lib"
                                  : prefix + "/lib/" + output_of("gcc -print-multiarch").substr(0, 16);
  std::filesystem::create_directories(folder / "pkg");
  done("cd '" + (folder / "pkg") + "' && export PKG_CONFIG_PATH='" + library + "/pkgconfig' && eval " +
       RVELAB_C_COMPILER " -std=c11 -pedantic -Wall -Wextra -Werror " + source +
       "/element_test.c $(pkg-config --cflags --libs rvelab) -o element_test");
  const std::string by_pkg_config =
      done("env -u LD_LIBRARY_PATH '" + (folder / "pkg/element_test") + "'" + run);  // by its rpath
  CHECK(by_cmake == by_pkg_config);
  CHECK_THAT(by_cmake, Contains("0.0020 ") && Contains("0.0040 "));

  // The example of README.md, as it stands there.
  std::istringstream readme(bytes_of(RVELAB_SOURCE_DIR "/README.md"));
  std::ofstream example(folder / "pkg/readme.c");
  bool inside = false;
  for (std::string line; std::getline(readme, line);) {
    if (line.starts_with("```"))
      inside = line == "```c";
    else if (inside)
      example << line << "\n";
  }
  example.close();
  std::filesystem::copy_file(folder / "s.h5", folder / "pkg/S.h5");
  done("cd '" + (folder / "pkg") + "' && export PKG_CONFIG_PATH='" + library + "/pkgconfig' && eval " +
       RVELAB_C_COMPILER
       " -std=c11 -pedantic -Wall -Wextra -Werror readme.c "
       "$(pkg-config --cflags --libs rvelab) -o readme");
  CHECK_THAT(done("cd '" + (folder / "pkg") + "' && env -u LD_LIBRARY_PATH ./readme"),
             Contains("sigma_xy = ") && Contains(" Pa"));

  // Without librvelab-h5.so beside it a call for a file says what is missing.
  for (const auto& entry : std::filesystem::directory_iterator(library))
    if (entry.path().filename().string().starts_with("librvelab-h5")) std::filesystem::remove(entry.path());
  const std::string missing = output_of("'" + (folder / "cmake/element_test") + "'" + run);
  CHECK_THAT(missing, Contains("librvelab-h5.so.1") && Contains("LD_LIBRARY_PATH") && !EndsWith("\n0"));
}
