// rvelab study: a test over a grid of settings, errors against the best-resolved run and against cost.
// Declared in command.hpp.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "rvelab/cli/command.hpp"
#include "rvelab/cli/interrupt.hpp"
#include "rvelab/cli/progress_line.hpp"
#include "rvelab/cli/protocol_input.hpp"
#include "rvelab/cli/recording.hpp"
#include "rvelab/cli/study_report.hpp"
#include "rvelab/cli/warnings.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/keys/regular_file.hpp"

namespace rvelab::cli {

namespace fs = std::filesystem;

namespace {

struct StudyArguments {
  std::string what;  ///< a protocol or a study
  std::vector<std::string> specimens, settings, vary, reference;
  std::string folder;
  std::optional<long> repeats, increments;
  unsigned threads = 0;
  bool force = false, resume = false, json = false;
};

/// A study with all that it was read from.
struct Loaded {
  study::Study study;
  std::string path;  ///< of the protocol, or of the study that holds its text
  std::vector<std::string> inputs;
};

/// The study file, or a new study of a protocol, before the options of the command line are added.
Loaded loaded(const std::string& name) {
  Loaded found;
  const std::string installed = is_path(name) ? "" : installed_in("studies", name);
  const std::string what = installed.empty() ? name : installed;
  if (is_path(what)) {
    const toml::table file = keys::parse_toml_file(what);
    if (study::is_study(file)) {
      found.study = study::read_study(file, what);
      found.inputs.push_back(what);
      for (std::string& specimen : found.study.specimens) specimen = from_folder_of(what, specimen);
    }
  }
  found.path = what;
  if (found.study.protocol_text.empty()) {
    const std::string& named = found.study.protocol;
    found.path = protocol_path(named.empty() ? what : is_path(named) ? from_folder_of(what, named) : named);
    warn_of_units(found.path, protocol::read_protocol(found.path).doubts);  // and its mistakes with their lines
    found.study.protocol_text = keys::whole_file<std::string>(found.path, "a protocol");
    found.inputs.push_back(found.path);
  }
  found.study.protocol.clear();
  return found;
}

/// Options override the study file: a key that is varied there takes the values given here.
void add_options(study::Study& study, const StudyArguments& arguments) {
  const auto append = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
  append(study.settings, arguments.settings);
  append(study.reference, arguments.reference);
  std::vector<std::string> given;
  for (const std::string& text : arguments.vary) {
    const study::Variation one = study::parsed_variation(text);
    if (std::find(given.begin(), given.end(), one.key) != given.end()) {
      throw InputError("--vary " + text + " varies " + one.key +
                       " twice; allowed: each key once; give all its values " + "to one --vary");
    }
    given.push_back(one.key);
    const auto same = [&](const study::Variation& other) { return other.key == one.key; };
    const auto place = std::find_if(study.grid.begin(), study.grid.end(), same);
    if (place != study.grid.end()) {
      *place = one;
    } else {
      study.grid.push_back(one);
    }
  }
  study.repeats = arguments.repeats.value_or(study.repeats);
  study.increments = arguments.increments.value_or(study.increments);
  if (!arguments.specimens.empty()) {
    study.specimens = arguments.specimens;
    study.digests.clear();
  }
  study.made_with = std::string("rvelab ") + io::version;
}

std::vector<Specimen> read_specimens(study::Study& study, const std::string& path) {
  if (study.specimens.empty()) {
    throw InputError(path + ": no specimen is given; allowed: one or more files; write for example rvelab study " +
                     path + " S.h5 ...");
  }
  std::vector<Specimen> specimens;
  std::vector<std::string> digests;
  for (const std::string& file : study.specimens) {
    specimens.push_back(io::read_specimen(file));
    char text[12];
    std::snprintf(text, sizeof text, "%08x", io::digest(specimens.back()));
    digests.emplace_back(text);
    const std::size_t k = digests.size() - 1;
    if (k < study.digests.size() && study.digests[k] != digests[k]) {
      throw InputError(file + ": is not the specimen of " + path + ": its digest is " + digests[k] +
                       "; allowed: " + study.digests[k] +
                       "; give the specimen that the study was made with, or name this one on the "
                       "command line");
    }
  }
  study.digests = digests;
  return specimens;
}

std::optional<StudyFolder> folder_for(const StudyArguments& arguments, const Loaded& from) {
  expect_output_given(arguments.folder, {{"--force", arguments.force}, {"--resume", arguments.resume}}, "folder");
  if (arguments.folder.empty()) {
    if (!arguments.json && isatty(STDERR_FILENO) == 1) tell("the results will not be kept: no -o FOLDER is given");
    return std::nullopt;
  }
  auto inputs = from.inputs;
  inputs.insert(inputs.end(), from.study.specimens.begin(), from.study.specimens.end());
  return StudyFolder(arguments.folder, from.study, if_exists(arguments.force, arguments.resume), inputs);
}

void tell_failures(const study::StudySummary& summary, const study::Study& study) {
  const auto one = [&](const study::PointSummary& point, const std::string& name) {
    if (!point.failure.empty()) tell(name + ": could not be carried out: " + point.failure);
  };
  one(summary.reference, "reference");
  for (std::size_t k = 0; k < summary.points.size(); ++k) {
    one(summary.points[k], study::name_of(study::assignments_at(study.grid, k)));
  }
  if (summary.not_at_rest == 0) return;
  tell(std::to_string(summary.not_at_rest) + " of " + std::to_string(summary.reference.increments) +
       " answers of the reference did not reach an unbalanced ratio of " + in_words(study.relaxation.unbalanced) +
       " in " + std::to_string(study.relaxation.max_steps) +
       " sub-steps (study.relax_unbalanced, study.relax_max_steps)");
}

void run_study(const StudyArguments& arguments) {
  Loaded from = loaded(arguments.what);
  add_options(from.study, arguments);
  const study::Study& study = from.study;
  const auto prepared = study::prepared(study, from.path, read_specimens(from.study, arguments.what));
  const auto folder = folder_for(arguments, from);

  study::Pieces pieces;
  {
    ProgressLine progress(study::planned_pieces(study, prepared), "pieces");
    study::Keeper keeper;
    keeper.threads = arguments.threads;
    keeper.stop = &stop_on_signals();
    keeper.progress = &progress;
    if (folder) {
      keeper.kept = [&](const std::string& name) { return folder->piece(name); };
      keeper.keep = [&](const std::string& name, const study::Piece& piece) { folder->put(name, piece); };
    }
    pieces = study::run_study(study, prepared, keeper);
  }
  if (!pieces.complete)
    end_stopped(" with " + std::to_string(pieces.by_name.size()) + " of " +
                std::to_string(study::planned_pieces(study, prepared)) + " pieces complete; " +
                (folder ? "continue with --resume" : "they are not kept without -o"));
  const auto summary = study::summary_of(study, prepared, pieces);
  const std::string json = json_text(cli::as_json(study, summary));
  if (folder) {
    io::publish_text(folder->file("study.json"), json);
    io::publish_text(folder->file("study.csv"), as_csv(study, summary));
  }
  std::cout << (arguments.json ? json : as_tables(study, summary));
  if (folder && !arguments.json) {
    std::cout << "\nfile    " << folder->file("study.csv")
              << ", study.json\nfigure  /usr/bin/python3 tools/plot/study.py " << arguments.folder << " -o "
              << folder->file("study.png") << "\n";
  }
  std::cout << std::flush;
  tell_failures(summary, study);
}

}  // namespace

void add_study(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("study", "Run a test over a grid of settings: error against run time");
  const auto arguments = std::make_shared<StudyArguments>();
  command
      .add_option(
          "test", arguments->what,
          "PROTOCOL.toml or STUDY.toml, or the name of an installed one:\nbiaxial; tolerance, damping, time_step, "
          "record_density")
      ->required();
  command.add_option("specimen", arguments->specimens, "specimens; default: those of the study");
  command.add_option("--vary", arguments->vary, "KEY=v1,v2,...; given several times: all combinations")
      ->allow_extra_args(false);
  command.add_option("--reference", arguments->reference, "KEY=value of the reference, the best-resolved run")
      ->allow_extra_args(false);
  command.add_option("--set", arguments->settings, "KEY=value of every run")->allow_extra_args(false);
  command
      .add_option("--repeat", arguments->repeats, "whole paths for each grid point and specimen, default 1; 0: none")
      ->check(CLI::Range(0, 10'000));
  command
      .add_option(
          "--increments", arguments->increments,
          "increments for each grid point and specimen, default 300;\neach starts from a state of the reference path; "
          "0: none")
      ->check(CLI::Range(0, 1'000'000));
  command.add_option("-o,--output", arguments->folder, "folder for study.toml, study.csv, study.json and pieces/");
  add_threads(command, arguments->threads, "default: one per core");
  command.add_flag("--force", arguments->force, "start again in a folder that holds a study");
  command.add_flag("--resume", arguments->resume, "continue a study that was stopped")->excludes("--force");
  add_json(command, arguments->json);
  command.footer(
      "The reference runs the path once. From states spread evenly over this path, each grid point makes the "
      "increment\n"
      "that the reference made from there. Its error is the difference of the two stresses over the mean pressure; in\n"
      "quasi-static loading the reference's answer is relaxed first. Whole paths differ by some per cent between runs "
      "that start "
      "one\n"
      "bit apart, so their results are means over --repeat paths; all but the first start with positions moved by\n"
      "1e-10 of the radius. FOLDER/study.toml holds the study: `rvelab study FOLDER/study.toml` runs it again.\n"
      "Except for times, any number of threads gives the same bits. More: rvelab/study/README.md.\n"
      "Examples:\n"
      "  rvelab study tolerance S.h5 -o F\n"
      "  rvelab study biaxial S.h5 --vary solver.relative_tolerance=0.1,0.01 -o F \\\n"
      "    --reference solver.target_unbalanced=3e-5 --reference solver.fixed_substeps=4000\n"
      "  rvelab study F/study.toml -o F --resume");
  command.callback([arguments] { run_study(*arguments); });
}

}  // namespace rvelab::cli
