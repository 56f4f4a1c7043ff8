"""Liquid bridges between spheres by the Young-Laplace equation, many at once.

Lengths over R = 2 R1 R2/(R1 + R2), forces over 2 pi gamma R, suction over gamma/R; the curvatures of the grains are
1 + a and 1 - a with a = |R1 - R2|/(R1 + R2), so that a = 1 is a sphere on a plane.

r cos f + S r^2/2 = C along the meridian (f its slope, C the force) makes r^2 a sine of the arc length: with the neck r0,
    r^2 = r0^2 + (1 + S r0) q^2,   q = sin(S l/2)/(S/2),   r sin f = (1 + S r0) q cos(S l/2),   C = r0 + S r0^2/2.
Length and volume of either side are quadratures over l; contact lines lie where sin f = cos(theta + d), r = R sin d.
A bridge is (r0, S, l1, l2)."""
import numpy as np

pi = np.pi
NODE, WEIGHT = np.polynomial.legendre.leggauss(48)
NODE, WEIGHT = (NODE + 1) / 2, WEIGHT / 2


def side(r0, S, l, curvature, theta):
    """Residual of the contact angle, axial length less cap, volume less cap, of one side."""
    C = r0 + S * r0 * r0 / 2
    along = l[:, None] * NODE
    half = S[:, None] * along / 2
    q = along * np.sinc(half / pi)
    r = np.sqrt(np.maximum(r0[:, None] ** 2 + (1 + S * r0)[:, None] * q * q, 1e-300))
    x = l * ((C[:, None] / r - S[:, None] * r / 2) @ WEIGHT)
    v = pi * l * ((r * (C[:, None] - S[:, None] * r * r / 2)) @ WEIGHT)
    qe = l * np.sinc(S * l / 2 / pi)
    re = np.sqrt(np.maximum(r0 ** 2 + (1 + S * r0) * qe * qe, 1e-300))
    sin_d = np.minimum(curvature * re, 1)
    cos_d = np.sqrt(1 - sin_d ** 2)
    g = (1 + S * r0) * qe * np.cos(S * l / 2) / re - (np.cos(theta) * cos_d - np.sin(theta) * sin_d)
    cap = re * re * curvature / (1 + cos_d)
    return g, x - cap, v - pi * cap * (3 * re * re + cap * cap) / 6


def bridge(y, p):
    """y: r0, S, l1, l2; p: theta, a. Returns the residuals of the angles, gap, volume."""
    g1, x1, v1 = side(y[0], y[1], y[2], 1 + p["a"], p["theta"])
    g2, x2, v2 = side(y[0], y[1], y[3], 1 - p["a"], p["theta"])
    return g1, g2, x1 + x2, v1 + v2


def solve(y, p, unknown, residual, iterations=12, limit=1e-13):
    """Newton on the rows `unknown` of y with a numerical Jacobian; residual(y) gives as many rows."""
    y = y.copy()
    n = len(unknown)
    size = np.abs(y[2]) + np.abs(y[3])
    scale = np.maximum(np.abs(y), np.stack([0 * size, 0.1 / size, 0.1 * size, 0.1 * size]))[unknown]   # S, l pass through 0
    for _ in range(iterations):
        f = residual(y)
        J = np.empty((y.shape[1], n, n))
        for k, c in enumerate(unknown):
            z = y.copy()
            h = 1e-6 * scale[k]
            z[c] = z[c] + h
            up = residual(z)
            z[c] = z[c] - 2 * h
            J[:, :, k] = ((up - residual(z)) / 2e-6).T
        J[~np.isfinite(J)] = 1.0
        J += 1e-300 * np.eye(n)
        try:
            step = np.linalg.solve(J, -np.nan_to_num(f).T[:, :, None])[:, :, 0].T
        except np.linalg.LinAlgError:
            step = np.stack([np.linalg.lstsq(J[i], -np.nan_to_num(f[:, i]), rcond=None)[0] for i in range(y.shape[1])], 1)
        size = np.max(np.abs(step), axis=0)
        step = step * np.minimum(1, 0.3 / np.maximum(size, 1e-300))
        y[unknown] += step * scale
        if np.max(size) < limit:
            break
    return y, np.max(np.abs(residual(y)), axis=0)


def contact_guess(q, theta, a):
    """Toroid of small bridges: q = h^2, h the height of the meniscus at gap 0."""
    h = np.sqrt(q)
    r = np.sqrt(h)
    S = 2 * np.cos(theta) / h - 1 / r
    rho = h / (2 * np.cos(theta))
    r0 = r - rho * (1 - np.sin(theta))
    l = rho * (pi / 2 - theta)
    return np.stack([r0, S, l - rho * np.arcsin(np.minimum(r * (1 + a), 1)), l - rho * np.arcsin(np.minimum(r * (1 - a), 1))])


def chebyshev_points(n):
    return np.cos(pi * (np.arange(n) + 0.5) / n)


