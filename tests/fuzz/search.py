"""search.py BUILD [--runs N | --seconds S] [--targets a,b] [--jobs J]: the parsers under libFuzzer (preset fuzz, in BUILD).

Each target starts from whole inputs of the program itself and keeps what it learnt in BUILD/corpus, so that the next search
goes on there. Inputs that break a parser are kept in BUILD/findings. At the end: executions, findings, and which share of
the parsers' lines the corpus reaches.
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
TARGETS = {  # what each is there to break
    "manifest": ["shot/manifest.cpp"],
    "notes": ["shot/manifest.cpp"],
    "results": ["study/results_json.cpp"],
    "key": ["study/survey_files.cpp"],
    "answers": ["study/survey_files.cpp"],
    "method": ["methods/spec.cpp", "methods/params.cpp"],
    "vary": ["study/sweep.cpp"],
    "question": ["report/survey_questions.cpp"],
    "parts": ["image/exr.cpp"],
    "frame": ["shot/reader.cpp"],
    "truth": ["shot/reader.cpp"],
    "blender": ["shot/import/blender_exr.cpp", "shot/import/frame.cpp"],
    "png": ["image/png.cpp"],
}
TEXTS = {"manifest", "notes", "results", "key", "answers", "method", "vary", "question"}
LIMITS = ["-rss_limit_mb=3000", "-malloc_limit_mb=1500", "-timeout=20", "-print_final_stats=1"]
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


def search(target: str, build: Path, limit: list[str]) -> tuple[int, int, str]:
    """Executions, findings and what the last lines said."""
    corpus, findings = build / "corpus" / target, build / "findings" / target
    for folder in (corpus, findings):
        folder.mkdir(parents=True, exist_ok=True)
    dictionary = build / "corpus" / f"{target}.words"
    options = [*LIMITS, *limit, f"-artifact_prefix={findings}/"]
    if target in TEXTS:
        escaped = (
            w.replace("\\", "\\\\").replace('"', '\\"') for w in words_of(build / "seeds" / target)
        )
        dictionary.write_text("".join(f'"{word}"\n' for word in escaped))
        options.append(f"-dict={dictionary}")
    options.append(f"-max_len={LONGEST['text' if target in TEXTS else 'picture']}")
    seeds = build / "seeds" / target
    folders = [str(corpus)] + ([str(seeds)] if seeds.is_dir() else [])
    done = subprocess.run(
        [str(build / "tests/fuzz/fuzz_target"), target, *options, *folders],
        capture_output=True,
        text=True,
        errors="replace",
        env=os.environ
        | {
            "LLVM_PROFILE_FILE": str(build / f"{target}.profraw"),
            "ASAN_OPTIONS": "allocator_may_return_null=1",
        },
    )
    count = re.search(r"number_of_executed_units: *(\d+)", done.stderr)
    said = "" if done.returncode == 0 else "\n".join(done.stderr.splitlines()[-25:])
    return int(count[1]) if count else 0, len(list(findings.iterdir())), said


def reached(build: Path, targets: list[str]) -> dict[str, tuple[int, int]]:
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
            env=os.environ | {"LLVM_PROFILE_FILE": str(raw[-1])},
        )
    merged = build / "fuzz.profdata"
    subprocess.run([profile, "merge", "-o", merged, *(p for p in raw if p.is_file())], check=True)
    root = HERE.parent.parent / "resolver"
    files = sorted({root / f for target in targets for f in TARGETS[target]})
    told = subprocess.run(
        [
            cover,
            "export",
            build / "tests/fuzz/fuzz_target",
            f"-instr-profile={merged}",
            "-summary-only",
            *files,
        ],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return {
        str(Path(f["filename"]).relative_to(root)): (
            f["summary"]["lines"]["covered"],
            f["summary"]["lines"]["count"],
        )
        for f in json.loads(told)["data"][0]["files"]
    }


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("build", type=Path)
    parser.add_argument("--runs", type=int, help="executions of each target")
    parser.add_argument("--seconds", type=int, help="instead: seconds of each target")
    parser.add_argument("--targets", default=",".join(TARGETS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    o = parser.parse_args()
    build = o.build.resolve()
    targets = o.targets.split(",")
    if unknown := [t for t in targets if t not in TARGETS]:
        parser.error(f"unknown target {', '.join(unknown)}; there are {', '.join(TARGETS)}")
    subprocess.run(
        [sys.executable, HERE / "fuzz.py", build / "aaresolve", "--seeds", build / "seeds"],
        check=True,
    )
    limit = [f"-runs={o.runs}"] if o.runs else [f"-max_total_time={o.seconds or 60}"]
    broken = 0
    with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        results = pool.map(lambda t: (t, *search(t, build, limit)), targets)
        for target, runs, findings, said in results:
            broken += findings
            print(f"{target:9} {runs:9} executions, {findings} findings", flush=True)
            if said:
                print(said, flush=True)
    for file, (covered, lines) in reached(build, targets).items():
        print(
            f"{file:32} {covered:4} of {lines:4} lines reached, {100 * covered / max(lines, 1):.1f} %"
        )
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
