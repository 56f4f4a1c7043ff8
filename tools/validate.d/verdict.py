"""Rows of kept tables with a bar: `met`; DIFFERS, where the published number is another one and the cause is known, with the
cause on the next line; MISSED, which no kept table should have.

A cause is given together with the range in which it explains what was found: a figure that leaves that range is MISSED again."""

missed, different = [], []


def verdict(what, found, asked, met, explained=False, cause="", width=76):
    """Prints one row. what, found, asked: texts; met: whether the bar holds; explained: whether the figure lies where `cause`
    (one sentence, with the run that isolates it) puts it."""
    word = "met" if met else "DIFFERS" if explained and cause else "MISSED"
    if word == "MISSED":
        missed.append(what)
    if word == "DIFFERS":
        different.append(what)
    print(f"{what:<{width}} {found:<22} {asked:<24} {word}", flush=True)
    if word == "DIFFERS":
        print(f"    why: {cause}", flush=True)


def tell_verdicts():
    print(f"\n{len(missed)} missed" + (": " + "; ".join(missed) if missed else "") +
          f"; {len(different)} differ from their source, with the cause")
