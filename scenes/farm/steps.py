# SPDX-License-Identifier: MIT
"""What the jobs of the workflow do: one call each. A job that is done leaves a small file, its mark, that says so.

usage: steps.py scene | export | truth | run | tool [options] [-- options of the tool]  (the rules of scenes/Snakefile)

What a job was told and what its tools said stands in OUT/logs; a failure ends with one line and the tool's last ones.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reproduce"))

from shots import ROOT, Workshop, build_scene, exporter  # noqa: E402

_PAUSE_SECONDS = 10.0  # between two looks at what another machine's process has begun


def program() -> str:
    """The program: AARESOLVE says which, else that of PATH, else what `make program` has built here."""
    built = ROOT / "build/aaresolve"
    named = os.environ.get("AARESOLVE")
    return named or shutil.which("aaresolve") or (str(built) if built.exists() else "aaresolve")


def blender() -> str:
    """Blender: BLENDER says which, else that of PATH."""
    return os.environ.get("BLENDER", "blender")


def missing_tools() -> list[str]:
    """A line for each tool that is not there."""
    lines = []
    if not shutil.which(blender()):
        lines.append(
            f"Blender: '{blender()}' was not found; install it (apt-get install blender), or let BLENDER name it"
        )
    if not shutil.which(program()):
        lines.append(
            f"aaresolve: '{program()}' was not found; build it (make program), or let AARESOLVE name it"
        )
    return lines


def _mark(path: Path, content: dict) -> None:
    """Writes under a temporary name and renames."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    temporary.write_text(json.dumps(content, indent=1) + "\n")
    temporary.replace(path)


def _scene(a: argparse.Namespace, shop: Workshop) -> None:
    blend = build_scene(shop, _stem(a), a.scene, tuple(a.words), a.size, a.threads)
    _mark(a.mark, {"file": blend.name, "sha256": hashlib.sha256(blend.read_bytes()).hexdigest()})


def _stem(a: argparse.Namespace) -> str:
    return f"{a.name}_{a.size}"


def _export(a: argparse.Namespace, shop: Workshop) -> None:
    """Some frames. A picture that another process has begun is waited for: the job is done when all are there."""
    blend = shop.out / "scenes" / f"{_stem(a)}.blend"
    if not blend.exists():
        raise SystemExit(
            f"{blend}: expected the scene; delete {a.mark.parent}, so that it is made again"
        )
    shot = shop.out / a.name / "shot"
    if a.begins and (shot / "shot.json").exists():
        _mark(a.mark, {"began": "before"})
        return
    what = f"export.{a.name}.{a.mark.name}"
    command = [*exporter(shop, blend, a.threads), "--out", shot, "--json"]
    command += ["--claim-timeout", a.claim_timeout, *a.words]
    while True:
        said = shop.run(what, command)
        done = [
            json.loads(line) for line in said.splitlines() if line.startswith('{"event": "done"')
        ]
        if not done:
            raise SystemExit(
                f"{what}: the exporter did not say that it was done; see {shop.out / 'logs'}"
            )
        if not done[-1]["elsewhere"]:
            break
        print(f"{what}: {done[-1]['elsewhere']} pictures are being made elsewhere", flush=True)
        time.sleep(min(_PAUSE_SECONDS, a.claim_timeout))
    _mark(a.mark, {key: done[-1][key] for key in ("rendered", "skipped", "seconds")})


def _truth(a: argparse.Namespace, shop: Workshop) -> None:
    """Truth of some frames; of a scene at rest the first of these jobs makes the only one."""
    shot = json.loads((shop.out / a.name / "shot/shot.json").read_text())
    if shot["static"] and not a.first:
        _mark(a.mark, {"static": True})
    else:
        _export(a, shop)


def _run(a: argparse.Namespace, shop: Workshop) -> None:
    """All methods on a scene, after a check of its shot; an interrupted run of the same question goes on."""
    shot, run = (shop.out / a.name / part for part in ("shot", "run"))
    shop.run(f"check.{a.name}", [shop.program, "check", shot])
    asked = shop.out / a.name / "asked"
    question = f"{a.words} {hashlib.sha256((shot / 'shot.json').read_bytes()).hexdigest()}"
    goes_on = (run / "results.json").exists() and asked.exists() and asked.read_text() == question
    asked.write_text(question)
    command = [shop.program, "run", shot, "-o", run, "-q", "-j", a.threads, *a.words]
    shop.run(f"run.{a.name}", command + ["--resume"] * goes_on)
    _mark(a.mark, {"results": "results.json"})


def _tool(a: argparse.Namespace, shop: Workshop) -> None:
    """One call of the program that writes a page."""
    shop.run(a.name, [shop.program, *a.words])


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("step", choices=("scene", "export", "truth", "run", "tool"))
    parser.add_argument("--out", type=Path, required=True, help="folder of the study")
    parser.add_argument("--name", required=True, help="of the scene in the study")
    parser.add_argument("--mark", type=Path, help="the file that says that the job is done")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--scene")
    parser.add_argument("--size")
    parser.add_argument("--claim-timeout", type=float, default=900.0)
    parser.add_argument(
        "--begins", action="store_true", help="only to begin a shot that is not there"
    )
    parser.add_argument("--first", action="store_true", help="the first of those with truth")
    ours = argv[: argv.index("--")] if "--" in argv else argv
    a = parser.parse_args(ours, argparse.Namespace(words=argv[len(ours) + 1 :]))
    lacks = missing_tools()
    if lacks:
        raise SystemExit("\n".join(f"{a.step} {a.name}: {line}" for line in lacks))
    shop = Workshop(Path(program()).absolute(), blender(), a.out.absolute(), "")
    steps = {"scene": _scene, "export": _export, "truth": _truth, "run": _run, "tool": _tool}
    steps[a.step](a, shop)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
