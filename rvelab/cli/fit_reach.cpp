#include "rvelab/cli/fit_reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/error.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::cli {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class... Settings>
double strain_at_end(const protocol::Stage& stage) {
  double end = infinity;
  const auto take = [&](const auto* settings) {
    if (settings != nullptr) end = std::abs(settings->to_strain);
  };
  (take(protocol::settings_of<Settings>(stage)), ...);
  return end;
}

[[noreturn]] void refuse(const fit::Curve& curve, const std::string& says, double value, const std::string& limit,
                         double at, const std::string& remedy) {
  throw InputError(curve.file + ": " + says + " " + in_words(value) + ", " + in_words(std::abs(value - at)) +
                   " beyond " + limit + " " + in_words(at) + "; allowed: a curve within its test; " + remedy);
}

void expect_reach(const fit::Curve& curve, const protocol::Stage& last, const protocol::Protocol& protocol) {
  using namespace protocol;
  const bool over_strain = curve.abscissa == "strain";
  const double end = strain_at_end<CompressionStage, SimpleShearStage, DeviatoricStage, FlowStage>(last);
  const auto& strains = over_strain ? curve.x : curve.y;
  if (over_strain || curve.name == "strain") {
    const double farthest = *std::max_element(strains.begin(), strains.end());
    const std::string key = "stage." + last.name + ".to_strain";
    if (farthest > end * (1 + 1e-9))
      refuse(curve, "the curve reaches a strain of", farthest, "the end of the test, " + key + " =", end,
             "set " + key + "=" + in_words(farthest) +
                 " or more, or end the curve there (measured.to, or without its last rows)");
  }
  if (over_strain) {
    if (curve.x.front() < 0)
      refuse(curve, "the curve begins at a strain of", curve.x.front(), "the begin of the test at", 0,
             "compression is positive: change the sign of the column, or begin at 0 (measured.from, or without its "
             "first rows)");
    return;
  }
  constexpr double missed = 0.01;  // a test is at its pressure within a tolerance
  if (const auto* path = settings_of<PressurePathStage>(last)) {
    const double highest = *std::max_element(path->pressures.begin(), path->pressures.end());
    if (curve.x.back() > highest * (1 + missed))
      refuse(curve, "the curve reaches a stress in Pa of", curve.x.back(), "the end of the test, its last to_Pa",
             highest,
             "set to_Pa of stage " + last.name + ", or end the curve there (measured.to, or without its last rows)");
  } else if (std::isfinite(end) && protocol.uses_pressure && curve.x.front() < protocol.pressure * (1 - missed)) {
    refuse(
        curve, "the curve begins at a stress in Pa of", curve.x.front(),
        "the begin of the test, test.pressure_Pa =", protocol.pressure,
        "begin the curve there (measured.from, or without its first rows), or let the test begin at a lower pressure");
  }
}

/// Null: no stage records.
const protocol::Stage* last_recorded(const protocol::Protocol& protocol) {
  const auto last = std::find_if(protocol.stages.rbegin(), protocol.stages.rend(),
                                 [](const protocol::Stage& stage) { return stage.what->planned_records() > 0; });
  return last == protocol.stages.rend() ? nullptr : &*last;
}

}  // namespace

void expect_reach(const ComparedTest& compared, const protocol::Protocol& protocol) {
  const protocol::Stage* last = last_recorded(protocol);
  if (last == nullptr) return;
  for (const fit::Curve& curve : compared.curves) expect_reach(curve, *last, protocol);
}

void expect_reach(const ensemble::Feature& feature, const protocol::Protocol& protocol) {
  using namespace protocol;
  const Stage* last = last_recorded(protocol);
  if (last == nullptr) return;
  const double end = strain_at_end<CompressionStage, SimpleShearStage, DeviatoricStage, FlowStage>(*last);
  if (feature.at > end * (1 + 1e-9))
    throw InputError(feature.name + " lies beyond the end of the test, stage." + last->name + ".to_strain = " +
                     in_words(end) + "; allowed: a feature within its test; set to_strain, or leave it out");
}

}  // namespace rvelab::cli
