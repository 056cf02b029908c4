"""Makes a case smaller while what is wrong with it stays: delta debugging on the XML tree."""

import copy

from case_grammar import Case

# Without these nothing is a case.
FRAME = {"case", "casedef", "constantsdef", "mkconfig", "geometry", "definition", "pointmin", "pointmax", "commands",
         "mainlist", "execution", "parameters", "gravity", "rhop0", "rhopgradient", "hswl", "gamma", "speedsystem",
         "coefsound", "speedsound", "coefh", "hdp", "cflnumber"}


class Budget(Exception):
    """The number of runs that a reduction may take is spent."""


def reduce_case(case, still_differs, most_runs=250):
    """The smallest case found for which still_differs(case) holds, and the number of its calls.

    Deletes runs of commands, halving their length; then puts the commands of a list in the place of
    its call; then single elements, the outermost first, and attributes; all over again until
    nothing more goes. The frame of a case stays.
    """
    runs = 0

    def holds(root):
        nonlocal runs
        if runs == most_runs:
            raise Budget
        runs += 1
        return still_differs(Case(root, case.files))

    best = copy.deepcopy(case.root)
    try:
        while True:
            before = size_of(best)
            for step in (without_commands, with_lists_in_place, without_elements, without_attributes):
                for best in step(best, holds):
                    pass
            if size_of(best) == before:
                break
    except Budget:
        pass
    return Case(best, case.files), runs


def size_of(root):
    return sum(1 + len(e.attrib) for e in root.iter())


# Each step yields the tree it has come to whenever it has made it smaller, and at the end.


def without_commands(root, holds):
    commands = root.find(".//mainlist")
    length = len(commands)
    while length >= 1:
        at = 0
        while at < len(commands):
            smaller = copy.deepcopy(root)
            kept = smaller.find(".//mainlist")
            del kept[at:at + length]
            if holds(smaller):
                root, commands = smaller, kept
                yield root
            else:
                at += length
        length //= 2
    yield root


def with_lists_in_place(root, holds):
    at = 0
    while at < len(root.find(".//mainlist")):
        call = root.find(".//mainlist")[at]
        if call.tag == "runlist":
            smaller = copy.deepcopy(root)
            main = smaller.find(".//mainlist")
            called = next((e for e in smaller.iter("list") if e.get("name") == call.get("name")), None)
            if called is not None:
                main[at:at + 1] = copy.deepcopy(list(called))
                if holds(smaller):
                    root = smaller
                    yield root
        at += 1
    yield root


def without_elements(root, holds):
    at = 0
    while True:
        pairs = [(p, c) for p in root.iter() for c in p if c.tag not in FRAME]
        if at >= len(pairs):
            break
        smaller = copy.deepcopy(root)
        parent, child = [(p, c) for p in smaller.iter() for c in p if c.tag not in FRAME][at]
        parent.remove(child)
        if holds(smaller):
            root = smaller
            yield root
        else:
            at += 1
    yield root


def without_attributes(root, holds):
    at = 0
    while True:
        names = [(i, name) for i, e in enumerate(root.iter()) if e.tag not in FRAME for name in e.attrib]
        if at >= len(names):
            break
        smaller = copy.deepcopy(root)
        i, name = names[at]
        del list(smaller.iter())[i].attrib[name]
        if holds(smaller):
            root = smaller
            yield root
        else:
            at += 1
    yield root
