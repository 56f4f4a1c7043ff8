#!/usr/bin/env python3
"""System requirements of programs and libraries, from their symbols: elf_needs.py FILE...

    glibc 2.34, no libstdc++; libraries: ld-linux-x86-64.so.2 libc.so.6 libgcc_s.so.1 libm.so.6

Libraries among the files are no requirements. The tag of a wheel follows from this (PEP 600): manylinux_2_N
means that any Linux with glibc 2.N is sufficient.
"""

import pathlib
import platform
import re
import subprocess
import sys

# What every Linux with glibc has, of any age, and what PEP 600 lets a wheel count on.
SYSTEM = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "libgcc_s.so.1"}
LOADER = re.compile(r"ld-linux.*\.so\.\d+")


def is_elf(file):
    return pathlib.Path(file).read_bytes()[:4] == b"\x7fELF"


class Needs:
    """libraries: those needed and not among the files; versions: {"GLIBC": (2, 34), ...}, the newest version of any symbol."""

    def __init__(self, files):
        self.libraries, self.versions, own, machines = set(), {}, set(), set()
        for file in map(pathlib.Path, files):
            text = subprocess.run(["readelf", "--wide", "-h", "-d", "-V", str(file)], check=True, capture_output=True, text=True,
                                  env={"PATH": "/usr/bin:/bin", "LC_ALL": "C"}).stdout
            machines.add(re.search(r"Machine: +(.*)", text).group(1))
            own |= {file.name, *re.findall(r"\(SONAME\).*\[(.*)\]", text)}
            self.libraries |= set(re.findall(r"\(NEEDED\).*\[(.*)\]", text))
            asked = text[text.find("Version needs section"):] if "Version needs section" in text else ""
            for name, version in re.findall(r"Name: ([A-Z]+)_([0-9.]+)\b", asked):
                newest = tuple(map(int, version.split(".")))
                self.versions[name] = max(self.versions.get(name, ()), newest)
        self.libraries -= own
        if len(machines) > 1:
            raise SystemExit(f"elf_needs: files for different processors: {', '.join(sorted(machines))}")

    def others(self):
        """Libraries that not every Linux has."""
        return sorted(name for name in self.libraries - SYSTEM if not LOADER.fullmatch(name))

    def platform_tag(self, machine=None):
        """manylinux_2_N_MACHINE, or linux_MACHINE if other libraries are needed."""
        machine = machine or platform.machine()
        glibc = self.versions.get("GLIBC", (2, 17))
        if self.others():
            return f"linux_{machine}"
        return f"manylinux_{glibc[0]}_{glibc[1]}_{machine}"

    def __str__(self):
        def told(name, title):
            version = self.versions.get(name)
            return f"{title} {'.'.join(map(str, version))}" if version else f"no {title}"
        # GLIBCXX_3.4.N is that of libstdc++.so.6.0.N
        return (f"{told('GLIBC', 'glibc')}, {told('GLIBCXX', 'libstdc++')}; libraries: {' '.join(sorted(self.libraries))}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    print(Needs([file for file in sys.argv[1:] if is_elf(file)]))
