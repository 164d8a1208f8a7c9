#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How a Slurm job fares, in the words that Snakemake asks for: running, success or failed. usage: status.py JOB

A job whose node has died waits in the queue again (--requeue), and so counts as running. Slurm forgets a job some minutes
after its end; then its accounting is asked, and where there is none the job counts as failed: it is tried again, finds
its pictures made and ends at once.
"""

from __future__ import annotations

import re
import subprocess
import sys
import time

_GOING_ON = (
    "PENDING", "CONFIGURING", "RUNNING", "COMPLETING", "SUSPENDED", "STOPPED", "SIGNALING", "STAGE_OUT",
    "REQUEUED", "REQUEUE_FED", "REQUEUE_HOLD", "SPECIAL_EXIT", "RESIZING", "RESV_DEL_HOLD", "PREEMPTED",
)  # fmt: skip
_TRIES = 5  # of a controller that does not answer
_SECONDS_BETWEEN = 5.0


def state_of(job: str) -> str | None:
    """The job's state; None where Slurm does not know it any more."""
    for attempt in range(_TRIES):
        if attempt:
            time.sleep(_SECONDS_BETWEEN)
        shown = subprocess.run(
            ["scontrol", "-o", "show", "job", job], capture_output=True, text=True
        )
        found = re.search(r"JobState=(\w+)", shown.stdout)
        if found:
            return found[1]
        if "Invalid job id" in shown.stderr:
            break
    told = subprocess.run(
        ["sacct", "-j", job, "-X", "-n", "-P", "-o", "State"], capture_output=True, text=True
    )
    lines = told.stdout.split() if told.returncode == 0 else []
    return lines[0] if lines else None


def word_for(state: str | None) -> str:
    """Snakemake's word for a state."""
    if state in _GOING_ON:
        return "running"
    return "success" if state == "COMPLETED" else "failed"


if __name__ == "__main__":
    if len(sys.argv) != 2 or not sys.argv[1].isdigit():
        sys.exit("usage: status.py JOB")
    print(word_for(state_of(sys.argv[1])))
