# SPDX-License-Identifier: MIT
"""The published tables as data: scenes/experiments/*.toml, one file per table, and protocols.toml.

A file says which shots a table needs, how it was measured (its protocol), what was published, and which claims its
source makes. Nothing here knows a table by name.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from pathlib import Path

try:
    import tomllib
except ImportError:  # Python before 3.11
    import tomli as tomllib

from shots import ROOT, Shot

FOLDER = ROOT / "scenes/experiments"
KINDS = (
    "table", "ghosts", "fourier", "reference size", "cost", "options", "series", "rates", "variants", "codes",
)  # fmt: skip


@dataclass(frozen=True)
class Protocol:
    """How a source measured."""

    says: str = ""
    flags: tuple[str, ...] = ()  # of `aaresolve run`
    codes: float = 1.0  # mse is in units of 1 / codes^2, rmse of 1 / codes
    methods: dict[str, str] = field(default_factory=dict)  # the source's names -> our methods
    shots: dict[str, str] = field(default_factory=dict)  # the source's names -> shot; else "main"
    reference: str = ""  # the method that stood for the truth, by the source's name
    beside: tuple[str, ...] = ()  # further methods, shown with those of the table
    parts: tuple[
        str, ...
    ] = ()  # parts of a method off or read otherwise: for the reasons of what differs


@dataclass(frozen=True)
class Claim:
    """What a source says of a table: one test, by its keyword, of names of the table."""

    says: str
    test: str
    of: object
    options: dict


@dataclass(frozen=True)
class Experiment:
    """One published table."""

    key: str
    kind: str
    source: str
    table: str
    title: str
    says: str
    protocol: Protocol
    shots: dict[str, str] = field(default_factory=dict)  # its own names -> names of the catalogue
    methods: dict[str, str] = field(default_factory=dict)
    published: dict = field(default_factory=dict)
    claims: tuple[Claim, ...] = ()
    regions: dict = field(default_factory=dict)
    options: tuple[dict, ...] = ()
    rows: tuple[
        dict, ...
    ] = ()  # of a table of written pictures: name, method, flags of `run`, file format
    crop: dict = field(
        default_factory=dict
    )  # of its picture: part of the width and height, whether contrast is stretched, of what
    moment: tuple[int, ...] = ()  # first and last frame of what happens in a series
    says_of: dict[str, tuple[str, ...]] = field(
        default_factory=dict
    )  # further words of its shots' exports
    on: tuple[str, ...] = ()  # shots of the catalogue that the studies use, too

    @property
    def label(self) -> str:
        return f"[{self.source}, {self.table}]"

    def shot_of(self, name: str) -> str:
        """Name in the catalogue of the shot from which a method's samples come."""
        return self.shots[self.protocol.shots.get(name, "main")]

    def texts(self) -> list[str]:
        """All methods that are run on its main shot: those of the table and those beside."""
        names = [n for n in self.methods if self.protocol.shots.get(n, "main") == "main"]
        return list(dict.fromkeys([*(self.methods[n] for n in names), *self.protocol.beside]))


class BadExperiment(Exception):
    """One line: the file, what was expected, what was found."""


TESTS = (
    "better", "near", "best", "between", "less_than_half", "more_flicker", "less_ghost", "exact_at_best",
    "changes_below", "changes_more", "better_than_in", "worse_than_still", "costs", "cheapest", "above_by",
    "dips", "above_in_moment", "reaches", "better_shot", "lower",
)  # fmt: skip
_SHOT_FIELDS = {f.name for f in fields(Shot)} - {"name", "methods", "serves"}
_KEYS = {
    "kind", "source", "table", "title", "says", "protocol", "shots", "methods", "published", "claims", "regions",
    "options", "on", "moment", "rows", "crop",
}  # fmt: skip


def load(catalogue: dict[str, Shot]) -> dict[str, Experiment]:
    """All experiments, in the order of their tables. Their shots join the catalogue: one that is there already with
    the same pictures is shared, and then serves the methods of both."""
    protocols = {}
    for name, table in _read(FOLDER / "protocols.toml").items():
        _only(FOLDER / "protocols.toml", table, {f.name for f in fields(Protocol)})
        lists = {k: tuple(table.get(k, ())) for k in ("flags", "beside", "parts")}
        protocols[name] = Protocol(**{**table, **lists})
    found = {}
    for path in sorted(FOLDER.glob("*.toml"), key=_order):
        if path.name != "protocols.toml":
            found[path.stem] = _experiment(path, protocols, catalogue)
    for name, shot in catalogue.items():  # a lent truth has its borrower's size
        if shot.truth_of:
            catalogue[name] = replace(shot, published_size=catalogue[shot.truth_of].published_size)
    return found


def _order(path: Path) -> list:
    """5.2 before 5.10."""
    words = path.stem.replace("-", ".").split(".")
    return [(int(w), "") if w.isdigit() else (1 << 30, w) for w in words]


def _read(path: Path) -> dict:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise BadExperiment(f"{path}: {error}") from None


def _only(path: Path, table: dict, known: set[str]) -> None:
    for key in table:
        if key not in known:
            raise BadExperiment(f"{path}: unknown key '{key}'; known: {', '.join(sorted(known))}")


