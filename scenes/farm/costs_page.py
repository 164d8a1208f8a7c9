# SPDX-License-Identifier: MIT
"""docs/results/farm-costs.md and the hours in docs/farm.md, from farm-costs.json."""

from __future__ import annotations

from pathlib import Path

from nodes import Job, wall_seconds
from page import Page, code

BEGIN, END = "<!-- begin: make farm-costs -->", "<!-- end: make farm-costs -->"
NODES = (1, 8, 100)
CORES = 16  # of a node
_QUIET = 0.25  # processors that others keep busy


def line(points: list[tuple[float, float]], at: float) -> float:
    """The line through two points (x, y), none of whose parts is below 0."""
    (x0, y0), (x1, y1) = points
    slope = max(0.0, (y1 - y0) / (x1 - x0))
    return max(0.0, y1 - slope * x1) + slope * at


class Costs:
    """Processor seconds of a shot's pictures at its size."""

    def __init__(self, shot: dict, document: dict) -> None:
        self.shot = shot
        self.sizes = [_pixels(*map(int, s.split("x"))) for s in document["sizes"]]
        self.found = [shot["seconds"][s] for s in document["sizes"]]
        self.samples = document["samples"]
        self.pixels = _pixels(*shot["size"])
        self.start = shot["start"]

    def picture(self, kind: str) -> float:
        """A frame or a centre picture."""
        points = [(size, found[kind]) for size, found in zip(self.sizes, self.found)]
        return line(points, self.pixels)

    def per_sample(self) -> float:
        """Truth's seconds per pixel and sample of one half."""
        few, many = self.found[-1]["truth"]
        return (many - few) / (2 * (self.samples[1] - self.samples[0]) * self.sizes[-1])

    def truth(self, samples: int) -> float:
        """Both halves: what is there without samples grows with the pixels, the rest with both."""
        rest = []
        for size, found in zip(self.sizes, self.found):
            points = list(zip(self.samples, found["truth"]))
            rest.append((size, line(points, 0)))
        return line(rest, self.pixels) + 2 * samples * self.per_sample() * self.pixels


def _pixels(width: int, height: int) -> int:
    return width * height


def jobs_of(document: dict) -> dict[str, list[Job]]:
    """The study's jobs by shot, as scenes/Snakefile has them with a frame a job, each behind those that it waits for. A
    shot that is lent its truth stands behind its lender."""
    scenes: dict[tuple, Job] = {}
    truths: dict[str, list[Job]] = {}
    found = {}
    for name, shot in document["shots"].items():
        cost, count = Costs(shot, document), shot["pictures"]
        key = (shot["scene"], *shot["size"])
        jobs = [] if key in scenes else [Job(document["scenes"][shot["scene"]])]
        scene = scenes.setdefault(key, *jobs)
        frames, centres = count["frames"], count.get("centre", 0)
        for n in range(frames):
            seconds = cost.start + cost.picture("frames")
            seconds += cost.picture("centre") if n < centres else 0.0
            jobs.append(Job(seconds, [scene] if n == 0 else [begun]))
            begun = jobs[-1] if n == 0 else begun
        rendered = [job for job in jobs if job is not scene]
        own = count.get("truth", 0)
        truths[name] = [
            Job(cost.start + cost.truth(shot["truthSamples"]), [rendered[n]]) for n in range(own)
        ]
        judged = document["judging"]["nsPerPixel"] * 1e-9 * shot["methods"] * frames * cost.pixels
        lent = truths[shot["truthOf"]] if shot["truthOf"] else []
        run = Job(judged, [*rendered, *truths[name], *lent])
        found[name] = [*jobs, *truths[name], run]
    return found


def hours_in_words(seconds: float) -> str:
    return f"{seconds / 3600:.1f} h" if seconds >= 3600 else f"{seconds / 60:.0f} min"


def hours(document: dict) -> list[str]:
    """What stands between the marks of docs/farm.md."""
    by_shot = jobs_of(document)
    jobs = [job for of_shot in by_shot.values() for job in of_shot]
    total, shots = sum(job.seconds for job in jobs), document["shots"].values()
    least = wall_seconds(jobs)
    pictures = sum(sum(shot["pictures"].values()) for shot in shots)
    blender = next(iter(shots))["blender"]
    page = Page("")
    page.say(
        f"The theses' tables at their published sizes (`make reproduce FULL=1`) are {len(shots)} rendered shots of "
        f"{len(document['scenes'])} scenes, {pictures:,} pictures in {len(jobs):,} jobs, when each has one frame. From costs measured per "
        f"picture, pixel and sample on one core of {document['machine']['processor']} with Blender {blender}, they take "
        f"**{total / 3600:.1f} core hours**:"
    )
    rows = []
    for nodes in NODES:
        wall = wall_seconds(jobs, nodes * CORES)
        busy = total / (wall * nodes * CORES)
        rows.append([str(nodes), str(nodes * CORES), hours_in_words(wall), f"{100 * busy:.0f} %"])
    page.table(["nodes", "cores", "wall time", "cores that are busy"], rows)
    longest = max(jobs, key=lambda job: job.seconds)
    scene = next(document["shots"][n]["scene"] for n, own in by_shot.items() if longest in own)
    page.say(
        f"A job has one core, a node {CORES}. However many there are, it takes {hours_in_words(least)}: scene, first frame, frame, truth and "
        f"run wait for one another, and the longest job, the truth of `{scene}`, takes {hours_in_words(longest.seconds)}; more `threads` for "
        "the truth's jobs make it shorter. Not counted: waiting in the queue. Scene by scene: [results/farm-costs.md]"
        "(results/farm-costs.md), made by `make farm-costs`."
    )
    return page.lines[2:]


