"""search.py BUILD PROGRAM [--runs N | --seconds S | --coverage] [--targets a,b] [--jobs J]: the parsers under libFuzzer (preset fuzz, in
BUILD), from whole inputs that PROGRAM, an aaresolve, makes.

Each target keeps what it learnt in BUILD/corpus, so that the next search goes on there. Inputs that break a parser are kept
in BUILD/findings. At the end: executions, findings, and which share of the parsers' lines the corpus reaches.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
TARGETS = [
    *(
        "manifest",
        "notes",
        "results",
        "key",
        "answers",
        "page",
        "layout",
        "angles",
        "method",
        "vary",
        "question",
    ),
    *("parts", "picture", "frame", "truth", "blender", "png"),
]
# What they are there to break, and which of its functions are no part of reading: those whose names hold one of these.
PARSERS = {
    "image/exr.cpp": "",
    "image/exr_header.cpp": "",
    "image/exr_layers.cpp": "",
    "image/exr_lines.cpp": "",
    "image/exr_zip.cpp": "ZipPacker|sortBytes|toDifferences",
    "image/json_text.cpp": "",
    "image/png.cpp": "Writer|codesOf|pngBytes",
    "methods/params.cpp": "Param(Sp|E)|checkTable|wrong|noSuchChoice|real|integer|flag|choice|isGiven|ParamSpec4Type|Params4spec",
    "methods/spec.cpp": "passes|readsEncoded|outputSpace|create",
    "report/page.cpp": "filled|errorColours|figureJson|pageHead|forMarkup",
    "report/survey_questions.cpp": "framesOf|methodsOf|shared|regionOf|joined",
    "report/survey_scores.cpp": "",
    "shot/import/blender_exr.cpp": "wantPlain",
    "shot/import/engine_layout.cpp": "",
    "shot/import/frame.cpp": "",
    "shot/manifest.cpp": "toJson|rowMajor|offsetERK|writeManifest|readManifest|8Manifest4find",
    "shot/reader.cpp": "readCentre",
    "study/results_json.cpp": "toJson|Writer|writeResults",
    "study/survey_files.cpp": "toJson|keyBeside",
    "study/sweep.cpp": "bytesOf|Sweep|sweepVariants|axesOf",
}
PICTURES = {"parts", "picture", "frame", "truth", "blender", "png"}
LIMITS = ["-rss_limit_mb=3000", "-malloc_limit_mb=1500", "-timeout=20", "-print_final_stats=1"]
MOST_FINDINGS = 10
LONGEST = {"text": 16384, "picture": 8192}


def tool(name: str) -> str | None:
    """clang's own tools often carry its version in their names."""
    found = [shutil.which(name)] + [shutil.which(f"{name}-{v}") for v in range(25, 13, -1)]
    return next((path for path in found if path), None)


def words_of(folder: Path) -> list[str]:
    """Names and values that a text is made of, for libFuzzer's dictionary."""
    words: set[str] = set()
    for path in folder.iterdir():
        words |= set(
            re.findall(
                r'"[^"\\]{1,40}"|[A-Za-z][A-Za-z0-9]{2,30}', path.read_text("utf-8", "replace")
            )
        )
    return sorted(words)[:500]


def environment(profile: Path) -> dict[str, str]:
    return os.environ | {
        "LLVM_PROFILE_FILE": str(profile),
        "ASAN_OPTIONS": "allocator_may_return_null=1:detect_leaks=0",
    }


def search(target: str, build: Path, runs: int | None, seconds: int) -> tuple[int, int, str]:
    """Executions, findings and what the last lines said."""
    corpus, findings = build / "corpus" / target, build / "findings" / target
    for folder in (corpus, findings):
        folder.mkdir(parents=True, exist_ok=True)
    dictionary = build / "corpus" / f"{target}.words"
    options = [*LIMITS, f"-artifact_prefix={findings}/"]
    if target not in PICTURES:
        escaped = (
            w.replace("\\", "\\\\").replace('"', '\\"') for w in words_of(build / "seeds" / target)
        )
        dictionary.write_text("".join(f'"{word}"\n' for word in escaped))
        options.append(f"-dict={dictionary}")
    options.append(f"-max_len={LONGEST['picture' if target in PICTURES else 'text']}")
    seeds = build / "seeds" / target
    folders = [str(corpus)] + ([str(seeds)] if seeds.is_dir() else [])
    executed, said = 0, ""
    while len(list(findings.iterdir())) < MOST_FINDINGS:  # a search ends with each
        limit = [f"-runs={runs - executed}"] if runs else [f"-max_total_time={seconds}"]
        done = subprocess.run(
            [str(build / "tests/fuzz/fuzz_target"), target, *options, *limit, *folders],
            capture_output=True,
            text=True,
            errors="replace",
            env=environment(build / f"{target}.profraw"),
        )
        count = re.search(r"number_of_executed_units: *(\d+)", done.stderr)
        executed += int(count[1]) if count else 0
        if done.returncode == 0:
            break
        said += "\n".join(done.stderr.splitlines()[-25:]) + "\n"
        if not count or (runs and executed >= runs):
            break
    return executed, len(list(findings.iterdir())), said


