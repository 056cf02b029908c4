"""Tells whether two programs differ only where GenCase's own answer hangs on rounding.

A node halfway between two answers gets one of them by the last bits of sums; GenCase's own answer there turns when the
case is moved by a millionth of dp. So a case that differs is run through GenCase again with its lattice moved a little
in many directions, and with a slightly other dp. It is a rounding tie when everything in which fppg differs is GenCase's
own answer in one of these runs.
"""

import copy
import itertools

import numpy as np

from case_grammar import AXES, Case

# Lengths by which the lattice is moved, in dp: the rounding of double, and of float, in which GenCase keeps some limits.
STEPS = (1e-8, 1e-6)
# In which directions the lattice is moved, and whether dp grows or shrinks.
MOVES = [(*signs, 0) for signs in itertools.product((-1, 0, 1), repeat=3)] + [(0, 0, 0, -1), (0, 0, 0, 1)]
# Two runs have the same particle where they have one of its type and mk within this distance, dp.
SAME_PLACE = 1e-3


def moved_cases(case):
    """The case with its lattice and domain moved by STEPS in 26 directions, and with a dp larger and smaller by STEPS."""
    dp = float(case.root.find(".//definition").get("dp"))
    for step, (*signs, growth) in itertools.product(STEPS, MOVES):
        if not any(signs) and growth == 0:
            continue
        root = copy.deepcopy(case.root)
        definition = root.find(".//definition")
        for element in (definition, *root.iter("grid")):  # that of a drawbathymetry has its own
            if not element.get("dp").startswith("#"):
                element.set("dp", f"{float(element.get('dp')) * (1 + growth * step):.17g}")
        for name in ("pointref", "pointmin", "pointmax"):
            point = definition.find(name)
            for axis, sign in zip(AXES, signs) if point is not None else ():
                point.set(axis, f"{float(point.get(axis)) + sign * step * dp:.17g}")
        yield Case(root, case.files)


def rows_of(outcome, dp):
    """Rows of type, mk and place in dp, and the number of every type."""
    types = {name: i for i, name in enumerate(("fixed", "moving", "floating", "fluid"))}
    numbers = np.array([types.setdefault(t, len(types)) for t in outcome.types], float)
    return np.column_stack([numbers, outcome.mks.astype(float), outcome.positions / dp])


def nearest(rows, others):
    """For each row the index of the nearest of the others, -1 where none is within SAME_PLACE."""
    found = np.full(len(rows), -1)
    if len(others) == 0:
        return found
    order = np.argsort(others[:, 2], kind="stable")
    x = others[order, 2]
    for i, row in enumerate(rows):
        near = order[np.searchsorted(x, row[2] - SAME_PLACE):np.searchsorted(x, row[2] + SAME_PLACE)]
        if len(near):
            away = np.abs(others[near] - row).max(axis=1)
            if away.min() <= SAME_PLACE:
                found[i] = near[away.argmin()]
    return found


def is_rounding_tie(case, ours, theirs, run_gencase):
    """Whether every difference of two outcomes is one that GenCase's own answer makes when the case is moved a little.

    run_gencase  takes a case and gives its outcome
    """
    dp = float(case.root.find(".//definition").get("dp"))
    if ours.status != "accepts" or theirs.status != "accepts" or len(ours.mks) == 0 or len(theirs.mks) == 0:
        return False
    ours_rows, theirs_rows = rows_of(ours, dp), rows_of(theirs, dp)
    extra = ours_rows[nearest(ours_rows, theirs_rows) < 0]
    missing = theirs_rows[nearest(theirs_rows, ours_rows) < 0]
    if len(extra) + len(missing) == 0:
        return has_other_order(case, dp, ours_rows, theirs_rows, run_gencase)
    is_extra_there = np.zeros(len(extra), bool)
    is_missing_there = np.zeros(len(missing), bool)
    for moved in moved_cases(case):
        outcome = run_gencase(moved)
        if outcome.status != "accepts":
            continue
        rows = rows_of(outcome, dp)
        is_extra_there |= nearest(extra, rows) >= 0
        is_missing_there |= nearest(missing, rows) < 0
        if is_extra_there.all() and is_missing_there.all():
            return True
    return False


def has_other_order(case, dp, ours, theirs, run_gencase):
    """Whether the particles that have another place in the order are those that change it in GenCase's own runs."""
    place = nearest(ours, theirs)
    differs = theirs[place != np.arange(len(ours))] if len(ours) == len(theirs) else theirs[:0]
    if len(differs) == 0:
        return False
    before = nearest(differs, theirs)
    changes = np.zeros(len(differs), bool)
    for moved in moved_cases(case):
        outcome = run_gencase(moved)
        if outcome.status == "accepts" and len(outcome.mks) == len(theirs):
            changes |= nearest(differs, rows_of(outcome, dp)) != before
    return bool(changes.all())
