"""Three schemes of inverse calibration on hidden parameter sets: fit_schemes.py PROGRAM WORK RESULTS [SETS]

A Gaussian-process surrogate (what `rvelab fit` does), an iterative Bayesian filter (importance weights, resampling from
a Gaussian; Cheng et al. 2018) and an ensemble Kalman scheme (multiple data assimilation; Emerick and Reynolds 2013) find
two and three parameters of a synthetic material from means of ten noisy tests. Each gets the same number of tests. The
material: friction, rolling and void ratio give peak angle, angle at large strain, dilation angle and log10 of a modulus,
with a scatter of specimens like that of 400 discs, half of it shared by all tests on one specimen.
Prints for each scheme how often the truth lies in the 95 % interval of every parameter, the error and the width.
"""

import numpy as np
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import minimize

import harness

SCATTER = np.array([1.6, 0.9, 2.0, 0.06])  # of one test: degrees, degrees, degrees, log10 Pa
SPECIMENS, DATA_TESTS = 10, 10


def material(u):
    """Mean of the four measures; u in the unit cube: friction 0.1 to 1, rolling 0 to 0.5, void ratio 0.16 to 0.24."""
    mu, eta = 0.1 + 0.9 * u[0], 0.5 * u[1]
    e = 0.16 + 0.08 * u[2] if len(u) > 2 else 0.19
    large = 10 + 12 * (1 - np.exp(-mu / 0.3)) + 9 * eta / (eta + 0.2)
    psi = (0.24 - e) * 250 * (0.4 + 0.6 * mu)
    return np.array([large + 0.8 * psi, large, psi, 7.6 - 4 * (e - 0.16) + 0.3 * np.sqrt(mu)])


class Laboratory:
    def __init__(self, unknowns, seed):
        self.random = np.random.default_rng(seed)
        self.outputs = [0, 1] if unknowns == 2 else [0, 1, 2, 3]
        self.scatter = SCATTER[self.outputs]
        self.effects = np.sqrt(0.5) * self.random.standard_normal((SPECIMENS, len(self.outputs))) * self.scatter
        self.truth = self.random.uniform(0.1, 0.9, unknowns)
        self.error = self.scatter / np.sqrt(DATA_TESTS)
        self.data = material(self.truth)[self.outputs] + self.random.standard_normal(len(self.outputs)) * self.error
        self.spent = 0

    def test(self, u):
        specimen = self.spent % SPECIMENS
        self.spent += 1
        noise = self.effects[specimen] + np.sqrt(0.5) * self.random.standard_normal(len(self.outputs)) * self.scatter
        return specimen, material(u)[self.outputs] + noise


def halton(count, dimensions, first=1):
    def radical(k, base):
        value, part = 0.0, 1.0
        while k > 0:
            part /= base
            value += part * (k % base)
            k //= base
        return value
    return np.array([[radical(k, (2, 3, 5, 7)[j]) for j in range(dimensions)] for k in range(first, first + count)])


class Surrogate:
    """One output: linear trend, Matern 5/2, an effect of each specimen, noise; hyperparameters by restricted likelihood
    with wide log-normal priors."""

    def __init__(self, points, specimens, values):
        self.points, self.m = points, points.shape[1]
        self.same = specimens[:, None] == specimens[None, :]
        self.shift, self.scale = values.mean(), values.std() + 1e-12
        self.values = (values - self.shift) / self.scale
        start = np.concatenate([np.zeros(self.m), [-1.0, -1.0, -1.0]])
        found = minimize(self.cost, start, method="Nelder-Mead", options={"maxiter": 400, "fatol": 1e-3})
        self.prepare(found.x)

    def correlation(self, a, b, lengths):
        r = np.sqrt(5 * (((a[:, None, :] - b[None, :, :]) / lengths) ** 2).sum(axis=2) + 1e-300)
        return (1 + r + r * r / 3) * np.exp(-r)

    def trend(self, points):
        return np.hstack([np.ones((len(points), 1)), points])

    def prepare(self, x):
        self.lengths = np.exp(x[:self.m])
        self.process, shared, own = np.exp(2 * x[self.m:])
        matrix = self.process * self.correlation(self.points, self.points, self.lengths) + shared * self.same
        matrix += (own + 1e-8) * np.eye(len(self.values))
        self.factor = cho_factor(matrix, lower=True)
        h = self.trend(self.points)
        self.solved_h = cho_solve(self.factor, h)
        self.information = h.T @ self.solved_h
        self.beta = np.linalg.solve(self.information, self.solved_h.T @ self.values)
        self.weights = cho_solve(self.factor, self.values - h @ self.beta)
        self.misfit = (self.values - h @ self.beta) @ self.weights

    def cost(self, x):
        self.prepare(x)
        determinant = np.log(np.diag(self.factor[0])).sum()
        restricted = 0.5 * np.linalg.slogdet(self.information)[1]
        prior = 0.5 * (((x[:self.m] - 0.0) / 0.7) ** 2).sum() + 0.5 * (((x[self.m:] + 1) / 1.5) ** 2).sum()
        return 0.5 * self.misfit + determinant + restricted + prior

    def at(self, points):
        k = self.process * self.correlation(points, self.points, self.lengths)
        h = self.trend(points)
        mean = h @ self.beta + k @ self.weights
        half = solve_triangular(self.factor[0], k.T, lower=True)
        rest = h - k @ self.solved_h
        variance = self.process - (half ** 2).sum(axis=0) + (rest @ np.linalg.inv(self.information) * rest).sum(axis=1)
        return self.shift + self.scale * mean, self.scale ** 2 * np.maximum(variance, 0)


