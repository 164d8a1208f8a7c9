"""Writes the table of docs/metrics.md: write_page.py PROGRAM PAGE."""

import subprocess
import sys
from pathlib import Path

FIRST, LAST = "<!-- from the program -->\n", "<!-- end -->\n"


def main(program: str, page: Path) -> None:
    command = [program, "list", "--metrics", "--markdown"]
    table = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    before, rest = page.read_text(encoding="utf-8").split(FIRST)
    after = rest.split(LAST)[1]
    page.write_text(before + FIRST + table + LAST + after, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
