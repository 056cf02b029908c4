"""Particles for SPH from GenCase's case definitions, from meshes, and from results that are there.

    import fppg
    case = fppg.read("CaseDambreak_Def.xml", dp=0.01)
    result = fppg.generate(case, fit=True)
    result.positions                      # numpy, n x 3, metres
    result.save("out/CaseDambreak", to=["vtu"])

Arrays are read-only views of memory that the library holds: they are made when they are first asked for, once, and
live as long as anything refers to them. All are in the order of the particles' ids, or of the file. SI units. Other
threads run while the library works; Ctrl-C ends it at the next stage or iteration. Errors are fppg.Error and its
kinds: UsageError, CaseError (with file and line), GeometryError, IoError.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Sequence, Union

from ._library import _fppg
from ._errors import CaseError, Error, GeometryError, IoError, UsageError

if TYPE_CHECKING:
    import numpy
    import numpy.typing

__version__: str = _fppg.version
__all__ = ["Body", "Case", "CaseError", "Error", "FittedMesh", "GeometryError", "IoError", "KINDS", "Result", "TYPES",
           "UsageError", "compare", "fit", "formats", "generate", "inspect", "load", "read"]

Path = Union[str, "os.PathLike[str]"]
Progress = Callable[[str, float], None]

#: What the numbers of Result.types mean.
TYPES = ("fixed", "moving", "floating", "fluid")
#: What the numbers of Result.kinds and FittedMesh.kinds mean.
KINDS = ("corner", "edge", "surface", "volume")


class Body(NamedTuple):
    """The particles of one mk."""
    name: str  #: as the case says, else as "bound0" or "fluid1"
    mk: int    #: absolute
    type: str  #: of TYPES


@dataclass(frozen=True)
class Case:
    """A case definition that was read, and what stands in place of its own values."""
    path: str
    dp: float  #: metres
    h: float   #: smoothing length, metres
    is_2d: bool
    warnings: Sequence[str]  #: of the definition, whole sentences
    given_dp: Optional[float] = None
    vars: Mapping[str, str] = field(default_factory=dict)


class Result:
    """Particles of a case that was made, or of a file. Arrays have one entry, or one row, a particle."""

    def __init__(self, particles: Any) -> None:
        self._particles = particles

    def __len__(self) -> int:
        return self._particles.count

    def __repr__(self) -> str:
        return f"<fppg.Result of {len(self)} particles, dp {self.dp:g}>"

    @property
    def dp(self) -> float:
        """Particle distance, metres."""
        return self._particles.dp

    @property
    def h(self) -> float:
        """Smoothing length, metres."""
        return self._particles.h

    @property
    def rhop0(self) -> float:
        """Reference density, kg/m^3."""
        return self._particles.rhop0

    @property
    def time(self) -> float:
        """Of an output of the solver, seconds; else 0."""
        return self._particles.time

    @property
    def is_2d(self) -> bool:
        """Whether the case lies in the plane x-z."""
        return self._particles.is_2d

    @property
    def bodies(self) -> list[Body]:
        """The particles of every mk, in the order of their ids."""
        return [Body(name, mk, TYPES[kind]) for name, mk, kind in self._particles.bodies]

    @property
    def warnings(self) -> list[str]:
        """Whole sentences; of a loaded result none."""
        return self._particles.warnings

    @property
    def positions(self) -> numpy.typing.NDArray[numpy.float64]:
        """n x 3, metres."""
        return self._particles.positions()

    @property
    def velocities(self) -> numpy.typing.NDArray[numpy.float32]:
        """n x 3, m/s."""
        return self._particles.velocities()

    @property
    def densities(self) -> numpy.typing.NDArray[numpy.float32]:
        """n, kg/m^3."""
        return self._particles.densities()

    @property
    def masses(self) -> numpy.typing.NDArray[numpy.float64]:
        """n, kg; in 2-D kg per metre."""
        return self._particles.masses()

    @property
    def volumes(self) -> numpy.typing.NDArray[numpy.float64]:
        """n, m^3; in 2-D m^2. Of fitted bodies so that they add up to the volume of the body; a .bi4 does not hold
        them, so of a loaded result all are dp^3."""
        return self._particles.volumes()

    @property
    def normals(self) -> Optional[numpy.typing.NDArray[numpy.float32]]:
        """n x 3, of length 1, or 0 where there is none: those of the case's mDBC, else outwards from fitted walls.
        None where the case has neither."""
        return self._particles.normals() if self._particles.has_normals else None

    @property
    def ids(self) -> numpy.typing.NDArray[numpy.uint32]:
        """n."""
        return self._particles.ids()

    @property
    def mk(self) -> numpy.typing.NDArray[numpy.int32]:
        """n, absolute."""
        return self._particles.mk()

    @property
    def types(self) -> numpy.typing.NDArray[numpy.uint8]:
        """n, index into TYPES."""
        return self._particles.types()

    @property
    def kinds(self) -> Optional[numpy.typing.NDArray[numpy.uint8]]:
        """n, index into KINDS; those on lattice nodes are of the volume. None for a loaded result."""
        return self._particles.kinds() if self._particles.has_kinds else None

    def save(self, output: Path, to: Sequence[str] = ()) -> list[str]:
        """Writes OUTPUT.bi4 and OUTPUT.xml, and the particles for other codes, all or none.

        output  without extension; folders are made
        to      names of formats()
        returns the files
        """
        return self._particles.save(os.fspath(output), list(to))

    def convert(self, path: Path, format: str = "") -> tuple[list[str], list[str]]:
        """Writes the particles for another code.

        format  a name of formats(); by default what the ending of the path means
        returns the files, and what the format does not hold, as sentences
        """
        return self._particles.convert(os.fspath(path), format)


class FittedMesh(NamedTuple):
    """Particles on a mesh; arrays have one entry, or one row, a particle."""
    positions: numpy.typing.NDArray[numpy.float64]  #: n x 3, in the unit of the mesh
    kinds: numpy.typing.NDArray[numpy.uint8]        #: n, index into KINDS
    normals: numpy.typing.NDArray[numpy.float32]    #: n x 3, outwards, of the facet that a particle lies on
    area: float
    volume: float                                   #: 0 where the mesh is open
    warnings: list[str]                             #: of the mesh, whole sentences


def read(definition: Path, dp: Optional[float] = None, vars: Optional[Mapping[str, Any]] = None) -> Case:
    """Reads a case definition and checks it.

    definition  Case_Def.xml
    dp          metres, in place of the definition's
    vars        values of variables that the definition defines
    raises      CaseError with file and line, IoError
    """
    path = os.fspath(definition)
    path = path if path.endswith(".xml") else path + ".xml"
    values = {name: str(value) for name, value in (vars or {}).items()}
    facts = _fppg.read(path, dp, list(values.items()))
    return Case(path, facts["dp"], facts["h"], facts["is_2d"], facts["warnings"], dp, values)


def generate(case: Union[Case, Path], fit: Union[bool, str, None] = None, threads: int = 0, strict: bool = False,
             progress: Optional[Progress] = None) -> Result:
    """Makes the particles of a case, as `fppg DEFINITION OUTPUT` does; nothing is written.

    fit       True: body-fitted walls for every boundary mk; "raw": without relaxation; False: none; None: as the
              case says
    threads   0: what the machine or its scheduler allows; the result does not depend on it
    strict    warnings about what GenCase accepts in silence are errors
    progress  called with the stage and the share of it that is done, 0 to 1; what it raises ends the work
    raises    CaseError, GeometryError, IoError, KeyboardInterrupt
    """
    choices = {None: "case", True: "on", False: "off", "raw": "raw"}
    if fit not in choices:
        raise UsageError(f"fit={fit!r} is invalid, expected True, False, 'raw' or None")
    if not isinstance(case, Case):
        case = read(case)
    return Result(_fppg.generate(case.path, case.given_dp, list(case.vars.items()), choices[fit], threads, strict,
                                 progress))


def load(name: Path, xml: Path = "") -> Result:
    """The particles of a result of fppg or GenCase, or of an output of the solver, which are read when they are asked
    for.

    name    a case without extension, its .bi4 or .xml, or an output Part_XXXX.bi4
    xml     Case.xml of an output; by default CASENAME.xml beside it or one folder above
    raises  IoError, CaseError
    """
    return Result(_fppg.load(os.fspath(name), os.fspath(xml)))


def fit(vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike, dp: float, angle: float = 30.0,
        relax: bool = True, threads: int = 0, progress: Optional[Progress] = None) -> FittedMesh:
    """Particles on the surface of a mesh: on its corners and edges, and one per dp^2 between them.

    vertices   n x 3, any unit
    triangles  m x 3 indices of vertices, counter-clockwise from outside
    dp         particle distance, in that unit
    angle      edges sharper than this get particles of their own, degrees
    relax      spread them evenly
    raises     GeometryError, UsageError
    """
    return FittedMesh(**_fppg.fit(vertices, triangles, dp, angle, relax, threads, progress))


def inspect(path: Path, dp: float = 0.0, angle: float = 30.0, unit: str = "", threads: int = 0) -> dict[str, Any]:
    """What a mesh file holds and what is wrong with it, as `fppg inspect --json` says.

    dp      in the unit of the file; 0: nothing is said about particles
    unit    "m", "cm", "mm" or "in"; guessed where empty
    raises  IoError, GeometryError
    """
    return json.loads(_fppg.inspect(os.fspath(path), dp, angle, unit, threads))


def compare(a: Path, b: Path, threads: int = 0) -> dict[str, Any]:
    """What differs between two results, as `fppg compare --json` says; "findings" is empty where they are equal.

    raises  Error
    """
    return json.loads(_fppg.compare(os.fspath(a), os.fspath(b), threads))


def formats() -> dict[str, str]:
    """Formats of other codes by name, and who reads them."""
    return _fppg.formats()
