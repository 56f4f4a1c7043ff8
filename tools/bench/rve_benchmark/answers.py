"""Answers of codes, references, and the error of an answer."""
import csv
import math
import os

import numpy as np

import case as cases

WEIGHTS = np.array([1, 1, 1, 2, 2, 2])  # of the components in a Frobenius norm


def norm(sigma):
    return np.sqrt((np.asarray(sigma) ** 2 * WEIGHTS).sum(axis=-1))


def windows(case):
    """Records (first, last) of each mean; of a curve each record alone."""
    last = len(case.targets())
    if not case.windows:
        return [(k, k) for k in range(last + 1)]
    edges = np.linspace(case.first_record, last + 1, case.windows + 1).round().astype(int)
    return [(int(a), int(b) - 1) for a, b in zip(edges, edges[1:])]


def checked(case, found, source):
    """Answers as an array (specimens, records, 3 strains and 6 stresses)."""
    wanted = (len(case.specimens), len(case.targets()) + 1, 9)
    try:
        table = np.array([one["records"] for one in found], float)
    except (ValueError, TypeError, KeyError):
        table = np.zeros(0)
    if table.shape != wanted:
        raise cases.CaseError(f"{source}: {case.name} asks for {wanted[0]} specimens of {wanted[1]} records (the start is one) with 3 "
                              f"strains and 6 stresses; found {' x '.join(map(str, table.shape))}")
    if not np.isfinite(table).all():
        k = np.argwhere(~np.isfinite(table))[0]
        raise cases.CaseError(f"{source}: {case.name}, specimen {k[0] + 1}, record {k[1]}: not a finite number")
    return table


def reduced(case, table):
    """Rows of the reference: means over specimens and windows."""
    return np.array([table[:, a:b + 1].mean(axis=(0, 1)) for a, b in windows(case)])


class Reference:
    """rows (n, 9), bars (n) in Pa."""

    def __init__(self, case):
        self.case, self.path = case, os.path.join(case.folder, "reference.csv")
        spans, rows = windows(case), []
        head = ["records", *cases.STRAINS, *cases.STRESSES, "bar_Pa"]
        try:
            with open(self.path, encoding="utf-8", newline="") as file:
                found = list(csv.reader(file))
        except OSError as error:
            raise cases.CaseError(f"{self.path}: {error.strerror}; make_references.py makes it") from None
        if not found or found[0] != head:
            raise cases.CaseError(f"{self.path}: the first line must be {','.join(head)}")
        if len(found) - 1 != len(spans):
            raise cases.CaseError(f"{self.path}: {len(found) - 1} rows; the path of case.toml has {len(spans)}")
        for number, (row, span) in enumerate(zip(found[1:], spans), 2):
            try:
                rows.append([float(word) for word in row[1:]])
                right = len(row) == len(head) and all(map(math.isfinite, rows[-1])) and rows[-1][-1] > 0
            except ValueError:
                right = False
            if not right or row[0] != span_text(span):
                raise cases.CaseError(f"{self.path}, line {number}: needed are the records {span_text(span)}, nine numbers and a bar "
                                      f"above 0; found '{','.join(row)}'")
        rows = np.array(rows)
        self.rows, self.bars = rows[:, :9], rows[:, 9]
        sigma = self.rows[:, 3:]
        # Of a curve the change from the start, of means the stress itself.
        self.scale = norm(sigma).max() if case.windows else norm(sigma - sigma[0]).max()

    def _mean(self, of):
        return float(np.sqrt(np.mean((of if self.case.windows else of[1:]) ** 2)))

    def error(self, table):
        """Root mean square over the rows of |sigma - reference|, over the scale."""
        return self._mean(norm(reduced(self.case, table)[:, 3:] - self.rows[:, 3:])) / self.scale

    def bar(self):
        return self._mean(self.bars) / self.scale

    def volume_error(self, table):
        """The same of the volumetric strain, over its largest value; None where the path prescribes it."""
        if not any(leg.held_Pa for leg in self.case.legs):
            return None
        volume = lambda rows: (1 + rows[:, :3]).prod(axis=1) - 1
        own = volume(self.rows)
        return self._mean(volume(reduced(self.case, table)) - own) / abs(own).max()


def span_text(span):
    return str(span[0]) if span[0] == span[1] else f"{span[0]}-{span[1]}"


def write_reference(case, rows, bars):
    with open(os.path.join(case.folder, "reference.csv"), "w", encoding="utf-8") as out:
        out.write(",".join(["records", *cases.STRAINS, *cases.STRESSES, "bar_Pa"]) + "\n")
        for span, row, bar in zip(windows(case), rows, bars):
            values = [f"{v:.6e}" for v in row[:3]] + [f"{v:.2f}" for v in row[3:]]
            out.write(",".join([span_text(span), *values, f"{bar:.2f}"]) + "\n")


def read_answer(case, path):
    """A table of another code: specimen,record,eps_xx,...,sigma_xy_Pa."""
    head = ["specimen", "record", *cases.STRAINS, *cases.STRESSES]
    try:
        with open(path, encoding="utf-8", newline="") as file:
            found = list(csv.reader(file))
    except OSError as error:
        raise cases.CaseError(f"{path}: {error.strerror}") from None
    if not found or found[0] != head:
        raise cases.CaseError(f"{path}: the first line must be {','.join(head)}")
    tables = [{"records": []} for _ in case.specimens]
    for number, row in enumerate(found[1:], 2):
        try:
            specimen, record, values = int(row[0]), int(row[1]), [float(word) for word in row[2:]]
        except (ValueError, IndexError):
            raise cases.CaseError(f"{path}, line {number}: '{','.join(row)}' holds no numbers for {','.join(head)}") from None
        if not 1 <= specimen <= len(tables) or record != len(tables[specimen - 1]["records"]):
            raise cases.CaseError(f"{path}, line {number}: specimen {specimen}, record {record}; specimens are 1 to {len(tables)}, "
                                  "records of each go up from 0 (the start)")
        tables[specimen - 1]["records"].append(values)
    return checked(case, tables, path)
