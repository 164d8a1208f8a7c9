"""How debian.py makes, keeps and removes systems, with a mmdebstrap that makes a tiny one: no network, seconds."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
DEBIAN = HERE / "debian.py"
# Stands for the real one: a system with a shell and a `blender` that tells what it was given. The folder is the word
# before the last; it writes `begun`, waits for `go` beside the cache where told to, and counts its calls.
MMDEBSTRAP = """#!/bin/sh
for word; do [ "${{word#deb }}" = "$word" ] && root=$word || source=$word; done
echo "$source" >>"{folder}/calls"
mkdir -p "$root"
: >"{folder}/begun"
while [ -e "{folder}/wait" ]; do sleep 0.05; done
cd "$root" && mkdir -p usr/bin bin proc sys dev root tmp etc/apt/apt.conf.d
for file in $(for tool in sh env sleep; do command -v $tool; ldd $(command -v $tool) | grep -o '/[^ )]*'; done | sort -u); do
    mkdir -p ".$(dirname $file)" && cp -L $file ".$file"
done
[ -e bin/sh ] || cp usr/bin/sh bin/sh
printf '%s\\n' '#!/bin/sh' 'case $1 in' '--version) echo Blender 9.8.7 ;;' '*) {body} ;;' 'esac' >usr/bin/blender
chmod +x usr/bin/blender
"""
CAN_ENTER = subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode == 0


class Debian(unittest.TestCase):
    def setUp(self) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        self.cache = self.folder / "cache"
        (self.folder / "bin").mkdir()
        self.tool()
        self.environment = {
            **os.environ,
            "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}",
            "AA_BLENDERS": str(self.cache),
            "AA_DEBIAN_MIRROR": "http://mirror.invalid/debian",
        }

    def tearDown(self) -> None:
        self._folder.cleanup()

    def tool(self, text: str | None = None, body: str = 'echo "$PWD" "$@"') -> None:
        tool = self.folder / "bin/mmdebstrap"
        tool.write_text(text or MMDEBSTRAP.format(folder=self.folder, body=body))
        tool.chmod(0o755)

    def start(self, *words: object) -> subprocess.Popen:
        return subprocess.Popen(
            [sys.executable, str(DEBIAN), *map(str, words)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=self.environment,
        )

    def call(self, *words: object, expect: int = 0) -> tuple[str, str]:
        process = self.start(*words)
        out, said = process.communicate(timeout=60)
        self.assertEqual(process.returncode, expect, out + said)
        return out.strip(), said

    def skipped(self, reason: str, *words: object) -> None:
        _out, said = self.call(*(words or ("get", "trixie")), expect=77)
        self.assertIn("SKIPPED", said)
        self.assertIn(reason, said)
        self.assertFalse((self.cache / "trixie").exists())
        self.assertFalse((self.cache / "trixie.making").exists(), "what was begun is cleared away")

    def wait_for(self, file: Path) -> None:
        for _ in range(200):
            if file.exists():
                return
            time.sleep(0.05)
        self.fail(f"{file} did not come")

    def calls(self) -> list[str]:
        return (self.folder / "calls").read_text().splitlines()

    def test_why_it_cannot_be_had(self) -> None:
        self.tool("#!/bin/sh\necho 'I: updating' >&2\necho 'E: Failed to fetch' >&2\nexit 25\n")
        self.skipped("E: Failed to fetch")
        self.skipped("debian.py get trixie", "run", "trixie", "true")
        self.environment["AA_BLENDERS"] = "/proc/nowhere"
        self.skipped("set AA_BLENDERS")
        self.environment["AA_BLENDERS"] = str(self.cache)
        self.environment["PATH"] = self.environment["PATH"].split(":", 1)[1]
        if not shutil.which("mmdebstrap", path=self.environment["PATH"]):
            self.skipped("apt-get install mmdebstrap")

    @unittest.skipUnless(CAN_ENTER, "needs the right to mount")
    def test_a_disk_that_is_full(self) -> None:
        self.cache.mkdir()
        script = f'mount -t tmpfs -o size=1m small "{self.cache}" && exec {sys.executable} {DEBIAN} get trixie'
        done = subprocess.run(
            ["unshare", "--mount", "sh", "-c", script],
            capture_output=True,
            text=True,
            env=self.environment,
        )
        self.assertEqual(done.returncode, 77, done.stderr)
        self.assertIn("GB free and", done.stderr)

    @unittest.skipUnless(CAN_ENTER, "needs the right to mount")
    def test_it_is_called_as_blender_is(self) -> None:
        wrapper, said = self.call("get", "trixie")
        self.assertEqual(wrapper, str(self.cache / "trixie/blender"))
        self.assertIn("Blender 9.8.7", said)
        self.assertEqual(self.calls(), ["deb http://mirror.invalid/debian trixie main"])
        # Arguments with blanks, the folder it is called in, and names that are the same inside.
        done = subprocess.run(
            [wrapper, "-b", "a b", str(self.folder / "bin")],
            capture_output=True,
            text=True,
            cwd=self.folder,
            env={**self.environment, "PATH": "/usr/bin:/bin"},  # a user's has no /usr/sbin
        )
        self.assertEqual(
            done.stdout.strip(), f"{self.folder} -b a b {self.folder}/bin", done.stderr
        )
        told, _said = self.call("run", "trixie", "sh", "-c", 'echo "$BLENDER"')
        self.assertEqual(told, wrapper)
        _out, _said = self.call("run", "trixie", "sh", "-c", "exit 5", expect=5)
        self.call("get", "trixie")
        self.assertEqual(len(self.calls()), 1, "what is there is used again")
        self.assertNotIn(str(self.cache), Path("/proc/self/mountinfo").read_text())

    @unittest.skipUnless(CAN_ENTER, "needs the right to mount")
    def test_what_is_half_made_is_made_anew(self) -> None:
        (self.folder / "wait").touch()
        for end in (signal.SIGKILL, signal.SIGTERM):
            (self.folder / "begun").unlink(missing_ok=True)
            process = self.start("get", "trixie")
            self.wait_for(self.folder / "begun")
            process.send_signal(end)
            process.communicate(timeout=20)
            self.assertFalse((self.cache / "trixie").exists())
            if (
                end == signal.SIGKILL
            ):  # nobody could clear away, and who makes it still lives: the lock holds
                other = self.start("get", "trixie")
                time.sleep(0.7)
                self.assertIsNone(other.poll(), "two make the same at the same time")
                (self.folder / "wait").unlink()
                out, said = other.communicate(timeout=60)
                self.assertEqual(other.returncode, 0, said)
                self.assertIn("waiting for another run", said)
                self.call("clean")
                (self.folder / "wait").touch()
            else:
                self.assertFalse((self.cache / "trixie.making").exists())
        (self.folder / "wait").unlink()
        self.call("get", "trixie")

    @unittest.skipUnless(CAN_ENTER, "needs the right to mount")
    def test_two_at_once_make_one(self) -> None:
        both = [self.start("get", "trixie") for _ in range(2)]
        paths = [process.communicate(timeout=60)[0].strip() for process in both]
        self.assertEqual(paths, [str(self.cache / "trixie/blender")] * 2)
        self.assertEqual(len(self.calls()), 1)

    @unittest.skipUnless(CAN_ENTER, "needs the right to mount")
    def test_another_recipe_makes_another_system(self) -> None:
        self.call("get", "trixie")
        made = self.cache / "trixie/made.json"
        made.write_text(made.read_text().replace('"recipe": "', '"recipe": "x'))
        self.call("get", "trixie")
        self.assertEqual(len(self.calls()), 2)

    @unittest.skipUnless(CAN_ENTER, "needs the right to mount")
    def test_clean_waits_for_users_and_goes_through_no_mount(self) -> None:
        self.tool(body="exec sleep 60")
        wrapper, _said = self.call("get", "trixie")
        running = subprocess.Popen([wrapper, "-b"])
        time.sleep(1.0)
        cleaning = self.start("clean")
        time.sleep(1.0)
        self.assertIsNone(cleaning.poll(), "a system that is used was removed")
        self.assertTrue((self.cache / "trixie/root/usr").exists())
        running.kill()  # the process is Blender itself
        running.wait()
        _out, said = cleaning.communicate(timeout=20)
        self.assertIn("removed", said)
        self.assertFalse((self.cache / "trixie").exists())

        self.call("get", "trixie")
        mine = self.folder / "mine"
        mine.mkdir()
        (mine / "precious").touch()
        script = (
            f'mount --bind "{mine}" "{self.cache}/trixie/root/tmp" && '
            f"{sys.executable} {DEBIAN} clean; echo $?"
        )
        done = subprocess.run(
            ["unshare", "--mount", "sh", "-c", script],
            capture_output=True,
            text=True,
            env=self.environment,
        )
        self.assertEqual(done.stdout.strip(), "77", done.stderr)
        self.assertIn("is mounted", done.stderr)
        self.assertTrue((mine / "precious").exists())

    def test_usage(self) -> None:
        _out, said = self.call("got", "trixie", expect=2)
        self.assertIn("debian.py get trixie", said)

    def test_a_window_that_cannot_be_had_is_skipped(self) -> None:
        """Without a display in memory, and with a Blender that ends before it has a window."""
        command = [sys.executable, str(DEBIAN.with_name("window.py")), str(self.folder / "window")]
        (self.folder / "bin/Xvfb").write_text(
            '#!/bin/sh\n[ "$1" = -displayfd ] && eval "echo 9 >&$2"\nexec sleep 60\n'
        )
        blender = self.folder / "bin/blender"
        blender.write_text("#!/bin/sh\nexit 134\n")
        for path in (self.folder / "bin/Xvfb", blender):
            path.chmod(0o755)
        environment = {**self.environment, "BLENDER": str(blender)}
        for path, why in ((self.environment["PATH"], "libgl1-mesa-dri"), ("/nowhere", "xvfb")):
            done = subprocess.run(
                command, capture_output=True, text=True, env={**environment, "PATH": path}
            )
            self.assertEqual(done.returncode, 77, done.stderr)
            self.assertRegex(done.stderr, f"^SKIPPED: no window .*{why}")


unittest.main()
