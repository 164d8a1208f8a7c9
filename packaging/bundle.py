"""Puts the program and every library that it needs into one folder, and that folder into a tar.gz.

python3 packaging/bundle.py BUILD      after `cmake --build BUILD --target bundle_parts`, which `make bundle` does first

Makes BUILD/bundle/aaresolve-VERSION-linux-x64/ and BUILD/aaresolve-VERSION-linux-x64.tar.gz:

    bin/aaresolve            what is called; it starts the program with the newer of the system's libraries and ours
    libexec/aaresolve        the program, whose run path is ../lib
    lib/                     its libraries, unchanged files of this machine's distribution
    lib/aaresolve/           its module for PDF, WebP and GIF, and what that alone needs: X11's libraries are among it,
                             which a graphics driver must find in the system and not here
    lib/unless-newer/        those that a graphics driver may load too: launcher.cpp says why they lie apart
    share/aaresolve/fonts/   the contact sheet's font
    share/man, share/bash-completion, share/zsh, share/fish
                             the manual page and the shells' completion
    share/doc/aaresolve/     this project's pages and the licence of every part

The C library and the dynamic loader stay the system's. Pictures that are neither PNG nor EXR need OpenImageIO, which is
20 times as large as all of this; that module stays out. The same input gives the same bytes; times are those of
SOURCE_DATE_EPOCH, else fixed.
"""

from __future__ import annotations

import gzip
import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Part of the C library, and bound to the kernel and the loader of the system: never taken along.
SYSTEMS = re.compile(
    r"(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|util|mvec|nss_\w+|anl|BrokenLocale))\.so\.\d+$"
)
# Which a graphics driver may load as well: see launcher.cpp. Each with those that must come from the same compiler.
UNLESS_NEWER = {"libstdc++.so.6": ("libgcc_s.so.1",), "libz.so.1": ()}
DOCUMENTS = "aaresolve_documents.so"
FONTS = ("DejaVuSans.ttf", "DejaVuSans-Bold.ttf")
FONT_PACKAGE = "fonts-dejavu-core"
# Read while compiling, of which the program then holds parts.
HEADERS = ("libglm-dev", "nlohmann-json3-dev", "libcli11-dev", "libxxhash-dev", "libvulkan-dev")
PAGES = ("README.md", "CHANGELOG.md", "LICENSE", "docs/methods.md", "docs/install.md")


class Fault(Exception):
    """What is missing here and what to do, in one line."""


def output_of(*command: object) -> str:
    try:
        return subprocess.run(
            [str(word) for word in command], check=True, capture_output=True, text=True
        ).stdout
    except FileNotFoundError:
        raise Fault(f"{command[0]} is missing; install it (a bundle is made on Debian or Ubuntu)")
    except subprocess.CalledProcessError as error:
        raise Fault(f"{' '.join(map(str, command))}: {error.stderr.strip()}")


def libraries(program: Path) -> dict[str, Path]:
    """Soname: file of all that the loader takes in for a program, without the C library's."""
    found = {}
    for line in output_of("ldd", program).splitlines():
        words = line.split()
        if "=>" not in words:
            continue
        if "not found" in line:
            raise Fault(
                f"{program}: {words[0]} is missing on this machine; build the program again"
            )
        if not SYSTEMS.match(words[0]):
            found[words[0]] = Path(words[2]).resolve()
    return found


def package_of(file: Path) -> str:
    """Debian's package that installed a file; /lib and /usr/lib are one folder of which it may know either."""
    for path in (str(file), str(file).removeprefix("/usr")):
        listed = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True)
        if listed.returncode == 0:
            return listed.stdout.split(":")[0]
    raise Fault(f"{file}: of no package, so its licence is not known; use the distribution's own")


def needed_glibc(files: list[Path]) -> str:
    """The highest version of the C library that any of the files asks for."""
    found = set()
    for file in files:
        found |= set(re.findall(r"\bGLIBC_(\d+(?:\.\d+)+)", output_of("objdump", "-T", file)))
    return max(found, key=lambda text: [int(part) for part in text.split(".")])


