"""Compares two Case.xml files, element by element.

Used by tests/golden and tools/compare-with-gencase; the program does not need it.

Names, order and text of elements, attributes and comments are the same, character by character; numbers in
<execution>, of which GenCase prints six digits, are near. What says who wrote a file, and when, is not compared.
"""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from difflib import SequenceMatcher

# Half a unit of the sixth digit of a number that begins with 1, and a little for the rounding of ours.
SIX_DIGITS = 5.1e-6
# Attributes that tell elements of one name apart.
KEYS = ("key", "name", "id", "mkbound", "mkfluid", "mk", "ref")

ENTITIES = {"amp": "&", "lt": "<", "gt": ">", "quot": '"', "apos": "'"}
ATTRIBUTE = re.compile(r"""([^\s=<>/"']+)\s*=\s*("[^"]*"|'[^']*')""")
TOKEN = re.compile(
    rf"""<!--(?P<comment>.*?)-->|<\?.*?\?>|<!DOCTYPE[^>]*>|<!\[CDATA\[(?P<data>.*?)\]\]>|</(?P<end>[^\s<>]+)\s*>|"""
    rf"""<(?P<tag>[^\s<>/!?]+)(?P<attributes>(?:\s+{ATTRIBUTE.pattern})*)\s*(?P<empty>/?)>|(?P<text>[^<]+)""", re.S)


@dataclass(frozen=True)
class XmlDifference:
    """place: names of the elements down to it, joined by /; kind: missing, extra, value, text, comment or order
    (missing: only GenCase has it); what: the attribute, or what tells the element from its neighbours."""
    place: str
    kind: str
    what: str
    ours: str
    theirs: str

    def line(self):
        name = f"{self.place} {self.kind} {self.what}".rstrip()
        return f"{name}: fppg {self.ours or 'nothing'}, GenCase {self.theirs or 'nothing'}"


def unescaped(text):
    def character(match):
        name = match[1]
        if name.startswith("#"):
            return chr(int(name[2:], 16) if name[1] in "xX" else int(name[1:]))
        return ENTITIES.get(name, match[0])

    return re.sub(r"&(#[0-9]+|#[xX][0-9a-fA-F]+|\w+);", character, text)


def read_xml(path):
    """The tree of a file under an element <document>, comments kept, those before and behind the root too.

    Reads what GenCase and the solver read and write, though it is not quite XML: -- in comments, < in attributes, a
    declaration that is not the first thing of the file. Text that is not UTF-8 is taken as Latin-1. Raises ValueError
    where a tag is wrong.
    """
    with open(path, "rb") as file:
        data = file.read()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    text = text.replace("\r\n", "\n")
    builder, at = ElementTree.TreeBuilder(insert_comments=True), 0
    builder.start("document", {})
    open_tags = []
    while at < len(text):
        token = TOKEN.match(text, at)
        if not token or (token["end"] and open_tags[-1:] != [token["end"]]):
            row = text.count("\n", 0, at) + 1
            raise ValueError(f"{path}:{row}: not XML: {text[at:at + 40]!r}")
        at = token.end()
        if token["comment"] is not None:
            builder.comment(token["comment"])
        elif token["end"]:
            builder.end(open_tags.pop())
        elif token["tag"]:
            builder.start(token["tag"], {n: unescaped(v[1:-1]) for n, v in ATTRIBUTE.findall(token["attributes"])})
            open_tags.append(token["tag"])
            if token["empty"]:
                builder.end(open_tags.pop())
        elif token["text"] or token["data"]:
            builder.data(unescaped(token["text"] or "") + (token["data"] or ""))
    if open_tags:
        raise ValueError(f"{path}: <{open_tags[-1]}> has no end")
    builder.end("document")
    return builder.close()


def is_comment(element):
    return element.tag is ElementTree.Comment


def text_of(element):
    """Character data directly inside, without the blanks of the layout."""
    if is_comment(element):
        return element.text or ""
    return " ".join(t.strip() for t in (element.text, *(c.tail for c in element)) if t and t.strip())


def number_of(text):
    try:
        return float(text)
    except ValueError:
        return None


