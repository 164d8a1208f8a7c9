"""Measures facts.py in several Blenders and writes their table between the two marks of docs/blenders.md.

    python3 tests/blenders/facts_table.py [--suites host trixie sid] [--print]

`host` is the Blender of BLENDER or PATH; the others come from debian.py. A Blender that cannot be had is an error here: the
page would lose its column.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import debian

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/addon"))

import in_blender  # noqa: E402

PAGE = ROOT / "docs/blenders.md"
BEGIN, END = "<!-- facts: make blender-facts -->", "<!-- end of facts -->"


def measured(path: str) -> tuple[str, list[dict]]:
    """Version and facts of one Blender."""
    script = ROOT / "tests/blenders/facts.py"
    words = [path, "-b", "--factory-startup", "--python-exit-code", "9", "-P", script]
    done = subprocess.run(
        [str(word) for word in words],
        capture_output=True,
        text=True,
        timeout=900,
        env=in_blender.environment(),
    )
    facts = [json.loads(line[5:]) for line in done.stdout.splitlines() if line.startswith("FACT ")]
    version = re.search(r'^BLENDER "([^" ]+)', done.stdout, re.MULTILINE)
    if done.returncode or not facts or not version:
        sys.exit(f"facts: {path} ended with {done.returncode}\n{done.stderr[-2000:]}")
    return version[1], facts


def table(columns: list[tuple[str, list[dict]]]) -> str:
    """One section per group of facts; a row is bold where the exporter would be another one if it were otherwise."""
    lines: list[str] = []
    group = ""
    for row in zip(*(facts for _version, facts in columns)):
        first, values = row[0], [entry["value"].replace("|", "\\|") for entry in row]
        if first["group"] != group:
            group = first["group"]
            heads = [version for version, _facts in columns]
            lines += ["", f"### {group[0].upper()}{group[1:]}", ""]
            lines += [f"| | {' | '.join(heads)} | | what rests on it |"]
            lines += ["|---" * (len(heads) + 3) + "|"]
        question = f"**{first['question']}**" if first["decides"] else first["question"]
        if len(set(values)) == 1:  # said once
            cells, same = [values[0], *["same"] * (len(values) - 1)], "same"
        else:
            cells, same = values, "**differs**"
        lines.append(f"| {question} | {' | '.join(cells)} | {same} | {first['depends']} |")
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--suites", nargs="*", default=["host", *debian.SUITES])
    parser.add_argument("--print", action="store_true", help="do not write the page")
    a = parser.parse_args()
    columns = []
    for suite in a.suites or ["host", *debian.SUITES]:
        try:
            path = in_blender.blender() if suite == "host" else str(debian.get(suite))
        except debian.CannotBeHad as reason:
            sys.exit(f"facts: {suite} cannot be had: {reason}")
        columns.append(measured(path))
    for version, facts in columns:
        for entry in facts:
            if entry["value"].startswith("not measured"):
                sys.exit(f"facts: {version}: {entry['question']}: {entry['value']}")
    versions = ", ".join(version for version, _facts in columns)
    said = f"Measured on {datetime.date.today()} in Blender {versions}.\n{table(columns)}\n"
    if a.print:
        print(said)
        return 0
    head, rest = PAGE.read_text().split(BEGIN)
    tail = rest.split(END)[1]
    fresh = PAGE.with_suffix(f".{os.getpid()}")
    fresh.write_text(f"{head}{BEGIN}\n{said}\n{END}{tail}")
    fresh.replace(PAGE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