class Bundle:
    """The folder while it is filled."""

    def __init__(self, build: Path, folder: Path) -> None:
        self.build, self.folder = build, folder
        self.packages: set[str] = set()

    def put(self, source: Path, name: str, mode: int = 0o644) -> None:
        target = self.folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
        target.chmod(mode)

    def put_programs(self) -> None:
        self.put(self.build / "packaging/aaresolve_launcher", "bin/aaresolve", 0o755)
        self.put(self.build / "packaging/aaresolve_bundled", "libexec/aaresolve", 0o755)
        self.put(self.build / DOCUMENTS, f"lib/aaresolve/{DOCUMENTS}")

    def put_libraries(self) -> None:
        found = libraries(self.folder / "libexec/aaresolve")
        apart = {}
        for soname, partners in UNLESS_NEWER.items():
            if soname in found:
                for name in (soname, *partners):
                    apart[name] = f"lib/unless-newer/{found[soname].name}/{name}"
        for soname, file in found.items():
            self.put(file, apart.get(soname, f"lib/{soname}"))
            self.packages.add(package_of(file))
        for soname, file in libraries(self.folder / "lib/aaresolve" / DOCUMENTS).items():
            if soname not in found and soname not in apart:
                self.put(file, f"lib/aaresolve/{soname}")
                self.packages.add(package_of(file))

    def put_fonts(self) -> None:
        for name in FONTS:
            font = Path("/usr/share/fonts/truetype/dejavu") / name
            if not font.exists():
                raise Fault(f"{font} is missing; apt-get install {FONT_PACKAGE}")
            self.put(font, f"share/aaresolve/fonts/{name}")
        self.packages.add(FONT_PACKAGE)

    def put_manual(self) -> None:
        pages = self.build / "pages"
        self.put(pages / "aaresolve.1", "share/man/man1/aaresolve.1")
        self.put(pages / "aaresolve", "share/bash-completion/completions/aaresolve")
        self.put(pages / "_aaresolve", "share/zsh/site-functions/_aaresolve")
        self.put(pages / "aaresolve.fish", "share/fish/vendor_completions.d/aaresolve.fish")

    def put_pages(self) -> None:
        for page in PAGES:
            self.put(ROOT / page, f"share/doc/aaresolve/{page}")
        licences = "share/doc/aaresolve/licences"
        for package in sorted(self.packages | set(HEADERS)):
            text = Path("/usr/share/doc") / package / "copyright"
            if not text.exists():
                raise Fault(f"{text} is missing; apt-get install --reinstall {package}")
            self.put(text, f"{licences}/{package}.txt")
        web = self.build / "resolver/report/web/node_modules"
        cache = (self.build / "CMakeCache.txt").read_text()
        if given := re.search(r"^AA_WEB_PACKAGES:\w+=(.+)$", cache, re.M):
            web = Path(given[1])
        for package in sorted(web.glob("*/package.json")) + sorted(web.glob("@*/*/package.json")):
            name = str(package.parent.relative_to(web)).replace("/", "-").lstrip("@")
            # One of them states its licence in the package's description alone.
            text = next(iter(sorted(package.parent.glob("LICEN[SC]E*"))), package)
            self.put(text, f"{licences}/npm-{name}.txt")


def moment() -> int:
    """Time of every file, seconds since 1970; 1980 is the earliest that a zip can hold."""
    return int(os.environ.get("SOURCE_DATE_EPOCH", "315532800"))


def write_archive(folder: Path, path: Path) -> None:
    """A tar.gz of a folder: sorted, owned by nobody in particular."""

    def neutral(entry: tarfile.TarInfo) -> tarfile.TarInfo:
        entry.mtime = moment()
        entry.uid = entry.gid = 0
        entry.uname = entry.gname = "root"
        entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
        return entry

    temporary = path.with_name(path.name + ".tmp")
    with open(temporary, "wb") as raw:
        with gzip.GzipFile(filename="", mode="wb", fileobj=raw, mtime=moment()) as packed:
            with tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as archive:
                for entry in [folder, *sorted(folder.rglob("*"))]:
                    name = entry.relative_to(folder.parent)
                    archive.add(entry, str(name), recursive=False, filter=neutral)
    os.replace(temporary, path)


def megabytes(count: int) -> str:
    return f"{count / 1e6:.1f} MB"


def main(build: Path) -> None:
    version = output_of(build / "aaresolve", "--version").strip()
    name = f"aaresolve-{version}-linux-x64"
    shutil.rmtree(build / "bundle", ignore_errors=True)
    bundle = Bundle(build, build / "bundle" / name)
    bundle.put_programs()
    bundle.put_libraries()
    bundle.put_fonts()
    bundle.put_manual()
    bundle.put_pages()
    archive = build / f"{name}.tar.gz"
    write_archive(bundle.folder, archive)
    files = [file for file in bundle.folder.rglob("*") if file.is_file()]
    libraries_there = [file for file in files if ".so." in file.name]
    # A system that is older than this gets ours of these, which may ask for more: it is the other that decides.
    always = [file for file in libraries_there if "unless-newer" not in file.parts]
    needed = needed_glibc([bundle.folder / "libexec/aaresolve", *always])
    print(
        f"{bundle.folder}: {megabytes(sum(file.stat().st_size for file in files))},"
        f" {len(libraries_there)} libraries, for x86-64 with glibc {needed} or newer"
    )
    print(f"{archive}: {megabytes(archive.stat().st_size)}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("usage: bundle.py BUILD", file=sys.stderr)
        sys.exit(2)
    try:
        main(Path(sys.argv[1]).resolve())
    except Fault as fault:
        print(f"error: bundle: {fault}", file=sys.stderr)
        sys.exit(3)
