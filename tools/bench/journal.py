#!/usr/bin/env python3
"""Four ways to keep the records of a running test: microseconds a record, and what a kill leaves.   journal.py [--records N] [--kills N]

A record is 40 columns of 8 bytes. journal: a frame with a checksum appended to a file, as rvelab does it; swmr: HDF5,
single writer and many readers, a data set a column, flushed each record; segments: 50 records a sealed HDF5 file, made in
memory, synced and renamed; sqlite: a row a record, WAL, synchronous=NORMAL. A kill is SIGKILL at a random time; then
records lost beyond the last that the writer told, and whether a reader opens what is there without a repair."""

import argparse
import os
import random
import signal
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
import zlib

import h5py
import numpy as np

COLUMNS, SEGMENT = 40, 50


def journal(folder):
    file = os.open(f"{folder}/journal", os.O_CREAT | os.O_WRONLY | os.O_APPEND)

    def append(k, row):
        payload = struct.pack("<Q", k) + row.tobytes()
        os.write(file, struct.pack("<IQI", 2, len(payload), zlib.crc32(payload)) + payload)
    return append


def read_journal(folder):
    data, at, n = open(f"{folder}/journal", "rb").read(), 0, 0
    while at + 16 <= len(data):
        _, length, checksum = struct.unpack_from("<IQI", data, at)
        payload = data[at + 16:at + 16 + length]
        if len(payload) < length or zlib.crc32(payload) != checksum:
            break
        at, n = at + 16 + length, n + 1
    return n


def swmr(folder):
    file = h5py.File(f"{folder}/swmr.h5", "w", libver="latest")
    sets = [file.create_dataset(f"c{c}", (0,), maxshape=(None,), chunks=(256,)) for c in range(COLUMNS)]
    file.swmr_mode = True

    def append(k, row):
        for column, value in zip(sets, row):
            column.resize((k + 1,))
            column[k] = value
        file.flush()
    return append


def read_swmr(folder):
    with h5py.File(f"{folder}/swmr.h5", "r") as file:  # as any program opens it
        return min(len(file[f"c{c}"]) for c in range(COLUMNS))


def segments(folder):
    kept = []

    def append(k, row):
        kept.append(row)
        if len(kept) < SEGMENT:
            return
        with h5py.File("memory", "w", driver="core", backing_store=False) as file:
            for c, column in enumerate(np.array(kept).T):
                file[f"c{c}"] = column
            file.flush()
            image = file.id.get_file_image()
        kept.clear()
        with open(f"{folder}/part", "wb") as out:
            out.write(image + struct.pack("<I", zlib.crc32(image)))
            out.flush()
            os.fsync(out.fileno())
        os.rename(f"{folder}/part", f"{folder}/{k // SEGMENT:06d}.h5")
    return append


def read_segments(folder):
    return SEGMENT * sum(name.endswith(".h5") for name in os.listdir(folder))


def sqlite(folder):
    base = sqlite3.connect(f"{folder}/records.sqlite", isolation_level=None)
    base.execute("pragma journal_mode=wal")
    base.execute("pragma synchronous=normal")
    base.execute("create table record (k integer primary key, row blob)")
    return lambda k, row: base.execute("insert into record values (?, ?)", (k, row.tobytes()))


def read_sqlite(folder):
    return sqlite3.connect(f"{folder}/records.sqlite").execute("select count(*) from record").fetchone()[0]


WAYS = {"journal": (journal, read_journal), "swmr": (swmr, read_swmr), "segments": (segments, read_segments),
        "sqlite": (sqlite, read_sqlite)}


def write(way, folder, records, told=None):
    append, row = WAYS[way][0](folder), np.arange(COLUMNS, dtype=float)
    begin = time.perf_counter()
    for k in range(records):
        append(k, row)
        if told:
            os.write(told, b".")
    return (time.perf_counter() - begin) / records


def killed(way, folder):
    """Records that were told of and are gone; None: no reader opens what is there."""
    writer = subprocess.Popen([sys.executable, __file__, "--write", way, folder], stdout=subprocess.PIPE)
    writer.stdout.read(1)
    time.sleep(random.uniform(0, 0.2))
    writer.send_signal(signal.SIGKILL)
    told = 1 + len(writer.stdout.read())
    try:
        return max(0, told - WAYS[way][1](folder))
    except (OSError, sqlite3.Error, KeyError):
        return None


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--records", type=int, default=2000)
parser.add_argument("--kills", type=int, default=25)
parser.add_argument("--write", nargs=2, help=argparse.SUPPRESS)
options = parser.parse_args()
if options.write:
    write(*options.write, 10**9, told=1)
random.seed(1)
print(f"{'':<10} us a record   lost by {options.kills} kills, most   not opened")
for way in WAYS:
    with tempfile.TemporaryDirectory() as folder:
        seconds = write(way, folder, options.records)
    lost = []
    for _ in range(options.kills):
        with tempfile.TemporaryDirectory() as folder:
            lost.append(killed(way, folder))
    opened = [n for n in lost if n is not None]
    print(f"{way:<10} {1e6 * seconds:>11.1f}   {max(opened, default='-'):>24}   {lost.count(None):>10}")
