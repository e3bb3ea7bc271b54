"""What a paper claims, what came out, and whether it holds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any


class Holds(str, Enum):
    """Whether a claim holds."""

    YES = "yes"
    PARTLY = "partly"
    NO = "no"

    @classmethod
    def share(cls, share: float, yes: float = 0.95, partly: float = 0.5) -> Holds:
        """Judge by the share of cases in which it is so."""
        return cls.of(share >= yes, share >= partly)

    @classmethod
    def of(cls, yes: bool, partly: bool = False) -> Holds:
        """Judge by two conditions, the stricter one first."""
        if yes:
            return cls.YES
        return cls.PARTLY if partly else cls.NO

    @classmethod
    def all(cls, parts: Iterable[Holds]) -> Holds:
        """Join: all alike keep their word, anything else is partly."""
        words = set(parts)
        return words.pop() if len(words) == 1 else cls.PARTLY


@dataclass(frozen=True, slots=True)
class Finding:
    """What came out under one reading of the paper.

    Attributes
    ----------
    reading : str
        Name of the reading.
    holds : Holds
        Whether the claim holds under it.
    numbers : str
        The numbers that say so, with their spread.
    """

    reading: str
    holds: Holds
    numbers: str


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim in our words, its place in the paper, and the findings, our reading first."""

    claim: str
    place: str
    findings: tuple[Finding, ...]


@dataclass(frozen=True, slots=True)
class Verdict:
    """The judgement of one experiment.

    Attributes
    ----------
    claims : tuple of Claim
        Each is judged on its own.
    setting : str
        How the experiment was made, and what had to be chosen where the paper is silent.
    remarks : tuple of str
        What else there is to know, a sentence or two each.
    """

    claims: tuple[Claim, ...]
    setting: str
    remarks: tuple[str, ...] = ()

    @property
    def holds(self) -> Holds:
        """Whether all claims hold under our reading."""
        return Holds.all(claim.findings[0].holds for claim in self.claims)

    def to_json(self) -> dict[str, Any]:
        """Everything as plain values."""
        return {"holds": self.holds.value, **asdict(self)}

    def to_markdown(self) -> str:
        """Everything as text, a table per claim."""
        parts = [f"**Verdict: {self.holds.value}.**", self.setting]
        for claim in self.claims:
            rows = ["| reading | holds | what came out |", "|---|---|---|"]
            rows += [f"| {f.reading} | **{f.holds.value}** | {f.numbers} |" for f in claim.findings]
            parts += [f"Claim ({claim.place}): {claim.claim}", "\n".join(rows)]
        return "\n\n".join([*parts, *self.remarks]) + "\n"
