# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: exit codes, resume after a kill, several processes, and a .blend that never changes."""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import pty
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy  # noqa: E402

FOLDER = t.temporary_folder()
COMMON = (
    "--for",
    "taaSimplest",
    "--passes",
    "object,depth",
    "--truth-samples",
    "16",
    "--truth-frames",
    "1,4",
)


def digest(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def contents(shot: str) -> dict[str, str]:
    """Digest of every picture of a shot."""
    found = {}
    for kind in ("frames", "truth"):
        for name in sorted(os.listdir(os.path.join(shot, kind))):
            found[f"{kind}/{name}"] = digest(os.path.join(shot, kind, name))
    return found


def said(errors: str) -> list[str]:
    """Lines of standard error from the exporter on; Blender and its own add-ons say things of theirs before."""
    lines = errors.splitlines()
    first = next((n for n, line in enumerate(lines) if line.startswith("error: ")), len(lines))
    return lines[first:]


def without_times(shot: dict) -> dict:
    """shot.json less what depends on the clock and the name of the folder."""
    plain = json.loads(json.dumps(shot))
    plain.pop("name")
    for entry in plain["frames"]:
        entry.pop("render_seconds")
    return plain


def communicated(process: subprocess.Popen) -> tuple[str, str]:
    """Its output and errors once it has ended. One that does not end is killed, and what it had said is told."""
    try:
        return process.communicate(timeout=300)
    except subprocess.TimeoutExpired:
        process.kill()
        raise AssertionError(f"{process.args[-4:]} does not end", *process.communicate())


def make_blend(name: str = "scene.blend", camera: bool = True) -> str:
    scene = t.new_scene(48, 27)
    t.add_sun(scene)
    if camera:
        t.add_camera(scene)
    item = t.add_object(scene, "Cube", None, (0, 0, 0.5))
    item.data.materials.append(t.diffuse("Colour", (0.3, 0.5, 0.7)))
    t.key(item, "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    return t.save(scene, os.path.join(FOLDER, name))


BLEND = make_blend()
BEFORE = digest(BLEND)


def test_wrong_usage_is_2_and_one_line() -> None:
    cases = (
        ((), "--out"),
        (("--out", "x", "--for", "fxa311"), "did you mean 'fxaa311'"),
        (("--out", "x", "--frames", "9-2"), "ends before"),
        (("--out", "x", "--jitter", "haltom"), "unknown sequence"),
        (("--out", "x", "--truth-samples", "0"), "expected 1 to"),
        (("--out", "x", "--passes", "colour"), "unknown pass"),
        (("--out", "x", "--frames", "1-3", "--truth-frames", "7"), "not among --frames"),
        (("--out", "x", "--subsamples", "d3d9", "--passes", "subsamples"), "d3d9"),
        (("--out", "x", "--subsamples", "d3d8"), "no effect"),
        (("--out", "x", "--wrong", "1"), "unknown option --wrong"),
        (("--out", "x", "--trut-samples", "1"), "did you mean --truth-samples?"),
        (("--out", "x", "--sample", "1"), "unknown option --sample; did you mean --samples?"),
        (
            ("--out", "x", "--resolution", "48", "27"),
            "expected WIDTHxHEIGHT in one word, as in 480x270",
        ),
        (("--out", "x", "--resolution", "2x2"), "--resolution: expected 4 to 65536"),
        (("--out", "x", "--samples", "many"), "--samples: expected a whole number, found 'many'"),
        (("--out", "x", "--samples", "1_0"), "--samples: expected a whole number, found '1_0'"),
        (("--out", "x", "--ambient", "0", "nan", "0"), "--ambient: expected a number, found 'nan'"),
        (("--out", "x", "--ambient", "0", "0", "1e999"), "--ambient: expected a number, found"),
        (("--out", "x", "--ambient", "0", "0", "-1"), "--ambient: expected 0.0 to 1000000.0"),
        (("--out", "x", "--mip-bias", "nan"), "--mip-bias: expected a number, found 'nan'"),
        (("--out", "x", "--claim-timeout", "inf"), "--claim-timeout: expected a number"),
        (("--out", "x", "--for", "karis:alpha=nan"), "karis:alpha: expected 0 to 1, found 'nan'"),
        (("--out", "x", "--frames", "1_6"), "--frames: expected frames such as"),
        (("--out", "x", "--frames", "1-9999999999"), "--frames: Blender has no frame beyond"),
        (("--out", "x", "--frames", "1-2", "3"), "unexpected '3'"),
        (("--out", "x", "--frames", "-3--5"), "ends before"),
        (("--out", "x", "--frames", ""), "--frames: expected a value, found an empty text"),
        (("--out", "x", "--frames="), "--frames: expected a value, found an empty text"),
        (("--out", ""), "--out: expected a value"),
        (("--out", "x", "--for", "karis:alfa=1"), "karis has no parameter 'alfa'; known: alpha"),
        (("--out", "x", "--for", "karis:alpha=7"), "karis:alpha: expected 0 to 1, found '7'"),
        (("--out", "x", "--for", "karis:box=best"), "karis:box: expected "),
    )
    script = os.path.join(FOLDER, "cases.py")
    with open(script, "w", encoding="utf-8") as file:  # one Blender for all of them
        file.write(
            "import sys, json\n"
            f"sys.path.insert(0, {os.path.join(t.ROOT, 'blender_addon')!r})\n"
            "from aa_resolve import headless\n"
            f"for options in {[list(case[0]) for case in cases]!r}:\n"
            "    print('CODE', headless.run(options), file=sys.stderr, flush=True)\n"
        )
    done = subprocess.run(
        [bpy.app.binary_path, "-b", "--factory-startup", BLEND, "--python-exit-code", "9", "-P", script],
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    lines = [line for line in done.stderr.splitlines() if line.startswith(("error", "CODE"))]
    assert len(lines) == 2 * len(cases), done.stderr
    for (options, expected), message, code in zip(cases, lines[::2], lines[1::2]):
        assert code == "CODE 2", (options, message, code)
        assert message.startswith("error: ") and expected in message, (options, message)


def test_exit_codes_of_the_process() -> None:
    usage = t.run_headless(BLEND, "--out", os.path.join(FOLDER, "u"), "--for", "nothing")
    assert usage.returncode == 2 and len(said(usage.stderr)) == 1, (usage.returncode, usage.stderr)
    blind = t.run_headless(
        make_blend("blind.blend", camera=False), "--out", os.path.join(FOLDER, "b"), "--frames", "1"
    )
    assert blind.returncode == 3 and "has no camera" in blind.stderr, (
        blind.returncode,
        blind.stderr,
    )
    unwritable = t.run_headless(BLEND, "--out", "/proc/nowhere/shot", "--frames", "1")
    assert unwritable.returncode == 3 and "cannot be made" in unwritable.stderr, unwritable.stderr
    told = t.run_headless(BLEND, "--help")
    assert told.returncode == 0 and "--truth-samples" in told.stdout and "halton23" in told.stdout
    for word in ("This run:", "examples:", "exit codes:", "--resolution WxH", "--yes", "--plan"):
        assert word in told.stdout, (word, told.stdout)
    assert digest(BLEND) == BEFORE


def test_scripts_before_the_exporter_are_part_of_the_scene() -> None:
    """Blender does not notice what a script changes: a shot goes on with the same one, and with no other."""
    script, out = (os.path.join(FOLDER, name) for name in ("tweak.py", "tweaked"))
    wish = ("--out", out, "--frames", "1", "--truth-frames", "none")

    def run(energy: float | None, *options: str) -> subprocess.CompletedProcess:
        command = t.blender_command(BLEND, *wish, *options)
        if energy is not None:
            with open(script, "w", encoding="utf-8") as file:
                file.write(f"import bpy\nbpy.data.objects['Sun'].data.energy = {energy}\n")
            place = command.index("--python-exit-code")
            command[place:place] = ["-P", script]
        return subprocess.run(command, capture_output=True, text=True, timeout=120)

    first = run(2.0)
    assert first.returncode == 0 and "tweak.py" in first.stdout, (first.stdout, first.stderr)
    before = contents(out)
    again = run(2.0)
    assert again.returncode == 0 and "nothing to render" in again.stdout, (
        again.stdout,
        again.stderr,
    )
    for energy in (20.0, None):
        other = run(energy, "--plan")
        assert other.returncode == 2 and "a script that ran on it" in other.stderr, other.stderr
    assert run(20.0, "--same-scene", "--plan").returncode == 0
    assert contents(out) == before


def test_what_counts_as_a_script_before() -> None:
    from aa_resolve.identity import scripts_before

    words = [
        "blender",
        "-b",
        "a.blend",
        "--python-expr",
        "x = 1",
        "--python-text",
        "Text",
        "-P",
        BLEND,
    ]
    found = scripts_before([*words, "-P", t.HEADLESS, "-P", "/after.py", "--", "-P", "/no.py"])
    assert [item.name for item in found] == ["--python-expr", "Text", "scene.blend"], found
    assert found[0].content == b"x = 1" and len(found[2].content) == os.path.getsize(BLEND)
    assert scripts_before(t.blender_command(BLEND, "-P", "x")) == []


def ranged_blend(step: int) -> str:
    """The scene with a range of its own."""
    bpy.ops.wm.open_mainfile(filepath=BLEND)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.frame_step = 3, 8, step
    return t.save(scene, os.path.join(FOLDER, f"range{step}.blend"))


def test_without_frames_the_scene_decides() -> None:
    """Its range and its step, after an estimate; what takes long wants a yes."""
    out, blend = os.path.join(FOLDER, "range"), ranged_blend(2)
    done = t.run_headless(blend, "--out", out, "--truth-samples", "4", "--json")
    assert done.returncode == 0, done.stderr
    events = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    assert "steps of 2" in events[0]["note"] and "--frames 3-8" in events[0]["note"], events[0]
    kinds = [event["event"] for event in events]
    assert kinds.index("missing") < kinds.index("estimate") < kinds.index("frame"), kinds
    cost = events[kinds.index("estimate")]
    assert cost["bytes"] > 0 and cost["seconds"] > 0 and "3 frames" in cost["text"], cost
    assert [event["frame"] for event in events if event["event"] == "frame"] == [3, 5, 7]
    assert all(entry["reset"] for entry in t.read_manifest(out)["frames"])
    again = t.run_headless(blend, "--out", out, "--truth-samples", "4", "--plan")
    assert again.returncode == 0 and "nothing to render" in again.stdout, again.stdout

    long, blend = os.path.join(FOLDER, "long"), ranged_blend(1)
    wish = ("--out", long, "--truth-samples", "1000000")
    # Repeated: the time of small pictures is noise, and what is asked must not hang on it.
    for options in (wish, *[(*wish, "--json")] * 3):
        refused = t.run_headless(blend, *options)
        assert refused.returncode == 2 and len(said(refused.stderr)) == 1, refused.stderr
        assert "--yes" in refused.stderr and "MB" in refused.stderr, refused.stderr
        assert not os.path.exists(long), "nothing is written before a yes"
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        t.blender_command(blend, *wish),
        stdin=theirs, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    os.close(theirs)
    output = ""
    while "Go on? [y/N]" not in output:  # what is typed before the question may be lost
        letter = process.stdout.read(1)
        assert letter, (output, process.stderr.read())
        output += letter
    os.write(ours, b"n\n")
    _, errors = communicated(process)
    os.close(ours)
    assert process.returncode == 1, (output, errors)
    assert "nothing was written" in errors and not os.path.exists(long), errors
    process = subprocess.Popen(
        t.blender_command(blend, *wish, "--yes"), stdout=subprocess.PIPE, text=True
    )
    for line in process.stdout:
        if line.startswith("frame 3"):
            break
    else:
        raise AssertionError("with --yes the export begins")
    process.kill()
    process.wait()
    process.stdout.close()


def test_a_fault_is_one_line() -> None:
    """What should not happen is said on standard error, although Blender's own stream is closed then; so is a full
    disk behind standard output."""
    script = os.path.join(FOLDER, "fault.py")
    with open(script, "w", encoding="utf-8") as file:
        file.write(
            "import sys\n"
            f"sys.path.insert(0, {os.path.join(t.ROOT, 'blender_addon')!r})\n"
            "from aa_resolve import export, headless\n"
            "export.make_plan = lambda *_: {}['missing key']\n"
            f"sys.exit(headless.run(['--out', {os.path.join(FOLDER, 'fault')!r}, '--frames', '1']))\n"
        )
    done = subprocess.run(
        [bpy.app.binary_path, "-b", "--factory-startup", BLEND, "--python-exit-code", "9", "-P", script],
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    lines = said(done.stderr)
    assert done.returncode == 9 and len(lines) == 1, (done.returncode, done.stderr)
    assert "KeyError" in lines[0] and ".py:" in lines[0], lines
    if os.path.exists("/dev/full"):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run(
                t.blender_command(BLEND, "--out", os.path.join(FOLDER, "full"), "--frames", "1"),
                stdout=full, stderr=subprocess.PIPE, text=True, timeout=60,
            )  # fmt: skip
        assert done.returncode != 0, "Python's own code for it, 120, may take the place of ours"
        assert "error: standard output cannot be written: No space" in done.stderr, done.stderr


def test_kill_and_resume() -> None:
    whole, broken = os.path.join(FOLDER, "whole"), os.path.join(FOLDER, "broken")
    done = t.run_headless(BLEND, "--out", whole, "--frames", "1-4", *COMMON, "--json")
    assert done.returncode == 0, done.stderr
    events = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    told = {event["pass"]: event for event in events if event["event"] == "cost"}
    assert {"color", "depth", "motion", "object", "truth"} <= set(told), told
    assert told["color"]["seconds"] > 0 and told["truth"]["bytes"] > 0, told
    assert [event["event"] for event in events if event["event"] in ("frame", "truth", "done")] == [
        "frame", "truth", "frame", "frame", "frame", "truth", "done",
    ]  # fmt: skip
    process = subprocess.Popen(
        t.blender_command(BLEND, "--out", broken, "--frames", "1-4", *COMMON),
        stdout=subprocess.PIPE,
        text=True,
    )
    for line in process.stdout:
        if line.startswith("frame 2"):
            break
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    early = t.read_manifest(broken)
    assert 2 <= len(early["frames"]) < 4, "killed in the middle; what was finished is in shot.json"
    left = t.run_headless(BLEND, "--out", broken, "--frames", "1-4", *COMMON)
    assert left.returncode == 0 and "were finished before" in left.stdout, left.stdout + left.stderr
    assert contents(whole) == contents(broken)
    assert without_times(t.read_manifest(whole)) == without_times(t.read_manifest(broken))
    assert not [name for _, _, names in os.walk(broken) for name in names if ".tmp" in name]
    changed = t.run_headless(BLEND, "--out", broken, "--frames", "1-4", *COMMON, "--period", "8")
    assert (
        changed.returncode == 2 and "--period was 16 and now is 8" in changed.stderr
    ), changed.stderr
    assert contents(whole) == contents(broken)
    damaged = os.path.join(broken, "frames/000003.exr")
    with open(damaged, "r+b") as file:
        file.truncate(1000)
    repaired = t.run_headless(BLEND, "--out", broken, "--frames", "1-4", *COMMON)
    assert repaired.returncode == 0 and contents(whole) == contents(
        broken
    ), "a truncated file is made again"
    replaced = t.run_headless(
        BLEND, "--out", broken, "--frames", "1-2", "--truth-frames", "none", "--overwrite"
    )
    assert replaced.returncode == 0 and sorted(contents(broken)) == [
        "frames/000001.exr",
        "frames/000002.exr",
    ]
    assert digest(BLEND) == BEFORE


def test_interrupt_stops_cleanly() -> None:
    """Ctrl-C and termination, between two pictures and in the middle of a long truth: exit code 1, one line, nothing
    half-finished left, finished frames valid, and soon: Blender itself looks for Ctrl-C once in a step of work.
    """
    cases = (
        (signal.SIGINT, 0.0),
        (signal.SIGINT, 0.05),
        (signal.SIGINT, 1.0),
        (signal.SIGTERM, 1.0),
    )
    for case, (number, delay) in enumerate(cases):
        out = os.path.join(FOLDER, f"interrupted {case}")
        process = subprocess.Popen(
            t.blender_command(BLEND, "--out", out, "--frames", "1-2", "--truth-samples", "100000"),
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        for line in process.stdout:
            if line.startswith("frame 1"):
                break
        time.sleep(delay)
        process.send_signal(number)
        started = time.monotonic()
        try:
            _, errors = communicated(process)
        finally:
            process.kill()
        told = said(errors)
        assert process.returncode == 1, (number, delay, process.returncode, errors)
        assert len(told) == 1 and told[0].startswith("error: stopped"), (number, delay, errors)
        assert time.monotonic() - started < 10.0, (number, delay)
        left = [name for _, _, names in os.walk(out) for name in names]
        assert not [name for name in left if ".tmp" in name], left
        assert not os.listdir(os.path.join(out, ".aa", "claims"))
        assert [entry["frame"] for entry in t.read_manifest(out)["frames"]] == [1]
    assert digest(BLEND) == BEFORE


def test_full_disk_and_resume() -> None:
    """A shot on a disk that is too small: one line, exit code 3, a valid shot, and with more room the rest."""
    out = os.path.join(FOLDER, "small disk")
    os.makedirs(out)
    # By the C library: a small system need not have the programs mount and umount.
    library, place, remount, lazy = ctypes.CDLL(None), os.fsencode(out), 32, 2
    if library.mount(b"tmpfs", place, b"tmpfs", 0, b"size=32k"):
        print("     full disk not tested: mounting one needs root", file=sys.stderr)
        return
    try:
        shot, options = os.path.join(out, "shot"), ("--frames", "1-4", *COMMON)
        full = t.run_headless(BLEND, "--out", shot, *options)
        assert full.returncode == 3 and len(said(full.stderr)) == 1, (full.returncode, full.stderr)
        assert "No space left" in full.stderr, full.stderr
        early = t.read_manifest(shot)
        assert 1 <= len(early["frames"]) < 4, "some are finished"
        for entry in early["frames"]:
            t.read_part(os.path.join(shot, entry["file"]), "color")
        assert not library.mount(b"tmpfs", place, b"tmpfs", remount, b"size=8m")
        resumed = t.run_headless(BLEND, "--out", shot, *options)
        assert resumed.returncode == 0 and "were finished before" in resumed.stdout, resumed.stderr
        assert contents(shot) == contents(os.path.join(FOLDER, "whole"))
        assert not [name for _, _, names in os.walk(shot) for name in names if ".tmp" in name]
    finally:
        assert not library.umount2(place, lazy)


def test_two_processes_share_a_range() -> None:
    shared, alone = os.path.join(FOLDER, "shared"), os.path.join(FOLDER, "whole")
    options = ("--out", shared, "--frames", "1-4", *COMMON, "--json")
    processes = [
        subprocess.Popen(
            t.blender_command(BLEND, *options),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    ]
    rendered = 0
    for process in processes:
        output, errors = communicated(process)
        assert process.returncode == 0, errors
        rendered += json.loads(
            output.splitlines()[-2 if "quit" in output.splitlines()[-1] else -1]
        )["rendered"]
    assert rendered == 6, f"every picture is made once, {rendered} were made"
    assert contents(shared) == contents(alone)
    assert without_times(t.read_manifest(shared)) == without_times(t.read_manifest(alone))


def test_foreign_folder_is_left_alone() -> None:
    folder = os.path.join(FOLDER, "foreign")
    os.makedirs(folder)
    with open(os.path.join(folder, "precious.txt"), "w", encoding="utf-8") as file:
        file.write("mine")
    for extra in ((), ("--overwrite",)):
        done = t.run_headless(BLEND, "--out", folder, "--frames", "1", *extra)
        assert done.returncode == 2 and "not empty" in done.stderr, done.stderr
    assert os.listdir(folder) == ["precious.txt"]


def test_scenes_that_are_refused_or_told() -> None:
    """In this process: two view layers, stereo, panorama; and what is switched off is said."""
    from aa_resolve.errors import SceneError

    def attempt(change) -> str:
        scene = t.new_scene(16, 9)
        camera = t.add_camera(scene)
        t.add_object(scene, "Cube")
        change(scene, camera)
        out = os.path.join(t.temporary_folder(), "s")
        try:
            return " ".join(t.export(out, "--frames", "1", "--truth-frames", "none")["notes"])
        except SceneError as error:
            return f"refused: {error}"

    assert "choose one with --view-layer" in attempt(
        lambda scene, _: scene.view_layers.new("Second")
    )
    assert "stereo" in attempt(lambda scene, _: setattr(scene.render, "use_multiview", True))
    assert "type PANO" in attempt(lambda _, camera: setattr(camera.data, "type", "PANO"))
    assert "motion blur is switched off" in attempt(
        lambda scene, _: setattr(scene.render, "use_motion_blur", True)
    )
    assert "depth of field" in attempt(lambda _, camera: setattr(camera.data.dof, "use_dof", True))
    assert "compositor is switched off" in attempt(lambda scene, _: t.compositor_tree(scene))
    assert "rendered with Cycles" in attempt(
        lambda scene, _: setattr(scene.render, "engine", t.eevee_engine())
    )


if __name__ == "__main__":
    t.main(
        test_wrong_usage_is_2_and_one_line,
        test_exit_codes_of_the_process,
        test_scripts_before_the_exporter_are_part_of_the_scene,
        test_what_counts_as_a_script_before,
        test_without_frames_the_scene_decides,
        test_a_fault_is_one_line,
        test_kill_and_resume,
        test_interrupt_stops_cleanly,
        test_full_disk_and_resume,
        test_two_processes_share_a_range,
        test_foreign_folder_is_left_alone,
        test_scenes_that_are_refused_or_told,
    )
