"""Cases by the thousand as one test a sim: as tests of their own, most of the time would go into keeping book."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import Any

import pytest

Test = Callable[..., None]


def per_sim(arguments: Sequence[str], cases: Sequence[tuple[Any, ...]], names: Sequence[str]) -> Callable[[Test], Test]:
    """As `pytest.mark.parametrize`, with the sim as the first of the arguments; the failures are told together."""

    def mark(test: Test) -> Test:
        own = inspect.signature(test)
        fixtures = [p for p in own.parameters.values() if p.name not in arguments]

        def whole(sim: Any, **found: Any) -> None:
            failures = []
            for case, name in zip(cases, names, strict=True):
                try:
                    if case[0] is sim:
                        test(**found, **dict(zip(arguments, case, strict=True)))
                except Exception as failure:
                    failure.add_note(f"in the case “{name}”")
                    failures.append(failure)
            if failures:
                raise ExceptionGroup(f"{len(failures)} cases fail", failures)

        whole.__name__, whole.__doc__, whole.__module__ = test.__name__, test.__doc__, test.__module__
        parameters = [inspect.Parameter("sim", inspect.Parameter.POSITIONAL_OR_KEYWORD), *fixtures]
        whole.__signature__ = own.replace(parameters=parameters)  # type: ignore[attr-defined]
        sims = {case[0].slug: case[0] for case in cases}
        marked: Test = pytest.mark.parametrize("sim", sims.values(), ids=sims.keys())(whole)
        return marked

    return mark
