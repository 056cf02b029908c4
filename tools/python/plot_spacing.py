#!/usr/bin/python3
"""How evenly the particles of a case stand, lattice and body-fitted, as a histogram.

    plot_spacing.py CASE_Def.xml picture.png [DP]

An example of the Python module fppg: it makes the case twice, takes the distance of every wall particle to its nearest
one, and draws both distributions. Needs python3-scipy and python3-matplotlib.
"""

import sys

import matplotlib
import numpy as np
from scipy.spatial import cKDTree

import fppg

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402 (a backend without a screen comes first)


def wall_spacing(result):
    """Distances between nearest wall particles, in dp."""
    walls = result.positions[result.types != fppg.TYPES.index("fluid")]
    distances, _ = cKDTree(walls).query(walls, k=2)
    return distances[:, 1] / result.dp


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    case = fppg.read(sys.argv[1], dp=float(sys.argv[3]) if len(sys.argv) == 4 else None)
    for name, fit in (("lattice", False), ("body-fitted", True)):
        result = fppg.generate(case, fit=fit)
        spacing = wall_spacing(result)
        print(f"{name}: {len(spacing)} wall particles, mean {spacing.mean():.3f} dp, coefficient of variation "
              f"{spacing.std() / spacing.mean():.3f}")
        pyplot.hist(spacing, bins=np.linspace(0, 1.5, 76), density=True, alpha=0.6, label=name)
    pyplot.xlabel("distance to the nearest wall particle, dp")
    pyplot.legend()
    pyplot.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
