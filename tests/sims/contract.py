"""What other people's pages rely on, as each sim says it beside itself."""

from __future__ import annotations

import importlib
from typing import Any

from sims.kit.sim import Contract, Sim


def contract_of(sim: Sim[Any, Any]) -> Contract:
    """The contract that stands beside a sim."""
    package = sim.params.__module__.rpartition(".")[0]
    contract = getattr(importlib.import_module(package), "CONTRACT", None)
    assert isinstance(contract, Contract), (
        f"{package.replace('.', '/')}/__init__.py needs CONTRACT = Contract(parameters, solution, link, state): the"
        " names and one link that other people's pages rely on from now on (see sims/kit/sim.py)"
    )
    return contract