def is_same_number(ours, theirs, largest):
    """Numbers of which theirs has six digits; `largest` is the largest entry of the vector or tensor they are of."""
    return abs(ours - theirs) <= SIX_DIGITS * max(abs(theirs), 1e-3 * largest) + 1e-12


def identity(element):
    """What must agree for two elements to be compared with each other."""
    if is_comment(element):
        return ("comment", text_of(element).strip())
    return (element.tag, *(element.get(key) for key in KEYS))


def describe(element):
    """An element or comment in a few words."""
    if is_comment(element):
        return f"<!--{text_of(element)[:60]}-->"
    attributes = "".join(f' {k}="{v}"' for k, v in element.attrib.items())
    return f"<{element.tag}{attributes}>"[:160]


def key_of(element):
    if is_comment(element):
        return "comment"
    return " ".join([element.tag, *(f"{k}={element.get(k)}" for k in KEYS if element.get(k) is not None)][:2])


def compare_attributes(place, ours, theirs, is_computed):
    names, wanted = list(ours.attrib), list(theirs.attrib)
    numbers = [abs(n) for n in map(number_of, theirs.attrib.values()) if n is not None]
    for name in dict.fromkeys(wanted + names):
        a, b = ours.get(name), theirs.get(name)
        if a == b:
            continue
        if a is None or b is None:
            yield XmlDifference(place, "missing" if a is None else "extra", f"@{name}", a or "", b or "")
            continue
        x, y = number_of(a), number_of(b)
        if not is_computed or x is None or y is None or not is_same_number(x, y, max(numbers)):
            yield XmlDifference(place, "value", f"@{name}", a, b)
    if names != wanted and set(names) == set(wanted):
        yield XmlDifference(place, "order", "attributes", " ".join(names), " ".join(wanted))


def pairs_of_children(ours, theirs):
    """Children that belong together, in order; None where one has no partner."""
    mine, wanted = list(ours), list(theirs)
    keys = [identity(e) for e in mine], [identity(e) for e in wanted]
    for tag, i1, i2, j1, j2 in SequenceMatcher(None, *keys, autojunk=False).get_opcodes():
        left, right = mine[i1:i2], wanted[j1:j2]
        if tag != "equal":
            # What stands at one place under one name differs in a key.
            while left and right and left[0].tag == right[0].tag:
                yield left.pop(0), right.pop(0)
            yield from ((e, None) for e in left)
            yield from ((None, e) for e in right)
        else:
            yield from zip(left, right)


def compare_elements(ours, theirs, place, is_computed=False):
    """Yields an XmlDifference for each."""
    if is_comment(ours):
        if ours.text != theirs.text:
            yield XmlDifference(place, "comment", "", describe(ours), describe(theirs))
        return
    yield from compare_attributes(place, ours, theirs, is_computed)
    if text_of(ours) != text_of(theirs):
        yield XmlDifference(place, "text", "", text_of(ours), text_of(theirs))
    alone = [pair for pair in pairs_of_children(ours, theirs)]
    extra = [a for a, b in alone if b is None]
    missing = [b for a, b in alone if a is None]
    for a, b in alone:
        if a is not None and b is not None:
            below = place if is_comment(a) else f"{place}/{a.tag}".lstrip("/")
            yield from compare_elements(a, b, below, is_computed or below == "case/execution")
    # The same element at another place is one difference.
    for b in missing:
        a = next((e for e in extra if identity(e) == identity(b)), None)
        if a is not None:
            extra.remove(a)
            yield XmlDifference(place, "order", key_of(b), "at another place", "")
        else:
            yield XmlDifference(place, "missing", key_of(b), "", describe(b))
    for a in extra:
        yield XmlDifference(place, "extra", key_of(a), describe(a), "")


def compare_case_xml(ours, theirs):
    """The differences of two files; those of `app` and `date` of <case> and of the declared prefix are none."""
    mine, wanted = read_xml(ours), read_xml(theirs)
    for document in (mine, wanted):
        for name in ("app", "date"):
            document.find("case").attrib.pop(name, None)
    return list(compare_elements(mine, wanted, ""))
