#include "tools/mpm/app/program.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <rvelab/rvelab.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "rvelab/io/utf8.hpp"
#include "tools/mpm/app/run.hpp"
#include "tools/mpm/output/output.hpp"

namespace mpm {
namespace {

/// The folder of a run, while it is written into: two runs would spoil each other's histories.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    // Where a file system knows no locks, the run goes without.
    if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(descriptor_);
      throw InputError(folder + ": another rvelab-mpm is writing there; wait for it, stop it, or give another folder");
    }
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

std::string toml_of(const toml::table& scene) {
  std::ostringstream text;
  text << scene;
  return text.str();
}

void check(const RunOptions& options) {
  if (options.threads < 0) {
    throw InputError("-j " + std::to_string(options.threads) +
                     ": give a number of threads, or 0 for as many as the processor runs at once");
  }
  if (!(options.stop_at >= 0)) {
    throw InputError("--stop-at " + in_words(options.stop_at) + ": give a time in s, 0 or later");
  }
}

int run(const std::string& scene_file, std::vector<std::string> cases, bool published,
        const std::vector<std::string>& assignments, RunOptions options, const std::string& resumed) {
  const std::filesystem::path folder(resumed.empty() ? options.folder : resumed);
  options.folder = folder.string();
  options.resume = !resumed.empty();
  if (published) cases.emplace_back("published");
  toml::table resolved;
  if (options.resume) {
    const FolderLock lock(options.folder);
    for (const char* name : {"scene.toml", "checkpoint.h5"}) {
      if (std::filesystem::exists(folder / name)) continue;
      throw InputError(options.folder + ": holds no " + name +
                       " to go on from; give the folder of a run, or start one: rvelab-mpm SCENE.toml -o " +
                       options.folder);
    }
    expect_whole_scene(options.folder);
    const auto scene = read_scene((folder / "scene.toml").string(), {}, assignments, &resolved);
    if (!assignments.empty()) options.scene_text = toml_of(resolved);
    return run_scene(scene, options, std::cout);
  }
  const auto scene = read_scene(scene_file, cases, assignments, &resolved);
  std::error_code error;
  if (std::filesystem::exists(folder / "checkpoint.h5")) {
    throw InputError(options.folder + " holds a run already; go on with --resume, or give another folder");
  }
  std::filesystem::create_directories(folder, error);
  const FolderLock lock(options.folder);
  write_scene(options.folder, toml_of(resolved));
  return run_scene(scene, options, std::cout);
}

}  // namespace

int program(int argc, char** argv, const PoolSource& source) {
  CLI::App app{
      "rvelab-mpm: the material point method with granular RVEs as its material\n\n"
      "  rvelab-mpm protocols/mpm/column.toml -o column\n"
      "  rvelab-mpm protocols/mpm/biaxial.toml --case M4 --specimens . -o M4\n"
      "  rvelab-mpm --resume M4\n",
      "rvelab-mpm"};
  app.set_version_flag("--version", std::string("rvelab-mpm ") + rvelab_version());
  std::string scene, resume;
  std::vector<std::string> cases, assignments;
  RunOptions options;
  options.source = source;
  bool published = false;
  auto* file = app.add_option("scene", scene, "Scene in TOML");
  auto* folder = app.add_option("-o,--output", options.folder, "Folder for histories, frames and checkpoints");
  app.add_option("--resume", resume, "Folder of a run to go on with")->excludes(file)->excludes(folder);
  app.add_option("--case", cases, "A case of the scene ([case.NAME]), which overrides its keys; may be given again");
  app.add_flag("--published", published, "The published size: the same as --case published");
  app.add_option("--set", assignments,
                 "table.key=value overrides the scene; [[tables]] by name or number: body.pipe.radius_m=0.4, "
                 "region.0.points_per_cell=9");
  app.add_option("--specimens", options.specimens, "Folder of the specimen files that materials name");
  app.add_option("-j,--threads", options.threads, "Threads; 0: as many as the processor runs at once");
  app.add_option("--stop-at", options.stop_at, "Stop at this time (s) with a checkpoint");
  app.add_flag("-q,--quiet", options.quiet, "No progress line");
  const auto fail = [&](int code, const std::string& message) {
    std::cerr << "rvelab-mpm: " << rvelab::io::message_line(message, {argv + std::min(argc, 1), argv + argc}) << "\n";
    return code;
  };
  try {
    app.parse(argc, argv);
    if (resume.empty() && (scene.empty() || options.folder.empty())) {
      throw InputError("give a scene and a folder (rvelab-mpm SCENE.toml -o FOLDER), or --resume FOLDER");
    }
    check(options);
    return run(scene, cases, published, assignments, options, resume);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return fail(2, error.what() + std::string("; rvelab-mpm --help explains the options"));
  } catch (const InputError& error) {
    return fail(2, error.what());
  } catch (const rvelab::NotStarted& error) {
    return fail(2, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(2, error.path1().string() + ": cannot be used (" + error.code().message() +
                       "); give the path of a file in a folder that you may use");
  } catch (const std::exception& failure) {
    return fail(1, failure.what());
  }
}

}  // namespace mpm
