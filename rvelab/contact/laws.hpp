// The contact laws there are. A new law is a file of its own, like its neighbours, and a word in each list here.
//
// A law is its name, its parameters, the constants that it makes of two grains, and its Force: f_n, stiffnesses and
// energy from the overlap, which the step kernels are compiled for.
#pragma once

#include "rvelab/contact/cones.hpp"
#include "rvelab/contact/hertz_mindlin.hpp"
#include "rvelab/contact/hertz_rough.hpp"
#include "rvelab/contact/hertz_stiffness.hpp"
#include "rvelab/contact/linear.hpp"
#include "rvelab/contact/linear_adhesive.hpp"
#include "rvelab/contact/linear_stiffness.hpp"

namespace rvelab {

/// Normal and tangential law of all contacts of a specimen.
enum class Law { linear, linear_stiffness, hertz_mindlin, hertz_stiffness, linear_adhesive, hertz_rough, cones };

template <class... Each>
struct TypeList {};
/// In the order of Law.
using Laws = TypeList<LinearLaw, LinearStiffnessLaw, HertzMindlinLaw, HertzStiffnessLaw, LinearAdhesiveLaw,
                      HertzRoughLaw, ConesLaw>;

template <class... Each>
constexpr int count_of(TypeList<Each...>) {
  return int(sizeof...(Each));
}
constexpr int law_count = count_of(Laws{});

/// What the laws read of a material, in the order of files.
using ConstantGroups =
    TypeList<YoungModulus, StiffnessRatio, PoissonRatio, GivenStiffness, Adhesion, SurfaceRoughness, ConeSlope>;

template <class>
struct AllOf;
template <class... Groups>
struct AllOf<TypeList<Groups...>> : Groups... {};
/// The constants of all laws; those that a law does not read keep zero.
using LawConstants = AllOf<ConstantGroups>;

/// visit(L{}) for the law L of this value.
template <class Visit, class First, class... Rest>
static inline __attribute__((always_inline)) auto with_law(Law law, const Visit& visit, TypeList<First, Rest...>) {
  if constexpr (sizeof...(Rest) > 0) {
    if (law != Law(0)) return with_law(Law(int(law) - 1), visit, TypeList<Rest...>{});
  }
  return visit(First{});
}
template <class Visit>
static inline __attribute__((always_inline)) auto with_law(Law law, const Visit& visit) {
  return with_law(law, visit, Laws{});
}

}  // namespace rvelab
