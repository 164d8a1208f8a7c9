"""The program in a shell: help, completion, the manual page, its exit code when nothing can be written, former names."""

from __future__ import annotations

import json
import os
import pty
import re
import select
import shutil
import subprocess
import time
import unittest

from program import PROGRAM, ProgramTest, main


class Shell(ProgramTest):
    def words(self, *words: str) -> list[str]:
        """What completion offers for the last of them."""
        done = self.aaresolve("completion", "words", "--", *words)
        return [line.split("\t")[0] for line in done.stdout.splitlines()]

    def commands(self) -> list[str]:
        return self.words("")

    def test_help_of_every_command(self) -> None:
        everything = self.aaresolve("help").stdout
        self.assertEqual(everything, self.aaresolve("--help").stdout)
        for command in self.commands():
            self.assertRegex(everything, rf"(?m)^  {command} ")
            shown = self.aaresolve("help", command).stdout
            self.assertEqual(shown, self.aaresolve(command, "--help").stdout)
            self.assertIn(f"Usage: aaresolve {command} ", shown)
        self.assertIn("--seed", self.aaresolve("help", "survey", "make").stdout)
        self.refused(2, "help", "reprot", says=("no command 'reprot'", "'report'"))
        self.refused(2, "run", "--no-such", says=("see aaresolve run --help",))

    def test_completion_knows_commands_options_and_methods(self) -> None:
        self.assertIn("survey", self.commands())
        self.assertEqual(self.words("re"), ["report"])
        self.assertIn("make", self.words("survey", ""))
        self.assertEqual(self.words("help", "sur"), ["survey"])
        self.assertIn("--write-frames", self.words("run", "--wr"))
        self.assertEqual(self.words("run", "shot", "--history", ""), ["first", "ramp", "full"])
        self.assertEqual(self.words("run", "--history=r"), ["--history=ramp"])
        methods = [m["id"] for m in json.loads(self.aaresolve("list", "--json").stdout)["methods"]]
        for words in (
            ("run", "-m", ""),
            ("plan", ""),
            ("synth", "--for", ""),
            ("plan", "noaa", ""),
        ):
            offered = self.words(*words)
            self.assertTrue(set(methods) < set(offered), words)
            self.assertIn("temporal", offered)
        self.assertIn("runnable", self.words("run", "-m", ""))
        self.assertNotIn("runnable", self.words("plan", ""))
        self.assertEqual(self.words("run", "-m", "noaa,sal"), ["noaa,salvi"])
        self.assertIn("noaa,uncharted:kmin=", self.words("run", "-m", "noaa,uncharted:k"))
        self.assertIn(
            "uncharted:kmin=1,clipTarget=", self.words("run", "-m", "uncharted:kmin=1,clipT")
        )
        self.assertEqual(self.words("run", "-m", "noaa+sharpen=n"), ["noaa+sharpen=norm"])
        self.assertIn("asaa+fill=fxaa311:preset=", self.words("run", "-m", "asaa+fill=fxaa311:p"))
        self.assertIn("moving", self.words("synth", ""))
        self.assertEqual(self.words("run", ""), [], "a shot is a folder: the shell's own affair")

    # What every shell must do with its script: offer, and put in what is the only one.
    CASES = (
        ("aaresolve repo", "aaresolve report"),
        ("aaresolve run s -m noaa,salv", "aaresolve run s -m noaa,salvi"),
        ("aaresolve run s -m karis:antiF", "aaresolve run s -m karis:antiFlicker="),
        ("aaresolve run s --histo", "aaresolve run s --history"),
        ("aaresolve sheet picture", "aaresolve sheet pictures_of_mine"),
    )

    def typed(self, shell: str, start: list[str], line: str) -> str:
        """The command line of an interactive shell after `line` and the Tab key."""
        (self.folder / "pictures_of_mine").mkdir(exist_ok=True)
        path = f"{PROGRAM.parent}:{os.environ['PATH']}"
        environment = {"PATH": path, "HOME": str(self.folder), "TERM": "dumb", "LC_ALL": "C.UTF-8"}
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.folder)
            os.execvpe(start[0], start, environment)
        said = b""

        def read_until(done: re.Pattern[bytes], seconds: float = 20) -> None:
            nonlocal said
            end = time.monotonic() + seconds
            while time.monotonic() < end and not done.search(said):
                if select.select([terminal], [], [], 0.1)[0]:
                    try:
                        said += os.read(terminal, 4096)
                    except OSError:
                        return

        try:
            os.write(terminal, b"echo rea''dy\n")
            read_until(re.compile(rb"ready\r?\n"))
            said = b""
            # Home and a word before it: the shell prints the line as it then stands.
            os.write(terminal, line.encode() + b"\t")
            time.sleep(1.0)
            os.write(terminal, b"\x01echo '[' \x05 ']'\n")
            read_until(re.compile(rb"\n\[ .* \]\r?\n"))
        finally:
            os.kill(child, 9)
            os.waitpid(child, 0)
            os.close(terminal)
        found = re.search(rb"\n\[ (.*) \]\r?\n", said)
        self.assertIsNotNone(found, said)
        return " ".join(found[1].decode().split())

    def check_shell(self, shell: str, start: list[str]) -> None:
        for line, expected in self.CASES:
            with self.subTest(shell=shell, line=line):
                self.assertEqual(self.typed(shell, start, line).rstrip("/"), expected)

    def script(self, shell: str, name: str) -> str:
        text = self.aaresolve("completion", shell).stdout
        (self.folder / name).write_text(text)
        return str(self.folder / name)

    def test_bash(self) -> None:
        subprocess.run(["bash", "-n", self.script("bash", "aaresolve.bash")], check=True)
        rc = self.folder / "rc"
        rc.write_text("source aaresolve.bash\nPS1='> '\n")
        self.check_shell("bash", ["bash", "--noprofile", "--rcfile", str(rc), "-i"])

    @unittest.skipUnless(shutil.which("zsh"), "zsh is missing: apt-get install zsh")
    def test_zsh(self) -> None:
        self.script("zsh", "_aaresolve")
        (self.folder / ".zshrc").write_text(
            "fpath=($HOME $fpath)\nautoload -U compinit && compinit -u\nbindkey -e\nPS1='> '\nunsetopt beep\n"
        )
        self.check_shell("zsh", ["zsh", "-i"])

    @unittest.skipUnless(shutil.which("fish"), "fish is missing: apt-get install fish")
    def test_fish(self) -> None:
        """fish draws its line with a terminal's help; it completes for whoever asks, too."""
        script = self.script("fish", "aaresolve.fish")
        (self.folder / "pictures_of_mine").mkdir()
        path = f"{PROGRAM.parent}:{os.environ['PATH']}"
        for line, expected in self.CASES:
            done = subprocess.run(
                ["fish", "--no-config", "-c", f"source {script}; complete -C '{line}'"],
                cwd=self.folder,
                env={"PATH": path, "HOME": str(self.folder), "LC_ALL": "C.UTF-8"},
                capture_output=True,
                text=True,
                check=True,
            )
            offered = [one.split("\t")[0].rstrip("/") for one in done.stdout.splitlines()]
            self.assertEqual(offered, [expected.split()[-1]], (line, done.stderr))

    def test_the_manual_page(self) -> None:
        page = self.folder / "aaresolve.1"
        page.write_text(self.aaresolve("help", "--man").stdout)
        text = page.read_text()
        for command in self.commands():
            self.assertIn(f'.SS "aaresolve {command}'.replace("-", "\\-"), text)
        self.assertIn("\\-\\-write\\-frames", text)
        if shutil.which("mandoc"):
            done = subprocess.run(
                ["mandoc", "-T", "lint", "-W", "warning", page], capture_output=True, text=True
            )
            said = done.stdout.splitlines()
            # No date: the page is that of the program, whenever it is built.
            self.assertEqual([line for line in said if "missing date" not in line], [])
        if shutil.which("groff"):
            done = subprocess.run(
                ["groff", "-man", "-ww", "-T", "utf8", page], capture_output=True, text=True
            )
            self.assertEqual(done.stderr, "")
            self.assertIn("EXIT STATUS", re.sub(".\x08", "", done.stdout))

    def test_what_cannot_be_printed_ends_with_1(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("circles", shot, (48, 32), 1, "--for", "noaa")
        self.aaresolve("run", shot, "-m", "noaa", "-o", out, "-q")
        image = next((out / "noaa").glob("*.exr"))
        for arguments in (
            ("--help",), ("--version",), ("help",), ("help", "run"), ("list",), ("list", "--json"), ("plan", "noaa"),
            ("check", shot), ("check", shot, "--json"), ("compare", image, image), ("compare", image, image, "--json"),
            ("run", shot, "-m", "noaa", "-o", out, "-q"), ("run", shot, "-m", "noaa", "-o", out, "-q", "--json"),
            ("report", out), ("sheet", out), ("synth", "--list"), ("completion", "bash"), ("help", "--man"),
            ("completion", "words", "--", ""),
        ):  # fmt: skip
            with self.subTest(arguments=arguments), open("/dev/full", "w") as full:
                done = subprocess.run(
                    [PROGRAM, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True
                )
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("standard output cannot be written", done.stderr)

    def test_files_that_cannot_be_written_end_with_1(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("circles", shot, (48, 32), 1, "--for", "noaa")
        self.aaresolve("run", shot, "-m", "noaa", "-o", out, "-q")
        (self.folder / "file").write_text("in the way")
        there = self.folder / "file/inside"
        for arguments in (
            ("run", shot, "-m", "noaa", "-o", there, "-q"), ("report", out, "-o", there / "r.html"),
            ("sheet", out, "-o", there / "s.png"), ("synth", "circles", "-o", there, "-q", "--frames", "1"),
        ):  # fmt: skip
            self.refused(1, *arguments, says=("inside",))

    def test_former_names_still_work_and_say_so(self) -> None:
        shot = self.folder / "shot"
        done = self.aaresolve(
            "synth", "circles", "-o", shot, "--resolution", "48x32", "--frames", "1", "-q"
        )
        self.assertIn("--resolution is called --size now", done.stderr)
        self.assertIn("48x32", done.stdout)
        done = self.aaresolve(
            "bench", "--family=reference", "--size", "16x16", "--frames", "1", "--json"
        )
        self.assertIn("--family is called --method now", done.stderr)
        self.assertIn("accum", done.stdout)


main()