def _experiment(
    path: Path, protocols: dict[str, Protocol], catalogue: dict[str, Shot]
) -> Experiment:
    data = _read(path)
    _only(path, data, _KEYS)
    for key in ("kind", "source", "table", "title", "says", "protocol"):
        if key not in data:
            raise BadExperiment(f"{path}: expected the key '{key}'")
    if data["kind"] not in KINDS:
        raise BadExperiment(f"{path}: kind: expected {', '.join(KINDS)}, found '{data['kind']}'")
    if data["protocol"] not in protocols:
        raise BadExperiment(
            f"{path}: protocol: expected {', '.join(protocols)}, found '{data['protocol']}'"
        )
    protocol = protocols[data["protocol"]]
    methods = {**protocol.methods, **data.get("methods", {})}
    if "methods" in data:  # those of the table alone, and no anti-aliasing, over which gains are
        base = {n: t for n, t in protocol.methods.items() if n == "No AA"}
        methods = {**base, **data["methods"]}
    found = Experiment(
        path.stem, data["kind"], data["source"], data["table"], data["title"], data["says"], protocol,
        methods=methods, published=data.get("published", {}),
        claims=tuple(_claim(path, c) for c in data.get("claims", ())),
        regions=data.get("regions", {}), options=tuple(data.get("options", ())), on=tuple(data.get("on", ())),
        moment=tuple(data.get("moment", ())), rows=tuple(data.get("rows", ())), crop=data.get("crop", {}),
    )  # fmt: skip
    shots: dict[str, str] = {}
    for own, wish in data.get("shots", {}).items():
        _only(path, wish, _SHOT_FIELDS)
        found.says_of[own] = tuple(wish.get("export", ()))
        shots[own] = _join(path, own, dict(wish), shots, found, catalogue)
    for name in found.on:
        if name not in catalogue:
            raise BadExperiment(f"{path}: on: no shot '{name}'; known: {', '.join(catalogue)}")
        texts = [o[k] for o in found.options for k in ("with", "without")]
        texts += [row["method"] for row in found.rows]
        catalogue[name] = _serving(catalogue[name], texts)
    return replace(found, shots=shots)


def _claim(path: Path, table: dict) -> Claim:
    tests = [k for k in table if k in TESTS]
    if len(tests) != 1:
        raise BadExperiment(
            f"{path}: a claim: expected one of {', '.join(TESTS)}, found {list(table)}"
        )
    rest = {k: v for k, v in table.items() if k not in ("says", tests[0])}
    return Claim(table["says"], tests[0], table[tests[0]], rest)


def _serving(shot: Shot, texts: list[str]) -> Shot:
    """The shot with the passes that these methods read, too."""
    return replace(shot, serves=" ".join(dict.fromkeys([*shot.serves.split(), *texts])))


def _join(
    path: Path, own: str, wish: dict, shots: dict[str, str], experiment: Experiment, catalogue: dict[str, Shot]
) -> str:  # fmt: skip
    """Finds or adds one of an experiment's shots; returns its name in the catalogue."""
    for key in ("variant", "size", "quick_size", "published_size", "export"):
        if key in wish:
            wish[key] = tuple(wish[key])
    if wish.get("truth_of"):
        wish["truth_of"] = shots[wish["truth_of"]]
    # The short form has fewer samples; fewer frames would be another table.
    wish.setdefault("quick_frames", wish.get("frames", 16))
    places = experiment.protocol.shots
    texts = [t for n, t in experiment.methods.items() if places.get(n, "main") in (own, "")]
    if own == "main" or experiment.kind in ("reference size", "variants"):
        texts += [*experiment.texts(), *experiment.protocol.parts]
    shot = Shot(name="", methods="", serves=" ".join(dict.fromkeys(["noaa", *texts])), **wish)
    base = "_".join([shot.scene, *(v.strip("-") for v in shot.variant)]).replace(" ", "_")
    for name, other in catalogue.items():
        if name.split(".")[0] == base and _same_pictures(shot, other):
            merged = replace(
                _serving(other, texts),
                pattern=other.pattern or shot.pattern,
                truth_samples=max(other.truth_samples, shot.truth_samples),
                quick_truth_samples=max(other.quick_truth_samples, shot.quick_truth_samples),
                published_size=other.published_size or shot.published_size,
            )
            catalogue[name] = merged
            return name
    parts = [base]
    if shot.jitter == "none":
        parts.append(f"s{shot.pattern.removeprefix('d3d')}")
    elif shot.jitter not in ("thesis", "halton23"):
        parts.append(shot.jitter)
    parts += ["pre"] * (shot.jitter_projection == "pre")
    parts += [f"truth{shot.truth_samples}"] * shot.own_truth
    parts += ["timing"] * (not shot.truth)
    parts += ["_".join(w.removeprefix("--") for w in shot.export)] * bool(shot.export)
    if ".".join(parts) in catalogue:
        parts.append(f"{shot.frames}frames")
    name = ".".join(parts)
    if name in catalogue:
        raise BadExperiment(f"{path}: shots.{own}: the shot {name} is another one already")
    catalogue[name] = replace(shot, name=name)
    return name


def _same_pictures(a: Shot, b: Shot) -> bool:
    """Whether one export can serve both."""
    alike = (
        "scene", "variant", "jitter", "jitter_projection", "period", "frames", "quick_frames", "first", "size",
        "quick_size", "truth", "truth_of", "truth_frames", "own_truth", "export",
    )  # fmt: skip
    if any(getattr(a, key) != getattr(b, key) for key in alike):
        return False
    if a.own_truth and a.truth_samples != b.truth_samples:
        return False
    sizes = {s.published_size for s in (a, b)} - {None}
    patterns = {s.pattern for s in (a, b)} - {""}
    return len(sizes) <= 1 and len(patterns) <= 1
