"""Failures of one rank told to all, so that none waits for it in the next collective call. It needs rvelab alone."""
from __future__ import annotations

from typing import Any, Callable

import rvelab


def together(comm: Any, work: Callable[[], Any]) -> Any:
    """Collective. What `work` returns, which makes no collective calls; an error of one rank is raised on all: its own
    on that rank, RvelabError with its text on the others."""
    failure, found = None, None
    try:
        found = work()
    except Exception as error:
        failure = error
    told = [text for text in comm.allgather(failure and (str(failure) or repr(failure))) if text]
    if failure:
        raise failure
    if told:
        raise rvelab.RvelabError(told[0])
    return found