def curves(value, theta, a, y, kind, step=0.08, beyond_rupture=6, most=400):
    """Gap, force and the other quantity along each path from contact to beyond rupture, by steps of equal length in
    (ln r0, arsinh(S V^(1/3)), l1, l2). value, theta, a: one each a bridge; y: in contact."""
    p = {"theta": theta, "a": a}
    n = len(theta)
    length = np.cbrt(value) if kind == "volume" else np.cos(theta) / value
    unknown = [0, 1, 2, 3] if kind == "volume" else [0, 2, 3]
    def point_of(y):
        return np.stack([np.log(np.maximum(y[0], 1e-300)), np.arcsinh(y[1] * length), y[2] / length, y[3] / length])
    def residual_at(origin, tangent, h):
        def residual(y):
            g1, g2, s, v = bridge(y, p)
            along = np.sum(tangent * (point_of(y) - origin), axis=0) - h
            return np.stack([g1, g2, v / value - 1, along] if kind == "volume" else [g1, g2, along])
        return residual
    tangent = np.zeros((4, n))
    tangent[0] = -1
    if kind == "volume":
        tangent[1] = -1
    path, points, beyond = [y], [point_of(y)], np.zeros(n, int)
    gap, volume = [], []
    worst = np.zeros(n)
    _, _, s, v = bridge(y, p)
    gap.append(s), volume.append(v)
    h = step / 8
    while np.min(beyond) < beyond_rupture and len(path) < most:
        going = beyond < beyond_rupture
        guess = path[-1] + ((path[-1] - path[-2]) * (h / last_h) if len(path) > 1 else 0)
        guess[0] = np.where(guess[0] > 0, guess[0], path[-1][0] * 0.9)
        z, bad = solve(np.where(going, guess, path[-1]), p, unknown, residual_at(points[-1], tangent, np.where(going, h, 0)), 10, 1e-13)
        worst = np.where(going, np.maximum(worst, bad), worst)
        path.append(z)
        points.append(point_of(z))
        secant = points[-1] - points[-2]
        size = np.sqrt(np.sum(secant ** 2, axis=0))
        tangent = np.where(going & (size > 0), secant / np.maximum(size, 1e-300), tangent)
        _, _, s, v = bridge(z, p)
        gap.append(s), volume.append(v)
        beyond += going & ((gap[-1] < gap[-2]) | (beyond > 0))
        last_h = h
        h = min(step, h * 1.1)
    path, points = np.stack(path), np.stack(points)
    chord = np.cumsum(np.concatenate([np.zeros((1, n)), np.sqrt(np.sum(np.diff(points, axis=0) ** 2, axis=1))]), axis=0)
    force = path[:, 0] + path[:, 1] * path[:, 0] ** 2 / 2
    return {"chord": chord, "gap": np.stack(gap), "force": force, "other": path[:, 1] if kind == "volume" else np.stack(volume), "worst": worst}


def sampled(c, t, order=8):
    """At t = sqrt(1 - gap/rupture): energy to rupture, force, other; and the rupture gap. One curve after the other."""
    E, F, O, rupture = [], [], [], []
    gx, gw = np.polynomial.legendre.leggauss(order)
    for i in range(c["gap"].shape[1]):
        x, s = c["chord"][:, i], c["gap"][:, i]
        keep = np.concatenate([[True], np.diff(x) > 1e-9])
        x, s, f, o = x[keep], s[keep], c["force"][keep, i], c["other"][keep, i]
        n = len(x)
        first = np.clip(np.arange(n - 1) - order // 2 + 1, 0, n - order)
        index = first[:, None] + np.arange(order)
        mid, wide = (x[:-1] + x[1:]) / 2, (x[1:] - x[:-1]) / 2
        local = (x[index] - mid[:, None]) / wide[:, None]
        poly = np.linalg.solve(local[:, :, None] ** np.arange(order), np.stack([s[index], f[index], o[index]], 2))
        powers = np.arange(order)
        def at(k, u, which):
            return (u ** powers) @ poly[k, :, which]
        def slope(k, u, which):
            return (u ** powers[:-1] * powers[1:]) @ poly[k, 1:, which]
        top = np.argmax(s)
        k = min(top, n - 2)
        if top > 0 and (k == n - 1 or slope(k, -1.0, 0) < 0): k = top - 1
        lo, hi = -1.0, 1.0
        for _ in range(60):
            m = (lo + hi) / 2
            if slope(k, m, 0) > 0: lo = m
            else: hi = m
        kc, uc = k, (lo + hi) / 2
        sc = at(kc, uc, 0)
        def work(k, u0, u1):
            u = (u0 + u1) / 2 + (u1 - u0) / 2 * gx
            U = u[:, None] ** powers
            return (u1 - u0) / 2 * np.sum(gw * (U @ poly[k, :, 1]) * (U[:, :-1] @ (poly[k, 1:, 0] * powers[1:])))
        whole = np.array([work(k, -1.0, 1.0) for k in range(kc)])
        above = np.concatenate([np.cumsum(whole[::-1])[::-1], [0.0]]) + work(kc, -1.0, uc)   # from knot k to rupture
        e, ff, oo = [], [], []
        for tt in t:
            target = sc * (1 - tt * tt)
            k = min(int(np.searchsorted(s[:kc + 1], target, side="right")) - 1, kc)
            k = max(k, 0)
            lo, hi = -1.0, uc if k == kc else 1.0
            for _ in range(56):
                m = (lo + hi) / 2
                if at(k, m, 0) < target: lo = m
                else: hi = m
            u = (lo + hi) / 2
            e.append((above[k + 1] if k < kc else 0.0) + work(k, u, 1.0 if k < kc else uc))
            ff.append(at(k, u, 1))
            oo.append(at(k, u, 2))
        E.append(e), F.append(ff), O.append(oo), rupture.append(sc)
    return np.array(E), np.array(F), np.array(O), np.array(rupture)