def counts_by_line(segments: list[list]) -> dict[int, int]:
    """Executions of every line that holds code, from llvm-cov's segments (line, column, count, has_count, starts, is_gap)."""
    counts: dict[int, int] = {}
    last: list | None = None
    by_line: dict[int, list[list]] = {}
    for segment in segments:
        by_line.setdefault(segment[0], []).append(segment)
    if not by_line:
        return counts
    for line in range(min(by_line), max(by_line) + 1):
        here = by_line.get(line, [])
        starting = [s for s in here if s[3] and s[4] and not s[5]]
        if starting or (last and last[3]):
            counts[line] = max([s[2] for s in starting] + ([last[2]] if last and last[3] else []))
        last = here[-1] if here else last
    return counts


def reached(build: Path, targets: list[str], show: bool) -> dict[str, tuple[int, int]]:
    """Lines of each parser that the corpora reach, and lines that it has."""
    profile, cover = tool("llvm-profdata"), tool("llvm-cov")
    if not profile or not cover:
        return {}
    raw = []
    for target in targets:
        raw.append(build / f"{target}.profraw")
        folders = [f for f in (build / "corpus" / target, build / "seeds" / target) if f.is_dir()]
        subprocess.run(
            [str(build / "tests/fuzz/fuzz_target"), target, "-runs=0", *LIMITS, *map(str, folders)],
            capture_output=True,
            env=environment(raw[-1]),
        )
    merged = build / "fuzz.profdata"
    subprocess.run([profile, "merge", "-o", merged, *(p for p in raw if p.is_file())], check=True)
    root = HERE.parent.parent / "resolver"
    command = [cover, "export", build / "tests/fuzz/fuzz_target", f"-instr-profile={merged}"]
    told = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)

    def parser_of(path: str) -> str:
        name = os.path.relpath(os.path.normpath(path), root)
        return name if name in PARSERS else ""

    lines = {
        parser_of(f["filename"]): counts_by_line(f["segments"])
        for f in told["data"][0]["files"]
        if parser_of(f["filename"])
    }
    for function in told["data"][0]["functions"]:
        file = parser_of(function["filenames"][0])
        if file and PARSERS[file] and re.search(PARSERS[file], function["name"]):
            regions = function["regions"]
            for line in range(min(r[0] for r in regions), max(r[2] for r in regions) + 1):
                lines[file].pop(line, None)
    if show:
        for file, counts in lines.items():
            print(f"{file}: not reached:", *(n for n, count in counts.items() if not count))
    return {file: (sum(map(bool, counts.values())), len(counts)) for file, counts in lines.items()}


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("build", type=Path)
    parser.add_argument("program", type=Path)
    parser.add_argument("--runs", type=int, help="executions of each target")
    parser.add_argument("--seconds", type=int, help="instead: seconds of each target")
    parser.add_argument(
        "--coverage", action="store_true", help="no search: what the corpus reaches"
    )
    parser.add_argument("--unreached", action="store_true", help="name the lines that it does not")
    parser.add_argument("--targets", default=",".join(TARGETS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    o = parser.parse_args()
    build = o.build.resolve()
    targets = o.targets.split(",")
    if unknown := [t for t in targets if t not in TARGETS]:
        parser.error(f"unknown target {', '.join(unknown)}; there are {', '.join(TARGETS)}")
    subprocess.run(
        [sys.executable, HERE / "fuzz.py", o.program, "--seeds", build / "seeds"],
        check=True,
    )
    subprocess.run(
        [build / "tests/fuzz/fuzz_target", "--seeds", build / "seeds"],
        check=True,
        env=environment(build / "no.profraw"),
    )
    broken = 0
    if not o.coverage:
        with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
            results = pool.map(lambda t: (t, *search(t, build, o.runs, o.seconds or 60)), targets)
            for target, runs, findings, said in results:
                broken += findings
                print(f"{target:9} {runs:9} executions, {findings} findings", flush=True)
                if said:
                    print(said, flush=True)
    table = reached(build, targets, o.unreached)
    for file, (covered, lines) in table.items():
        print(
            f"{file:32} {covered:4} of {lines:4} lines reached, {100 * covered / max(lines, 1):.1f} %"
        )
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