def write_page(document: dict, docs: Path) -> None:
    by_shot = jobs_of(document)
    page = Page("What the full study costs")
    page.say(
        "Made by `scenes/farm/costs.py` (`make farm-costs`) from [farm-costs.json](farm-costs.json); do not edit.",
        f"{document['machine']['processor']}, {document['machine']['system']}. Processor seconds of one thread. {_load(document, by_shot)} Each shot was measured at {' and '.join(document['sizes'])} and by "
        f"{' and '.join(map(str, document['samples']))} samples of truth; a line through both gives the full size's.",
        "Hours on many nodes: [farm.md](../farm.md).",
    )
    page.heading("Scene by scene")
    page.say(
        "A picture is a jittered frame, the same at pixel centres with its sub-samples, or a truth of two halves. Start: Blender, "
        "the file and its check, once a job. µs: of truth, per pixel and sample; its samples are those of each half."
    )
    rows = []
    for scene, building in document["scenes"].items():
        names = [n for n, shot in document["shots"].items() if shot["scene"] == scene]
        shots = [document["shots"][n] for n in names]
        with_truth = [shot for shot in shots if shot["pictures"].get("truth")]
        each = [1e6 * Costs(shot, document).per_sample() for shot in with_truth]
        seconds = sum(job.seconds for n in names for job in by_shot[n])
        pictures = sum(n for shot in shots for kind, n in shot["pictures"].items())
        rows.append(
            [
                code(scene),
                str(len(shots)),
                f"{pictures}",
                str(sum(shot["pictures"]["truth"] for shot in with_truth) or "–"),
                f"{building:.1f}",
                f"{sum(shot['start'] for shot in shots) / len(shots):.1f}",
                f"{sum(each) / len(each):.2f}" if each else "–",
                f"{seconds / 3600:.2f}",
            ]
        )
    rows.sort(key=lambda row: -float(row[-1]))
    page.table(
        ["scene", "shots", "pictures", "truths of them", "building, s", "start, s", "µs", "core hours"], rows
    )  # fmt: skip
    runs = sum(jobs[-1].seconds for jobs in by_shot.values())
    judging = document["judging"]
    page.say(
        f"{runs / 3600:.2f} of these hours are the methods' runs with their figures, each method once a shot: {judging['nsPerPixel']:.0f} "
        f"ns per method, frame and pixel ({judging['methods']} methods on {judging['frames']} frames of {judging['size']}). Analytic scenes are left out."
    )
    page.heading("How well the lines hold")
    page.say("The same pictures at their full size, measured and as the lines say, in seconds.")
    page.table(["shot", "picture", "measured", "by the lines"], checks(document))
    page.write(docs / "farm-costs.md")
    study = docs.parent / "farm.md"
    before, rest = study.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    text = "\n".join([before + BEGIN, "", *hours(document), END]) + after
    study.write_text(text, encoding="utf-8")


def _load(document: dict, by_shot: dict[str, list[Job]]) -> str:
    """How busy others kept the machine: that lengthens processor time as well, by what they share of its memory."""
    seconds = {name: sum(job.seconds for job in jobs) for name, jobs in by_shot.items()}
    busy = {name: shot["othersBusy"] for name, shot in document["shots"].items()}
    quiet = sum(s for name, s in seconds.items() if busy[name] <= _QUIET) / sum(seconds.values())
    return (
        f"Shots that make {100 * quiet:.0f} % of the hours were measured while other programs kept at most {_QUIET} "
        f"of {document['machine']['cores']} processors busy, the rest while they kept up to {max(busy.values()):.1f}, "
        "which lengthens processor time too."
        if quiet < 1
        else f"Other programs kept at most {max(busy.values()):.1f} of {document['machine']['cores']} processors busy."
    )


def checks(document: dict) -> list[list[str]]:
    rows = []
    for name, check in document["checks"].items():
        cost = Costs(document["shots"][name], document)
        (size, found), samples = *check["seconds"].items(), document["checkSamples"][0]
        for kind, seconds in found.items():
            truth = kind == "truth"
            what = {"frames": "frame", "centre": "centre", "truth": f"truth, {samples} samples"}[
                kind
            ]
            said = cost.truth(samples) if truth else cost.picture(kind)
            rows.append(
                [code(name), what, f"{seconds[0] if truth else seconds:.2f}", f"{said:.2f}"]
            )
    return rows
