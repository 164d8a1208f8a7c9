"""A page in headless Chromium after its scripts ran, and what a visitor's script in it collected. Imported first by tests
that are started with PROGRAM ROOT BROWSER."""

from __future__ import annotations

import html
import json
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(sys.argv[2]).resolve() / "tests/e2e"))
BROWSER = sys.argv.pop(3)  # unittest reads the rest

from program import ROOT, ProgramTest, main  # noqa: E402

__all__ = ["BROWSER", "ROOT", "PageTest", "main"]


class PageTest(ProgramTest):
    def open(self, page: Path, *options: str, timeout: int = 120) -> str:
        """The page's document, opened from disk without a network; nothing may be wrong in its console."""
        done = subprocess.run(
            [
                BROWSER,
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                f"--user-data-dir={self.folder}/profile",
                "--host-resolver-rules=MAP * ~NOTFOUND",
                "--enable-logging=stderr",
                *options,
                "--dump-dom",
                page.as_uri(),
            ],
            capture_output=True,
            text=True,
            timeout=timeout,
        )
        said = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        self.assertFalse([s for s in said if re.search("error|uncaught|failed|refused", s, re.I)])
        return done.stdout

    def collected(self, document: str) -> dict:
        """What the page's <pre id="collected"> holds."""
        found = re.search(r'<pre id="collected">(.+?)</pre>', document, re.S)
        self.assertTrue(found, document[-2000:])
        return json.loads(html.unescape(found[1]))
