// Grains without a contact: those of a recipe, scattered in a cell.
#pragma once

#include "rvelab/pack/draw_watch.hpp"
#include "rvelab/pack/recipe.hpp"

namespace rvelab::pack {

/// Parts of the number of all grains that the fractions get, with gradings by number `curves`; their sum is any.
std::vector<double> parts_of(const Recipe& recipe, const std::vector<NumberCurve>& curves);

/// How many grains each fraction gets: whole numbers nearest to the shares that add up to the recipe's number.
std::vector<std::size_t> numbers_of(const Recipe& recipe, const std::vector<NumberCurve>& curves);

/// The grains of a recipe, all at the origin: radii, materials, lengths and orientations by its gradings and seed, the
/// same for every draw. InputError if a fraction gets no grain, or too few for stratified sampling.
Grains graded_grains(const Recipe& recipe);

/// Volume of all grains, m^3.
double solid_volume(const Recipe& recipe, const Grains& grains);

/// Of a recipe of clumps: the clump of each grain of graded_grains. Its radius is that of the volume.
std::vector<const Clump*> clumps_of(const Recipe& recipe, const Grains& grains);
/// Discs or spheres around them, to be scattered: radii of `grains` by their clumps.
Grains around_clumps(const std::vector<const Clump*>& clumps, const Grains& grains);
/// The clumps at the places of `around`, each turned at random, in place of the grains of a specimen.
void put_clumps(const std::vector<const Clump*>& clumps, const Grains& graded, const Grains& around, Uniform& uniform,
                Specimen& specimen);

/// The recipe's cell with the given volume, m^3.
Cell cell_of(const Recipe& recipe, double volume);

/// Random places in the cell at which no circle (sphere) around a grain, `size` times as large, touches another; the
/// largest are placed first. Cell frame, m. False: no place was found for one of them.
bool scatter(Shape shape, const Cell& cell, double size, Grains& grains, Uniform& uniform, const DrawWatch& watch = {});

/// Superellipsoids for graded grains, which have their sizes and places: bodies, turned as the recipe says.
void put_solids(const Recipe& recipe, const Grains& graded, Uniform& uniform, Specimen& specimen);

}  // namespace rvelab::pack
