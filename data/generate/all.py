"""Writes the scenes, data/*.glb:  python3 data/generate/all.py [NAME ...]   (all of them by default)"""

import pathlib
import sys

import atrium
import cornell
import moving
import plates

SCENES = {"atrium": atrium, "cornell": cornell, "moving": moving, "plates": plates}


def main(names):
    unknown = [name for name in names if name not in SCENES]
    if unknown:
        sys.exit(f"no scene {unknown[0]!r}: choose from {', '.join(SCENES)}")
    folder = pathlib.Path(__file__).resolve().parent.parent
    for name in names or SCENES:
        glb = SCENES[name].build()
        size = glb.write(folder / f"{name}.glb")
        print(f"{name}.glb: {glb.triangle_count()} triangles, {size} bytes")


if __name__ == "__main__":
    main(sys.argv[1:])
