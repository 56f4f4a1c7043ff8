"""tools/validate pieces: one path of 1 % strain, whole and in pieces of 1e-7, with turns, by pieces.cpp.

    pieces.py RVELAB WORK RESULTS [REPEATS]"""
import harness
from harness import bars, packed, row

ALLOWED = {1e-4: 1, 1e-5: 1.2, 1e-6: 2, 1e-7: 6}  # time over that of increments of 1e-4, at most
# Standard errors that a mean may be beyond its tolerance. Some 50 means are independent: one of them is beyond two by
# chance in most runs of the table, beyond three in one of fifteen.
BY_CHANCE = 3


@bars
def path(name, lines):
    """Lines of one path: size, sub-steps, time (s), and of each quarter error, standard error and tolerance over p."""
    for size, substeps, seconds, *quarters in lines:
        ratio, bar = seconds / lines[0][2], ALLOWED[size]
        why = [] if ratio <= bar else [f"time: {substeps / lines[0][1]:.3g} times the sub-steps"]
        for k, (error, scatter, allowed) in enumerate(zip(quarters[::3], quarters[1::3], quarters[2::3])):
            if error > allowed + BY_CHANCE * scatter:
                beyond = f", {(error - allowed) / scatter:.3g} standard errors beyond" if scatter else ""
                why.append(f"stress at {0.25 * (k + 1):g} %: {error / allowed:.3g} times its tolerance{beyond}")
        row(f"{name:<12} {size:6.0e} {substeps:9.0f} {seconds:8.3f} {ratio:6.2f} {bar:4.1f} " + "".join(f" {each:8.5f}"
                                                                                                        for each in quarters) + " ",
            not why, reason="; ".join(why), what=f"{name}, {size:g}")


def main():
    repeats = int(harness.words[0]) if harness.words else 16
    print(f"1 % of strain in pieces; {repeats} perturbed specimens; at each quarter point error, standard error (0: by value)\n"
          "and tolerance, over p\npath         pieces sub-steps     time  ratio  bar " +
          "".join(f"   {0.25 * k:.2f} %: error, s.e., allowed" for k in (1, 2, 3, 4)))
    lines = {}
    for line in harness.run(harness.program.with_name("rvelab-pieces"), packed("pack_dense", "dense"),
                            repeats).stdout.splitlines():
        name, *numbers = line.split(",")
        lines.setdefault(name, []).append([float(each) for each in numbers])
    for name, each in lines.items():
        path(name, each)


if __name__ == "__main__":
    harness.main(main)
