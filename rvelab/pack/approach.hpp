// Two ways from scattered grains to an assembly that carries a stress, or that fills a cell.
#pragma once

#include <atomic>

#include "rvelab/pack/recipe.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab::pack {

/// The cell shrinks around grains that were scattered without contact, until they carry a tenth of the recipe's
/// pressure at rest.
Rve by_compression(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
                   const std::atomic<bool>* stop);

/// The cell of an assembly that has lost its pressure shrinks again, as above.
Rve pressed_again(const Recipe& recipe, const Rve& rve, const std::atomic<bool>* stop);

/// The grains are laid in rows that touch (regular.hpp), and the cell then shrinks as above.
Rve by_rows(const Recipe& recipe, const Grains& graded, double friction, const std::atomic<bool>* stop);

/// The grains grow, from first_size of their radii, in a cell that stands still; with a stress the cell then shrinks as
/// above. Without one its void ratio is the recipe's, and grains that can be apart are.
Rve by_growth(const Recipe& recipe, const Grains& graded, double friction, Uniform& uniform,
              const std::atomic<bool>* stop);

}  // namespace rvelab::pack
