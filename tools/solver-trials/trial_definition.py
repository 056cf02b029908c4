"""Variants of walls, and the definition of a trial in one of them."""

import os
from dataclasses import dataclass, field, replace

import make_meshes
from trial_cases import wet_part

# Attributes of <parameter>s that a variant may set; all others of a variant's words are attributes of <bodyfitted>.
SOLVER_KEYS = ("Boundary", "SlipMode", "NoPenetration", "ViscoBoundFactor", "Shifting", "DensityDT", "Visco", "TimeMax")


@dataclass
class Variant:
    """How walls are made.

    offset   where flat walls on whole multiples of dp lie between nodes: 0 on a node, 0.5 half-way
    shell    nodes next to the surface too, as GenCase draws by default; else only nodes inside
    layers   numbers of dp for the layers of a <drawbox>, for the case that is a box of one sheet; "": its mesh
    normals  "drawn": <norgeometry> of all that is drawn; "wet": of the surface that fluid can touch; "": none in the definition
    band     width of the <fluidband>, dp; 0: none
    """
    is_fitted: bool
    parameters: dict
    offset: float = 0.0
    normals: str = ""
    band: int = 0
    shell: bool = False
    layers: str = ""
    attributes: dict = field(default_factory=dict)


def no_slip(slip, penetration):
    return {"Boundary": 2, "SlipMode": slip, "NoPenetration": penetration}


VARIANTS = {
    # What GenCase makes: dynamic boundaries; mDBC as most users run it; mDBC at its best.
    "lattice-dbc": Variant(False, {"Boundary": 1}, shell=True),
    "lattice-mdbc": Variant(False, no_slip(1, 0), 0.5, "drawn"),
    "lattice-mdbc2": Variant(False, no_slip(2, 1), 0.5, "wet"),
    # For the sheet only: the layers that GenCase has for boxes.
    "lattice-dbc-box": Variant(False, {"Boundary": 1}, layers="0,1,2"),
    "lattice-mdbc2-box": Variant(False, no_slip(2, 1), 0.5, "drawn", layers="0.5,1.5,2.5"),
    # Particles on the true surface.
    "surface-dbc": Variant(True, {"Boundary": 1}, 0.0, "", 3),
    "surface-mdbc": Variant(True, no_slip(1, 0), 0.5, "drawn", 3),
    "surface-mdbc2": Variant(True, no_slip(2, 1), 0.5, "wet", 3),
    # Layers at depths where the boundary condition wants them.
    "layers": Variant(True, no_slip(2, 1), 0.5, "", 3, attributes={"boundary": "mdbc"}),
    "layers-slip1": Variant(True, no_slip(1, 0), 0.5, "", 3, attributes={"boundary": "mdbc"}),
    "layers-slip3": Variant(True, no_slip(3, 1), 0.5, "", 3, attributes={"boundary": "mdbc"}),
    "layers-dbc": Variant(True, {"Boundary": 1}, 0.0, "", 3, attributes={"boundary": "dbc", "layers": "3"}),
}


def variant_of(text):
    """The Variant of NAME[:key=value...]: a parameter of the solver, offset, band, normals, or an attribute of <bodyfitted>."""
    name, *words = text.split(":")
    if name not in VARIANTS:
        raise ValueError(f"{name}: expected one of {', '.join(VARIANTS)}")
    base = VARIANTS[name]
    out = replace(base, parameters=dict(base.parameters), attributes=dict(base.attributes))
    for word in words:
        key, mark, value = word.partition("=")
        if not mark:
            raise ValueError(f"{text}: {word}: expected key=value")
        if key in SOLVER_KEYS:
            out.parameters[key] = value
        elif key == "offset":
            out.offset = float(value)
        elif key == "band":
            out.band = int(value)
        elif key == "normals":
            out.normals = value.replace("none", "")
        else:
            out.attributes[key] = value
    return out


def xyz(point):
    return " ".join(f'{k}="{v:.12g}"' for k, v in zip("xyz", point))


def draws(trial, variant, as_surface=False):
    """The walls, or only their surface, for the normals."""
    if variant.layers and trial.box:
        layers = "" if as_surface else f'<layers vdp="{variant.layers}" />'
        low, size = trial.box
        return f"""<setnormalinvert invert="{str(as_surface).lower()}" /><setmkbound mk="0" />
            <drawbox><boxfill>bottom | left | right | front | back</boxfill>{layers}
            <point {xyz(low)} /><size {xyz(size)} /></drawbox>"""
    lines = []
    for mk, name in enumerate(trial.meshes):
        name = "wet_" + name if as_surface and variant.normals == "wet" else name
        shell = f'<drawfilestl file="{name}" />'
        # GenCase's particles go 2 dp deep, without the surface that is drawn besides; fitted walls fill the solid.
        how = ' fppg:fill="inside" />' if variant.is_fitted else ' advanced="true"><depth depthmin="0" /></drawfilestl>'
        inside = f'<drawfilestl file="{name}"{how}'
        both = shell if trial.is_sheet or as_surface else inside + (shell if variant.shell else "")
        lines.append(f'<setmkbound mk="{mk}" />{both}')
    return "\n".join(lines)


