// The dashpot that gives a coefficient of restitution: fraction zeta of the critical one, from e.
//
// Linear: m* x'' + c x' + k x = 0 with c = 2 zeta sqrt(m* k). Hertz with c = cn delta^(1/4), cn = sqrt(5) zeta sqrt(m*
// k): y = x^(5/4) turns m* x'' + cn x^(1/4) x' + k x^(3/2) = 0 into the linear equation (Antypov and Elliott 2011), so
// that both have the same e(zeta), at any speed:
//   the contact ends where the overlap does:      e = exp(-pi zeta / sqrt(1 - zeta^2)),
//   with no_tension, where the force does:        Schwager and Poeschel 2007; earlier, so faster.
// Only + - x / sqrt: pair parameters decide the next bit.
#pragma once

namespace rvelab {

/// zeta >= 0 for a coefficient of restitution above 0 to 1; below 1 unless no_tension.
double damping_ratio(double restitution, bool no_tension);

/// The way back: e of two grains with a dashpot of this fraction of the critical one.
double restitution_of(double damping_ratio, bool no_tension);

}  // namespace rvelab
