// The table of keys that material_toml.hpp reads by: what each key is called and means, and which field it sets.
#pragma once

#include <variant>
#include <vector>

#include "rvelab/contact/model.hpp"
#include "rvelab/keys/key.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::keys {

/// friction_angle_deg sets Material::friction to its tangent.
struct FrictionAngle {};

/// The field that a key sets.
using Target = std::variant<std::string Material::*, double Material::*, FrictionAngle, double Damping::*,
                            bool Damping::*, Dashpot Damping::*, LocalDampingForm Damping::*, double SolverOptions::*,
                            long SolverOptions::*, bool SolverOptions::*, bool ContactModel::*, Law ContactModel::*,
                            Slip ContactModel::*, HertzRadius ContactModel::*>;

struct KeyEntry {
  Key key;
  Target target;
  Interval range;  ///< numbers only
};

const std::vector<KeyEntry>& key_entries();

}  // namespace rvelab::keys