def constants(trial):
    fixed = trial.speed_sound is not None
    return f"""<gravity {xyz(trial.gravity)} /><rhop0 value="1000" /><rhopgradient value="{trial.density_gradient}" />
        <hswl value="{0.1 if fixed else 0}" auto="{str(not fixed).lower()}" /><gamma value="7" />
        <speedsystem value="{trial.speed_sound / 20 if fixed else 0:.9g}" auto="{str(not fixed).lower()}" />
        <coefsound value="20" /><speedsound value="{trial.speed_sound or 0:.9g}" auto="{str(not fixed).lower()}" />
        <coefh value="1" /><cflnumber value="0.2" />"""


def parameters(trial, variant):
    values = {"SavePosDouble": 0, "StepAlgorithm": 2, "Kernel": 2, "ViscoTreatment": 1, "Visco": 0.02, "ViscoBoundFactor": 1,
              "DensityDT": 2, "DensityDTvalue": 0.1, "Shifting": 0, "CoefDtMin": 0.05, "TimeMax": trial.time,
              "TimeOut": trial.time / trial.outputs, "RhopOutMin": 700, "RhopOutMax": 1300,
              **trial.parameters, **variant.parameters}
    lines = "\n".join(f'<parameter key="{k}" value="{v}" />' for k, v in values.items())
    low, high = trial.solver_domain[:3], trial.solver_domain[3:]
    return f"""{lines}
        <simulationdomain><posmin x="{low[0]}" y="{low[1]}" z="{low[2]}" />
        <posmax x="{high[0]}" y="{high[1]}" z="{high[2]}" /></simulationdomain>"""


def fppg_block(trial, variant):
    if not variant.is_fitted:
        return ""
    more = "".join(f' {k}="{v}"' for k, v in variant.attributes.items())
    band = f'<fluidband mkfluid="0" width="{variant.band}" />' if variant.band else ""
    exact = '<floatings exact="true" />' if trial.floating else ""
    return f'<fppg><bodyfitted mkbound="0-{len(trial.meshes) - 1}"{more} />{band}{exact}</fppg>'


def definition(trial, variant):
    """The text of the definition."""
    low, high = trial.domain
    # A sheet half-way between nodes has no nearest ones: GenCase takes those on its front.
    halved = 0.5 if trial.is_sheet and not variant.is_fitted and not variant.layers else 1
    shift = variant.offset * trial.dp * halved
    surface = normals = ""
    if variant.normals and int(variant.parameters["Boundary"]) == 2:
        surface = f"""<setshapemode>actual | bound</setshapemode><setactive drawpoints="false" drawshapes="true" />
            {draws(trial, variant, True)}<shapeout file="surface" /><setactive drawpoints="true" drawshapes="false" />"""
        normals = """<normals active="true"><norgeometry><geometryfile file="[CaseName]_surface_Actual.vtk" />
            <distanceh v="2" /></norgeometry></normals>"""
    # Nodes on the sides of a <fillbox> are not filled.
    corner = [v - trial.dp for v in low]
    fills = []
    for seed, level in ((trial.seed, trial.level), *([trial.second] if trial.second else [])):
        size = [min(h + trial.dp, level - 0.25 * trial.dp if k == 2 else h + trial.dp) - c
                for k, (c, h) in enumerate(zip(corner, high))]
        fills.append(f"""<fillbox {xyz(seed)}><modefill>void</modefill><point {xyz(corner)} /><size {xyz(size)} /></fillbox>""")
    return f"""<?xml version="1.0" encoding="UTF-8" ?>
<case xmlns:fppg="urn:fppg"><casedef>
    <constantsdef>{constants(trial)}</constantsdef>
    <mkconfig boundcount="240" fluidcount="9" />
    <geometry><definition dp="{trial.dp:.12g}"><pointref {xyz((shift if trial.measure != "poiseuille" else 0, shift, shift))} />
        <pointmin {xyz(low)} /><pointmax {xyz(high)} /></definition>
    <commands><mainlist>
        <setdrawmode mode="full" />
        {surface}
        {draws(trial, variant)}
        <setmkfluid mk="0" />
        {"".join(fills)}
    </mainlist></commands></geometry>
    {trial.floating}{normals}{fppg_block(trial, variant)}{trial.motion}
</casedef><execution><parameters>
{parameters(trial, variant)}
</parameters></execution></case>
"""


def write_trial(trial, variant, folder):
    """Writes Case_Def.xml and its meshes into a folder."""
    os.makedirs(folder, exist_ok=True)
    for name, mesh in trial.meshes.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(make_meshes.stl_bytes(mesh, trial.name))
        with open(os.path.join(folder, "wet_" + name), "wb") as file:
            file.write(make_meshes.stl_bytes(wet_part(trial, mesh), trial.name))
    with open(os.path.join(folder, "Case_Def.xml"), "w", encoding="utf-8") as file:
        file.write(definition(trial, variant))