def sampled(surrogates, laboratory, dimensions, random, power=1.0, count=400):
    """Tempered importance sampling with Metropolis moves; the prior is uniform."""
    def log_likelihood(points):
        total = np.zeros(len(points))
        for surrogate, data, error in zip(surrogates, laboratory.data, laboratory.error):
            mean, variance = surrogate.at(points)
            spread = variance + error ** 2
            total -= 0.5 * (data - mean) ** 2 / spread + 0.5 * np.log(spread)
        return power * total
    points = halton(count, dimensions)
    values, reached = log_likelihood(points), 0.0
    while reached < 1:
        step = 1 - reached
        while True:
            weights = np.exp(step * (values - values.max()))
            weights /= weights.sum()
            if 1 / (weights ** 2).sum() >= 0.5 * count or step < 1e-4:
                break
            step *= 0.7
        reached = min(1.0, reached + step)
        chosen = np.searchsorted(np.cumsum(weights), (np.arange(count) + random.uniform()) / count).clip(0, count - 1)
        points, values = points[chosen], values[chosen]
        root = np.linalg.cholesky(np.cov(points.T).reshape(dimensions, dimensions) + 1e-10 * np.eye(dimensions))
        for move in range(6):
            trial = points + (2.38 / np.sqrt(dimensions)) * (0.5 ** (move % 3)) * random.standard_normal(points.shape) @ root.T
            inside = ((trial >= 0) & (trial <= 1)).all(axis=1)
            there = np.where(inside, log_likelihood(trial.clip(0, 1)), -np.inf)
            accepted = np.log(random.uniform(size=count)) < reached * (there - values)
            points[accepted], values[accepted] = trial[accepted], there[accepted]
    return points


def by_surrogate(laboratory, dimensions, tests, batch=8):
    random = np.random.default_rng(1)
    points = halton(max(8, 5 * dimensions), dimensions)
    found = [laboratory.test(u) for u in points]
    while True:
        specimens, values = np.array([s for s, _ in found]), np.array([y for _, y in found])
        surrogates = [Surrogate(points, specimens, values[:, k]) for k in range(values.shape[1])]
        if len(points) >= tests:
            return sampled(surrogates, laboratory, dimensions, random)
        new = sampled(surrogates, laboratory, dimensions, random, power=0.5)[:: 400 // batch][:min(batch, tests - len(points))]
        found += [laboratory.test(u) for u in new]
        points = np.vstack([points, new])


def by_filter(laboratory, dimensions, tests, rounds=4):
    random = np.random.default_rng(1)
    count = tests // rounds
    points = halton(count, dimensions)
    for k in range(rounds):
        values = np.array([laboratory.test(u)[1] for u in points])
        misfit = 0.5 * (((values - laboratory.data) / np.hypot(laboratory.error, laboratory.scatter)) ** 2).sum(axis=1)
        weights = np.exp(-(misfit - misfit.min()))
        weights /= weights.sum()
        mean = weights @ points
        spread = (points - mean).T @ ((points - mean) * weights[:, None]) + 1e-6 * np.eye(dimensions)
        if k + 1 < rounds:
            points = random.multivariate_normal(mean, 2 * spread, count).clip(0, 1)
    return random.multivariate_normal(mean, spread, 400).clip(0, 1)


def by_kalman(laboratory, dimensions, tests, rounds=4):
    random = np.random.default_rng(1)
    count = tests // rounds
    points = halton(count, dimensions)
    for _ in range(rounds):
        values = np.array([laboratory.test(u)[1] for u in points])
        du, dy = points - points.mean(axis=0), values - values.mean(axis=0)
        error = rounds * np.diag(laboratory.error ** 2)
        gain = (du.T @ dy / (count - 1)) @ np.linalg.inv(dy.T @ dy / (count - 1) + error)
        asked = laboratory.data + random.multivariate_normal(np.zeros(len(laboratory.data)), error, count)
        points = (points + (asked - values) @ gain.T).clip(0, 1)
    return points


def main():
    sets = int(harness.words[0]) if harness.words else 20
    print(f"{sets} hidden sets each; targets: means of {DATA_TESTS} tests; {SPECIMENS} specimens; parameters in 0 to 1")
    print("unknowns  tests  scheme                        truth within 95 %  of it alone  rms error  width")
    for unknowns, tests in ((2, 40), (3, 64)):
        for name, scheme in (("Gaussian process", by_surrogate), ("iterative Bayesian filter", by_filter),
                             ("ensemble Kalman", by_kalman)):
            inside, single, errors, widths = 0, [], [], []
            for k in range(sets):
                laboratory = Laboratory(unknowns, 1000 * unknowns + k)
                points = scheme(laboratory, unknowns, tests)
                low, high = np.quantile(points, [0.025, 0.975], axis=0)
                within = (low <= laboratory.truth) & (laboratory.truth <= high)
                inside += within.all()
                single.append(within.mean())
                errors.append(((points.mean(axis=0) - laboratory.truth) ** 2).mean())
                widths.append((high - low).mean())
            print(f"{unknowns:8d}  {tests:5d}  {name:28s}  {inside:9d} of {sets:3d}   {100 * np.mean(single):6.0f} %   "
                  f"{np.sqrt(np.mean(errors)):9.3f}  {np.mean(widths):5.2f}", flush=True)


if __name__ == "__main__":
    harness.main(main)
