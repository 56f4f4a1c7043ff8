// Continuum models fitted to the tests of a sheet.
#pragma once

#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"
#include "rvelab/threads/workers.hpp"
#include "tools/models/models.hpp"

namespace rvelab::sheet {

struct ModelFile {
  std::string name;  ///< "norsand.txt", "mohr_coulomb_dense_abaqus.inp"
  std::string text;  ///< parameters, or input to paste
};

struct FittedModels {
  std::vector<models::Fit> fits;
  std::vector<ModelFile> files;
  std::vector<std::string> remarks;  ///< which could not be fitted, and why
};

/// The models by their names (models::names()); those that know no void ratio once for each density. Numbers of the
/// sheet are first guesses, and what a model takes as it is. Of discs none: the models are axisymmetric.
FittedModels fitted_models(const std::vector<std::string>& names, const std::vector<Test>& tests, const Sheet& sheet,
                           Workers& workers);

/// Removes from FOLDER/models the *.txt and *.inp that begin with the name of a model.
void remove_models(const std::string& folder);
/// Writes the files into FOLDER/models, in the place of those there. InputError: it cannot be written.
void write_models(const FittedModels& found, const std::string& folder);

}  // namespace rvelab::sheet
