"""Source packages of Debian, for programs that the binary packages lack."""
import os

from harness import run, write

SOURCES = "Types: deb-src\nURIs: http://deb.debian.org/debian\nSuites: {suite}\nComponents: main\n" \
          "Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg\n"


def download(package, suite, folder, *options):
    """The files of a source package in a folder."""
    (folder / "lists/partial").mkdir(parents=True, exist_ok=True)
    write(folder / "source.sources", SOURCES.format(suite=suite))
    (folder / "status").touch()  # apt would look for the source of the package that is installed
    apt = ["apt-get", "-qq", "-o", f"Dir::Etc::SourceList={folder / 'none'}", "-o", f"Dir::Etc::SourceParts={folder}",
           "-o", f"Dir::State::Lists={folder / 'lists'}", "-o", f"Dir::State::Status={folder / 'status'}"]
    run(*apt, "update")
    run(*apt, "source", "--download-only", *options, package, cwd=folder)


def make(folder, *words):
    run("make", f"-j{os.cpu_count()}", *words, cwd=folder)
