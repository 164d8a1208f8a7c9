# SPDX-License-Identifier: MIT
"""How long jobs that wait for one another take on so many cores, each on one of them."""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from math import inf


@dataclass(eq=False)
class Job:
    """Its seconds, and the jobs that must have ended before it begins."""

    seconds: float
    after: list[Job] = field(default_factory=list)


def wall_seconds(jobs: list[Job], cores: float = inf) -> float:
    """Until the last job ends, when a free core takes the job with the longest way to the end. ``jobs``: each behind those
    that it waits for."""
    followers: dict[Job, list[Job]] = {job: [] for job in jobs}
    for job in jobs:
        for earlier in job.after:
            followers[earlier].append(job)
    way: dict[Job, float] = {}
    for job in reversed(jobs):
        way[job] = job.seconds + max((way[f] for f in followers[job]), default=0.0)
    awaited = {job: len(job.after) for job in jobs}
    ready = [(-way[job], i, job) for i, job in enumerate(jobs) if not job.after]
    heapq.heapify(ready)
    running: list[tuple[float, int, Job]] = []
    now, count = 0.0, len(jobs)
    while ready or running:
        while ready and len(running) < cores:
            job = heapq.heappop(ready)[2]
            heapq.heappush(running, (now + job.seconds, count := count + 1, job))
        now, _, ended = heapq.heappop(running)
        for job in followers[ended]:
            awaited[job] -= 1
            if not awaited[job]:
                heapq.heappush(ready, (-way[job], count := count + 1, job))
    return now
