// Grains brought into contact: scattered at random in a wide cell that shrinks, grown in a cell that stands still, or
// laid in rows; then pressed until they carry a tenth of the pressure.
#pragma once

#include "rvelab/grains/uniform.hpp"
#include "rvelab/pack/draw_watch.hpp"
#include "rvelab/pack/recipe.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pack {

/// The grains of a recipe, with the given friction: carrying a tenth of its pressure, or without a stress grown to
/// their sizes. IncrementFailed; InputError; Interrupted.
Rve in_first_contact(const Recipe& recipe, double friction, Uniform& uniform, const DrawWatch& watch);

/// Before grains touch, there is no network whose balance could determine the number of sub-steps: it is fixed.
/// Overlaps are not limited, since a light grain caught between two others is pushed out again.
SolverOptions unsteered();

/// Strains along the axes by which a cell is pressed, over the largest of them; compression positive.
using PressStrains = Vector3;

/// The cell of an assembly that carries less than a tenth of the pressure shrinks until it does. `deformation` (F,
/// laboratory frame) is multiplied by that of the cell.
Rve pressed(const Recipe& recipe, const Rve& rve, const DrawWatch& watch, const PressStrains& strains = Vector3::Ones(),
            Matrix3* deformation = nullptr);

}  // namespace rvelab::pack
