#include "rvelab/pool/verdict.hpp"

#include <cstdio>

#include "rvelab/measure/tangent.hpp"
#include "rvelab/solver/quasi_static/constants.hpp"

namespace rvelab::pool {

Verdict verdict_of_failure() noexcept {
  char text[1024];
  Verdict verdict{status_of_exception(text, sizeof text), {}};
  try {
    verdict.text = text;
  } catch (...) {  // no memory for words: the status says it
  }
  return verdict;
}

Verdict warning_of(const Report& report, double dt) {
  char text[320];
  Status status = Status::cell_thin;
  if (!report.quasi_static && dt == 0) {
    status = Status::not_quasi_static;
    std::snprintf(text, sizeof text,
                  "the state is no equilibrium: the unbalanced ratio is %g; the specimen flows or collapses: take "
                  "smaller steps, or give a time (dt > 0)",
                  report.unbalanced_ratio);
  } else if (dt == 0 && !report.tolerance_met) {
    status = Status::tolerance_missed;
    std::snprintf(text, sizeof text,
                  "the stress has an expected error of %g Pa; the tolerance allows %g Pa: take it as it is, or widen "
                  "tolerance_rel or tolerance_abs",
                  report.error_estimate / constants::met_margin, report.allowed_error);
  } else {
    std::snprintf(text, sizeof text,
                  "a height of the cell is below four mean diameters: it stands for less and less of the material; "
                  "use a larger specimen");
  }
  return {status, text};
}

void add_affine_warning(Verdict& verdict) {
  const char* const text =
      "the contact network has no elastic tangent that balances its grains; the affine one, which is stiffer, was "
      "written";
  if (verdict.status == Status::ok)
    verdict = {Status::tangent_affine, text};
  else
    verdict.text += std::string("; and ") + text;
}

bool write_tangent(const Network& network, Tangent& tangent) {
  Eigen::MatrixXd found;
  bool condensed = true;
  try {
    found = elastic_tangent(network);
  } catch (const Error&) {
    found = affine_tangent(network);
    condensed = false;
  }
  tangent.fill(0);
  const int plane[3] = {0, 1, 5};
  for (int i = 0; i < found.rows(); ++i)
    for (int j = 0; j < found.cols(); ++j) {
      const int row = found.rows() == 3 ? plane[i] : i, column = found.rows() == 3 ? plane[j] : j;
      tangent[std::size_t(6 * row + column)] = found(i, j);
    }
  return condensed;
}

}  // namespace rvelab::pool
