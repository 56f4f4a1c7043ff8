// The settings file of a UMAT (RVELAB_UMAT or rvelab_umat.toml): options of the pool, and materials by number.
#pragma once

#include <rvelab/rvelab.h>

#include <array>
#include <map>
#include <optional>
#include <string>

namespace umat {

struct Material {
  std::string specimen;                           ///< path
  bool kirchhoff = false;                         ///< DDSDDE is (1/J) d(J sigma)/d eps: the tangent plus sigma (x) I
  bool from_zero = false;                         ///< a first stress of zero means that of the specimen
  std::optional<std::array<int, 3>> shear_order;  ///< index of each shear of the host in 12 13 23, if given
};

struct Settings {
  std::string path;  ///< as given by the host
  rvelab_pool_def pool{};
  std::map<int, Material> materials;  ///< by PROPS(1)
};

/// Throws std::runtime_error with file, key, value and remedy.
Settings read_settings(const std::string& path);

}  // namespace umat
