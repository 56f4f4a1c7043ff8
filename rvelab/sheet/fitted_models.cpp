#include "rvelab/sheet/fitted_models.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/sheet/element_tests.hpp"

namespace rvelab::sheet {
namespace {

struct Job {
  std::string model, density_name = "";  ///< "": of all densities
  std::optional<std::size_t> density = {};
  models::Fit fit = {};
  std::vector<ModelFile> files = {};
  std::string why_not = "";

  std::string file(const std::string& ending) const { return model + (density ? "_" + density_name : "") + ending; }
};

std::vector<Job> jobs_of(const std::vector<std::string>& names, const std::vector<Test>& tests) {
  std::map<std::size_t, std::string> densities;
  for (const Test& test : tests) densities[test.density] = test.density_name;
  std::vector<Job> jobs;
  for (const std::string& model : names) {
    if (!models::of_one_density(model)) {
      jobs.push_back({.model = model});
      continue;
    }
    for (const auto& [density, name] : densities)
      jobs.push_back({.model = model, .density_name = name, .density = density});
  }
  return jobs;
}

void carry_out(Job& job, const std::vector<Test>& tests, const Sheet& sheet) {
  try {
    job.fit = models::fit(job.model, element_tests(tests, job.density), numbers_by_key(sheet, job.density_name));
  } catch (const InputError& refused) {
    job.why_not = refused.what();
    return;
  }
  std::string beyond;  // a model that goes so far astray is no description of these tests
  for (const models::Misfit& misfit : job.fit.misfits)
    if (misfit.stress > 1) beyond += (beyond.empty() ? "" : "; ") + misfit.test;
  if (!beyond.empty())
    job.fit.remarks.push_back("off by more than the largest stress, so not to be used for such paths: " + beyond);
  for (const auto& [host, ending] :
       std::map<std::string, std::string>{{"table", ".txt"}, {"abaqus", "_abaqus.inp"}, {"calculix", "_calculix.inp"}})
    if (std::string text = models::card(job.fit, host); !text.empty()) job.files.push_back({job.file(ending), text});
  if (job.density) job.fit.model += ", " + job.density_name;
}

}  // namespace

FittedModels fitted_models(const std::vector<std::string>& names, const std::vector<Test>& tests, const Sheet& sheet,
                           Workers& workers) {
  FittedModels found;
  if (!tests.empty() && tests.front().dimension == 2) {
    found.remarks.push_back("Continuum models are left out: they are of axisymmetric tests, of grains in space.");
    return found;
  }
  std::vector<Job> jobs = jobs_of(names, tests);
  workers.for_each_in_turn(jobs.size(), [&](std::size_t k) { carry_out(jobs[k], tests, sheet); });
  for (Job& job : jobs) {
    if (!job.why_not.empty()) {
      found.remarks.push_back(job.file("") + " is left out: " + job.why_not + ".");
      continue;
    }
    found.fits.push_back(std::move(job.fit));
    for (ModelFile& file : job.files) found.files.push_back(std::move(file));
  }
  return found;
}

void remove_models(const std::string& folder) {
  std::error_code ignored;
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(folder) / "models", ignored)) {
    const std::string name = entry.path().filename().string();
    const bool of_model = std::any_of(models::names().begin(), models::names().end(),
                                      [&](const std::string& model) { return name.starts_with(model); });
    if (of_model && (name.ends_with(".txt") || name.ends_with(".inp"))) old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path, ignored);
}

void write_models(const FittedModels& found, const std::string& folder) {
  const std::filesystem::path models = std::filesystem::path(folder) / "models";
  std::error_code failed;
  std::filesystem::create_directories(models, failed);
  if (failed) throw InputError(models.string() + ": cannot be made (" + failed.message() + ")");
  remove_models(folder);  // a model that is not of this sheet any more
  for (const ModelFile& file : found.files) io::publish_text((models / file.name).string(), file.text);
}

}  // namespace rvelab::sheet
