#include "rvelab/io/journal/probe_results.hpp"

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/schema.hpp"

namespace rvelab::io {

void put_probes(Hdf5File& file, const std::vector<records::ProbeResult>& probes) {
  const auto size = probes.empty() ? 0 : static_cast<std::size_t>(probes.front().stiffness.rows());
  std::vector<std::string> stages;
  std::vector<double> rows;
  for (const records::ProbeResult& probe : probes) {
    stages.push_back(probe.stage);
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix = probe.stiffness;
    rows.insert(rows.end(), matrix.data(), matrix.data() + matrix.size());
  }
  file.write_text("/probes/stage", stages, {probes.size()});
  file.write<double>("/probes/stiffness_Pa", rows, {probes.size(), size, size}, "Pa");
}

std::vector<records::ProbeResult> get_probes(const Hdf5File& file) {
  if (minor_version(file) == 0 && !file.has("/probes/stage")) return {};
  const auto stages = file.read_text("/probes/stage");
  const auto rows = file.read<double>("/probes/stiffness_Pa");
  const Shape64 shape = file.shape("/probes/stiffness_Pa");
  if (shape.size() != 3 || shape[0] != stages.size() || shape[1] != shape[2]) {
    throw InputError(file.path() +
                     ": /probes/stiffness_Pa is not one square matrix for each of /probes/stage; the file "
                     "is damaged: write it again");
  }
  const auto size = static_cast<Eigen::Index>(shape[1]);
  std::vector<records::ProbeResult> probes;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    probes.push_back({stages[k], Eigen::Map<const RowMajor>(rows.data() + k * shape[1] * shape[2], size, size)});
  }
  return probes;
}

}  // namespace rvelab::io
